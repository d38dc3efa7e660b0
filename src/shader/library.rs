//! The files of `shaders/`, in the binary.

macro_rules! library {
    ($($name:literal),+ $(,)?) => {
        /// Name and text of each shader file.
        pub const LIBRARY: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../shaders/", $name, ".wgsl")))),+];
    };
}

library!(
    "baked",
    "box",
    "branch",
    "bvh",
    "camera",
    "canary",
    "efficiency",
    "features",
    "interruption",
    "light",
    "loops",
    "maths",
    "points",
    "probe",
    "random",
    "ray",
    "scatter",
    "scene",
    "sphere",
    "trace",
);
