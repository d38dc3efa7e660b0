//! Letters of a fixed width on a transparent picture.

use image::{Rgba, RgbaImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// As far from white as from the black of dark pages.
const GREY: [u8; 3] = [122, 129, 138];
const WEIGHT: FontWeight = FontWeight::Regular;

#[derive(Clone, Copy)]
pub(super) enum Size {
    Name,
    Note,
}

impl Size {
    fn raster(self) -> RasterHeight {
        match self {
            Size::Name => RasterHeight::Size20,
            Size::Note => RasterHeight::Size16,
        }
    }

    fn advance(self) -> u32 {
        get_raster_width(WEIGHT, self.raster()) as u32
    }

    /// From a line to the next.
    pub fn height(self) -> u32 {
        self.raster().val() as u32 + 2
    }

    pub fn width(self, line: &str) -> u32 {
        line.chars().count() as u32 * self.advance()
    }
}

/// Lines no wider than `most`; words that are wider are broken.
pub(super) fn wrap(text: &str, size: Size, most: u32) -> Vec<String> {
    let letters = (most / size.advance()).max(1) as usize;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let word: Vec<char> = word.chars().collect();
        for piece in word.chunks(letters) {
            let piece: String = piece.iter().collect();
            let long = piece.chars().count() + 1;
            match lines.last_mut() {
                Some(line) if line.chars().count() + long <= letters => {
                    line.push(' ');
                    line.push_str(&piece);
                }
                _ => lines.push(piece),
            }
        }
    }
    lines
}

/// Draws lines below one another. `share` of each is left of the place: 0.5 centres it.
pub(super) fn draw_lines(
    image: &mut RgbaImage,
    lines: &[String],
    size: Size,
    [x, top]: [u32; 2],
    share: f64,
) {
    for (index, line) in lines.iter().enumerate() {
        let left = x.saturating_sub((f64::from(size.width(line)) * share) as u32);
        let top = top + size.height() * index as u32;
        for (place, letter) in line.chars().enumerate() {
            draw_letter(
                image,
                letter,
                size,
                [left + place as u32 * size.advance(), top],
            );
        }
    }
}

fn draw_letter(image: &mut RgbaImage, letter: char, size: Size, [left, top]: [u32; 2]) {
    let Some(glyph) = get_raster(plainer(letter), WEIGHT, size.raster())
        .or_else(|| get_raster('?', WEIGHT, size.raster()))
    else {
        return;
    };
    for (y, row) in glyph.rows().enumerate() {
        for (x, &cover) in row.iter().enumerate() {
            let (x, y) = (left + x as u32, top + y as u32);
            if cover > 0 && x < image.width() && y < image.height() {
                let [red, green, blue] = GREY;
                image.put_pixel(x, y, Rgba([red, green, blue, cover]));
            }
        }
    }
}

/// The nearest letter that the font has.
fn plainer(letter: char) -> char {
    match letter {
        '−' | '–' | '—' | '‐' | '‑' => '-',
        '’' | '‘' => '\'',
        '“' | '”' => '"',
        '≈' => '~',
        '≤' => '<',
        '≥' => '>',
        '\u{202f}' | '\u{2009}' | '\u{a0}' => ' ',
        'σ' => 's',
        '…' => '.',
        _ => letter,
    }
}
