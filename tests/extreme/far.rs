//! Bodies far away, very small and very large.

use super::program::{Case, devices, mean, scene, within};

/// A grey ball in white light, seen under a fifth of a right angle's sine: each of its pixels is 0.5, each other 1.
/// It covers pi tan^2(asin(1/5)) / (4 tan^2(22.5 degrees)) of the picture.
const BALL: f64 = 1.0 - 0.5 * 0.190_73;

fn ball(eye: [f64; 3], distance: f64, radius: f64) -> Case {
    let [x, y, z] = eye;
    let z = z - distance;
    Case::new(&scene(
        eye,
        &format!(
            "[background]\nemission = [1, 1, 1]
[[spheres]]\ncenter = [{x:?}, {y:?}, {z:?}]\nradius = {radius:?}\nmaterial = \"grey\"\n"
        ),
    ))
}

const SMALL: [&str; 6] = ["--width", "64", "--height", "64", "--spp", "64"];

#[test]
fn a_ball_is_as_bright_at_any_place_and_of_any_size() {
    for device in devices("balls far away and of any size") {
        for (eye, distance, radius) in [
            ([0.0; 3], 5.0, 1.0),
            ([1e5, -1e5, 1e5], 5.0, 1.0),
            ([0.0; 3], 1e5, 2e4),
            ([0.0; 3], 5e6, 1e6),
            ([0.0; 3], 5e-6, 1e-6),
            ([0.0; 3], 1e12, 2e11),
            ([0.0; 3], 1e-11, 2e-12),
        ] {
            let picture = ball(eye, distance, radius).render(device, &SMALL);
            let found = mean(&picture);
            assert!(
                within(found, BALL - 0.003, BALL + 0.003),
                "{device}, {eye:?}, {distance:e}, {radius:e}: {found:?} and not {BALL}"
            );
        }
    }
}

/// Where the numbers are exact in both places, so are the pictures.
#[test]
fn far_from_the_origin_is_as_near_it() {
    for device in devices("a scene far from the origin") {
        let near = ball([0.0; 3], 5.0, 1.0).render(device, &SMALL);
        let far = ball([131_072.0, -65_536.0, 262_144.0], 5.0, 1.0).render(device, &SMALL);
        assert!(
            near.mean == far.mean && near.variance == far.variance,
            "{device}"
        );
        let other = ball([0.0; 3], 5.0, 1.001).render(device, &SMALL);
        assert!(
            near.mean != other.mean,
            "{device}: another ball is another picture"
        );
    }
}

/// White bodies in white light cannot be told from it; no energy is lost or made by rays that leave the
/// largest ball beside the smallest. A path may be cut off after 64 hits.
#[test]
fn radius_1e_6_beside_1e6_loses_no_light() {
    let case = Case::new(&scene(
        [0.0, 1.0, 0.0],
        "[background]\nemission = [1, 1, 1]\n[interruption]\nrule = \"none\"
[[spheres]]\ncenter = [0, -1e6, 0]\nradius = 1e6\nmaterial = \"white\"
[[spheres]]\ncenter = [0, 1e6, -2e6]\nradius = 1e6\nmaterial = \"white\"
[[spheres]]\ncenter = [0, 1, -5e-6]\nradius = 1e-6\nmaterial = \"white\"
",
    ));
    for device in devices("small beside large") {
        let more = [&SMALL[..], &["--max-bounces", "64"]].concat();
        let found = mean(&case.render(device, &more));
        assert!(within(found, 0.995, 1.000_01), "{device}: {found:?}");
    }
}

/// A lamp of radius r and radiance L at height d over a point lights it by pi L (r / d)^2, of which a surface of
/// albedo a sends a L (r / d)^2 on.
#[test]
fn a_lamp_of_radius_1e_6_lights_what_it_should() {
    let lit = |floor: &str| {
        Case::new(&scene(
            [0.0; 3],
            &format!(
                "[materials.lamp]\nemission = [1e12, 1e12, 1e12]\nalbedo = [0, 0, 0]
[[spheres]]\ncenter = [0, 1, -4]\nradius = 1e-6\nmaterial = \"lamp\"\n{floor}"
            ),
        ))
    };
    let look = [
        "--set",
        "camera.position=[0.5,1,-4]",
        "--set",
        "camera.look_at=[0,0,-4]",
    ];
    let narrow = [
        "--set",
        "camera.fov=0.1",
        "--width",
        "8",
        "--height",
        "8",
        "--spp",
        "16",
        "--max-bounces",
        "1",
    ];
    let options = [&look[..], &narrow].concat();
    let floor = lit("[[boxes]]\nmin = [-9, -1, -9]\nmax = [9, 0, 9]\nmaterial = \"grey\"\n");
    let ball = lit("[[spheres]]\ncenter = [0, -1e6, -4]\nradius = 1e6\nmaterial = \"grey\"\n");
    for device in devices("a lamp of radius 1e-6") {
        let found = mean(&floor.render(device, &options));
        assert!(within(found, 0.4975, 0.5025), "{device}: {found:?}");
        // Of a radius of 1e6, 32-bit floats tell heights to 0.06 and this to twice 6 %.
        let found = mean(&ball.render(device, &options));
        assert!(within(found, 0.43, 0.58), "{device}: {found:?}");
    }
}
