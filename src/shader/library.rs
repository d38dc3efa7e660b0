//! The files of `shaders/`, in the binary.

macro_rules! library {
    ($($name:literal),+ $(,)?) => {
        /// Name and text of each shader file.
        pub const LIBRARY: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../shaders/", $name, ".wgsl")))),+];
    };
}

library!(
    "background",
    "baked",
    "box",
    "bvh",
    "camera",
    "canary",
    "cap",
    "features",
    "interruption",
    "light",
    "loops",
    "maths",
    "points",
    "probe",
    "random",
    "rectangle",
    "ray",
    "scatter",
    "scene",
    "sphere",
    "trace",
);
