//! What several bodies share.

use lampray::Error;
use lampray::film::{Pixels, RasterFile};
use lampray::scene::{Assignment, Scene};
use std::io::Write;
use std::path::Path;
use tempfile::NamedTempFile;

/// Pixels of a picture that is looked at closely.
const LOOKED_AT: usize = 1 << 16;

/// A file of these bytes, in memory where the system has such a folder.
pub fn file(bytes: &[u8]) -> NamedTempFile {
    let memory = Path::new("/dev/shm");
    let folder = match memory.is_dir() {
        true => memory.to_path_buf(),
        false => std::env::temp_dir(),
    };
    let mut file = NamedTempFile::new_in(folder).expect("a temporary file");
    file.write_all(bytes).expect("room for it");
    file
}

/// A refusal has a reason that fits a terminal, and is never a fault of lampray itself.
pub fn refusal(error: &Error) {
    let words = error.to_string();
    assert!(!words.trim().is_empty(), "a refusal without a reason");
    assert!(words.len() < 100_000, "a refusal of {} bytes", words.len());
    let control = |c: char| c.is_control() && c != '\n' && c != '\t';
    assert!(!words.contains(control), "control characters in {words:?}");
    assert!(!matches!(error, Error::Internal(_)), "{words}");
}

/// A scene that was taken holds finite numbers, and its record gives it again.
pub fn taken(scene: &Scene) {
    let camera = &scene.camera;
    let mut triples = vec![camera.position, camera.look_at, camera.up, scene.background];
    triples.extend(scene.spheres.iter().map(|sphere| sphere.center));
    triples.extend(
        scene
            .boxes
            .iter()
            .flat_map(|one| [one.min, one.max, one.rotation]),
    );
    triples.extend(
        scene
            .materials
            .iter()
            .flat_map(|one| [one.albedo, one.emission]),
    );
    assert!(triples.iter().all(|triple| triple.is_finite()));
    assert!(scene.spheres.iter().all(|sphere| sphere.radius > 0.0));
    let shapes = scene.spheres.iter().map(|one| one.material);
    let mut shapes = shapes.chain(scene.boxes.iter().map(|one| one.material));
    assert!(shapes.all(|material| material < scene.materials.len()));

    let knobs = scene.knobs.iter();
    let knobs: Vec<_> = knobs
        .map(|(path, value)| Assignment::from_record(path, value))
        .collect();
    let again = Scene::parse(&scene.source.name, &scene.source.text, &knobs);
    let again = again.unwrap_or_else(|error| panic!("the record of a scene is refused: {error}"));
    assert_eq!(again.knobs, scene.knobs);
}

/// Reads any program's image as `lampray diff` does.
pub fn image(bytes: &[u8]) {
    let file = file(bytes);
    let raster = RasterFile::open(file.path()).and_then(RasterFile::read);
    let raster = match raster {
        Ok(raster) => raster,
        Err(error) => return refusal(&error),
    };
    let pixels = match &raster.pixels {
        Pixels::Linear(pixels) => pixels.len(),
        Pixels::Bytes(pixels, _) => pixels.len(),
        Pixels::Words(pixels, _) => pixels.len(),
    };
    assert_eq!(pixels, raster.len());
    if let Some(noise) = &raster.noise {
        assert_eq!([noise.variance.len(), noise.samples.len()], [pixels; 2]);
    }
    if pixels > LOOKED_AT {
        return;
    }
    let mut line = vec![[0.0; 3]; raster.width as usize];
    for y in 0..raster.height {
        raster.linear_line(y, &mut line);
        raster.display_line(y, 1.0, &mut line);
        let shown = line.as_flattened();
        assert!(shown.iter().all(|value| (0.0..=1.0).contains(value)));
    }
}
