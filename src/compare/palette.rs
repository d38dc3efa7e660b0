//! Colours for numbers, chosen so that they are told apart in grey and by the colour-blind too.

/// Dark to light through purple and orange, for numbers from 0 up.
const SEQUENTIAL: [[u8; 3]; 9] = [
    [0, 0, 4],
    [28, 16, 68],
    [79, 18, 123],
    [129, 37, 129],
    [181, 54, 122],
    [229, 80, 100],
    [251, 135, 97],
    [254, 194, 135],
    [252, 253, 191],
];

/// Blue below 0, near white at it, red above.
const DIVERGING: [[u8; 3]; 9] = [
    [5, 48, 97],
    [44, 111, 174],
    [107, 172, 208],
    [190, 218, 234],
    [247, 247, 247],
    [249, 198, 174],
    [226, 124, 98],
    [184, 35, 49],
    [103, 0, 31],
];

/// What has no number.
pub const NOTHING: [u8; 3] = [0, 190, 90];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    Sequential,
    Diverging,
}

impl Palette {
    /// The colour of a place on the scale, 0..1.
    pub fn colour(self, place: f64) -> [u8; 3] {
        if place.is_nan() {
            return NOTHING;
        }
        let stops = match self {
            Palette::Sequential => &SEQUENTIAL,
            Palette::Diverging => &DIVERGING,
        };
        let place = place.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        let low = (place as usize).min(stops.len() - 2);
        let share = place - low as f64;
        let blend = |channel: usize| {
            let (a, b) = (
                f64::from(stops[low][channel]),
                f64::from(stops[low + 1][channel]),
            );
            (a + share * (b - a) + 0.5) as u8
        };
        [0, 1, 2].map(blend)
    }
}
