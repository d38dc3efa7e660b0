//! How wide a text is before anyone draws it.

/// Advance widths of the printable ASCII letters, from the space on, in thousandths of the size.
/// Helvetica, Arial and Liberation Sans share them.
#[rustfmt::skip]
const ADVANCES: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];
/// Bold letters are wider by at most this.
const BOLD: f64 = 1.08;
/// What other fonts may need more.
const SAFETY: f64 = 1.03;

/// Width of a text in pixels, rather too much than too little.
pub fn text_width(text: &str, size: f64, bold: bool) -> f64 {
    let thousandths: f64 = text.chars().map(advance).sum();
    let weight = if bold { BOLD } else { 1.0 };
    thousandths / 1000.0 * size * weight * SAFETY
}

fn advance(letter: char) -> f64 {
    let code = letter as usize;
    match letter {
        ' '..='~' => f64::from(ADVANCES[code - 32]),
        '\u{300}'..='\u{36f}' | '\u{200b}'..='\u{200f}' => 0.0,
        '\u{2009}' | '\u{202f}' | '·' => 300.0,
        '×' | '÷' | '±' | '−' | '≤' | '≥' | '≈' | '–' => 584.0,
        '⁰'..='⁹' | '²' | '³' | '¹' | '°' => 400.0,
        _ if code < 0x1100 => 667.0,
        _ => 1000.0,
    }
}

/// The text in lines no wider than `most`; a word that is wider is broken.
pub(super) fn wrap(text: &str, size: f64, bold: bool, most: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        for piece in pieces(word, size, bold, most) {
            let line = lines.last_mut().expect("never empty");
            let longer = if line.is_empty() {
                piece.clone()
            } else {
                format!("{line} {piece}")
            };
            if line.is_empty() || text_width(&longer, size, bold) <= most {
                *line = longer;
            } else {
                lines.push(piece);
            }
        }
    }
    lines
}

/// A word in pieces that fit a line, one where it does.
fn pieces(word: &str, size: f64, bold: bool, most: f64) -> Vec<String> {
    let mut pieces = vec![String::new()];
    for letter in word.chars() {
        let piece = pieces.last_mut().expect("never empty");
        piece.push(letter);
        if text_width(piece, size, bold) > most && piece.chars().count() > 1 {
            piece.pop();
            pieces.push(letter.into());
        }
    }
    pieces
}

/// Width of the widest word: what a text needs at least where no word is to be broken.
pub(super) fn widest_word(text: &str, size: f64) -> f64 {
    text.split_whitespace()
        .map(|word| text_width(word, size, false))
        .fold(0.0, f64::max)
}
