//! The smallest, the widest and the highest picture, and scenes in which there is nothing.

use super::program::{Case, devices, mean, scene};
use lampray::film::RasterFile;

#[test]
fn nothing_is_as_bright_as_its_background() {
    let black = Case::new(&scene([0.0; 3], ""));
    let sky = Case::new(&scene(
        [0.0; 3],
        "[background]\nemission = [0.25, 0.5, 1e12]\n",
    ));
    for device in devices("empty scenes") {
        for (width, height) in [("1", "1"), ("32768", "1"), ("1", "32768"), ("3", "7")] {
            let size = [
                "--width", width, "--height", height, "--spp", "3", "-o", "a.png",
            ];
            for (case, expected) in [(&black, [0.0; 3]), (&sky, [0.25, 0.5, 1e12])] {
                let picture = case.render(device, &size);
                let found = mean(&picture);
                let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-7 * b;
                assert!(found.iter().zip(&expected).all(near), "{device}: {found:?}");
                let size = [picture.width.to_string(), picture.height.to_string()];
                assert_eq!(size, [width, height]);
                let png = RasterFile::open(case.path("a.png"))
                    .unwrap()
                    .read()
                    .unwrap();
                let light = expected.map(|value: f64| value.min(1.0) as f32);
                let mut line = vec![[0.0; 3]; png.width as usize];
                png.linear_line(png.height - 1, &mut line);
                let near = |(a, b): (&f32, &f32)| (a - b).abs() < 0.01;
                let shown = |pixel: &[f32; 3]| pixel.iter().zip(&light).all(near);
                assert!(line.iter().all(shown), "{device}: {:?}", line[0]);
            }
        }
    }
}
