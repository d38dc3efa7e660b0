use lampray::film::{Film, RelativeError};
use lampray::pack::{Rect, Tally};

fn row(pixels: u32) -> Film {
    Film::new(Rect {
        x0: 0,
        y0: 0,
        x1: pixels,
        y1: 1,
    })
}

/// Gives a pixel 16 samples with this mean and this sample variance.
fn fill(film: &mut Film, pixel: usize, mean: f32, variance: f32) {
    let tally = Tally {
        mean: [mean; 3],
        rays: 16,
        squares: [15.0 * variance; 3],
        non_finite: 0,
    };
    film.add(pixel, 0, 16, &tally);
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * b.abs()
}

/// One standard error of each pixel is its number in hundredths of its mean.
#[test]
fn the_95th_of_a_hundred_pixels_counts() {
    let mut film = row(100);
    for pixel in 0..100 {
        let error = 0.02 * (pixel + 1) as f32;
        fill(&mut film, 99 - pixel, 2.0, 16.0 * error * error);
    }
    let found = film.relative_error();
    // Beside the pixel's own mean stands a hundredth of the picture's.
    assert!(close(found.pixels, 0.02 * 95.0 / 2.02), "{found:?}");
    let squares: f64 = (1..=100)
        .map(|number| (0.02 * f64::from(number)).powi(2))
        .sum();
    assert!(
        close(found.picture, squares.sqrt() / 100.0 / 2.0),
        "{found:?}"
    );
}

#[test]
fn both_must_be_reached() {
    let error = RelativeError {
        picture: 0.01,
        pixels: 0.1,
    };
    assert!(error.reaches(0.1) && !error.reaches(0.099));
    let odd = RelativeError {
        picture: 0.2,
        pixels: 0.1,
    };
    assert!(!odd.reaches(0.1));
}

#[test]
fn nothing_is_known_before_every_pixel_has_two_samples() {
    let mut film = row(2);
    fill(&mut film, 0, 1.0, 0.0);
    assert!(!film.relative_error().reaches(1e300));
    fill(&mut film, 1, 1.0, 0.0);
    assert!(film.relative_error().reaches(1e-9), "no noise, no error");
}

#[test]
fn black_has_no_error() {
    let mut film = row(3);
    for pixel in 0..3 {
        fill(&mut film, pixel, 0.0, 0.0);
    }
    assert!(film.relative_error().reaches(1e-9));
    // A pixel that is all but black beside a bright one does not set the error alone.
    let mut film = row(2);
    fill(&mut film, 0, 100.0, 0.0);
    fill(&mut film, 1, 1e-4, 1e-6);
    assert!(film.relative_error().pixels < 1e-3);
}
