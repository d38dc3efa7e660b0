use lampray::knobs::Choice;
use lampray::shader::{self, Kernel, SceneArrays};

#[test]
fn every_kernel_is_valid() {
    let arrays = SceneArrays {
        materials: 4,
        spheres: 4,
        boxes: 8,
        lamps: 1,
    };
    for kernel in Kernel::ALL {
        let joined = shader::source(*kernel, arrays).unwrap();
        let module = shader::parse(&joined).unwrap_or_else(|e| panic!("{e}"));
        shader::validate(&joined, &module).unwrap_or_else(|e| panic!("{e}"));
    }
}
