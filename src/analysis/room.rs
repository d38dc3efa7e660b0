//! Which pictures of groups a report has room for, and how large.

/// Bytes that the maps of groups and the references may take in a page, in base64.
pub(super) const MOST_BYTES: usize = 20_000_000;

/// What a pixel takes in the page: three half floats in base64.
const PIXEL: usize = 8;

/// What a picture takes besides: its name and its size.
const HEAD: usize = 200;

/// What is kept. References and the means of all groups always are; then come bias and, last, deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Room {
    /// How often pictures are halved in both directions.
    pub halvings: u32,
    /// Groups, from the first on, that keep their map of bias; and of deviation.
    pub bias: usize,
    pub deviation: usize,
}

impl Room {
    /// For so many groups, so many of which have a map of bias.
    pub fn new(size: [u32; 2], groups: usize, biased: usize, references: usize) -> Self {
        let always = groups + references;
        let mut halvings = 0;
        let mut small = size;
        while always.saturating_mul(bytes(small)) > MOST_BYTES && small != [1, 1] {
            small = small.map(|side| side.div_ceil(2));
            halvings += 1;
        }
        let left = (MOST_BYTES / bytes(small)).saturating_sub(always);
        let bias = left.min(biased);
        Self {
            halvings,
            bias,
            deviation: (left - bias).min(groups),
        }
    }

    /// A picture as small as there is room for, with its size.
    pub fn fit(&self, size: [u32; 2], pixels: &[[f32; 3]]) -> ([u32; 2], Vec<[f32; 3]>) {
        let mut fitting = (size, pixels.to_vec());
        for _ in 0..self.halvings {
            fitting = halved(fitting.0, &fitting.1);
        }
        fitting
    }

    /// What a reader has to be told of it.
    pub fn notes(&self, groups: usize, biased: usize) -> Vec<String> {
        let mut notes = Vec::new();
        if self.halvings > 0 {
            let side = 1_u64 << self.halvings.min(63);
            notes.push(format!(
                "To keep this file small, a pixel of the pictures of groups and references is the mean of {side} x {side} pixels that were rendered; the files in images and reference have them all."
            ));
        }
        for (kind, kept, all) in [
            ("bias", self.bias, biased),
            ("deviation", self.deviation, groups),
        ] {
            if kept < all {
                notes.push(format!(
                    "To keep this file small, maps of {kind} are shown for the first {kept} of {all} groups."
                ));
            }
        }
        notes
    }
}

fn bytes([width, height]: [u32; 2]) -> usize {
    PIXEL * width as usize * height as usize + HEAD
}

/// Half as many pixels either way by a box filter; at odd ends it covers what there is.
fn halved([width, height]: [u32; 2], pixels: &[[f32; 3]]) -> ([u32; 2], Vec<[f32; 3]>) {
    let small = [width.div_ceil(2), height.div_ceil(2)];
    let mean = |x: u32, y: u32| {
        let (mut sum, mut count) = ([0.0_f32; 3], 0.0);
        for row in 2 * y..(2 * y + 2).min(height) {
            for column in 2 * x..(2 * x + 2).min(width) {
                let pixel = pixels[row as usize * width as usize + column as usize];
                sum.iter_mut().zip(pixel).for_each(|(sum, of)| *sum += of);
                count += 1.0;
            }
        }
        sum.map(|sum| sum / count)
    };
    let rows = 0..small[1];
    let all = rows.flat_map(|y| (0..small[0]).map(move |x| (x, y)));
    (small, all.map(|(x, y)| mean(x, y)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(size: [u32; 2], groups: usize, references: usize) -> (Room, usize) {
        let room = Room::new(size, groups, groups, references);
        let small = (0..room.halvings).fold(size, |size, _| size.map(|side| side.div_ceil(2)));
        let pictures = references + groups + room.bias + room.deviation;
        (room, pictures * bytes(small))
    }

    #[test]
    fn deviation_goes_first_then_bias_then_resolution() {
        let (room, _) = taken([64, 64], 20, 1);
        assert_eq!((room.halvings, room.bias, room.deviation), (0, 20, 20));
        let (room, _) = taken([256, 256], 14, 1);
        assert_eq!((room.halvings, room.bias), (0, 14));
        assert!(room.deviation < 14, "{room:?}");
        let (room, _) = taken([256, 256], 30, 1);
        assert_eq!((room.halvings, room.deviation), (0, 0));
        assert!(room.bias < 30, "{room:?}");
        let (room, _) = taken([256, 256], 60, 1);
        assert_eq!((room.halvings, room.bias, room.deviation), (1, 60, 31));
    }

    #[test]
    fn it_is_never_more_than_the_room() {
        for size in [[1, 1], [33, 7], [512, 512], [8192, 8192], [32768, 3]] {
            for groups in [1, 3, 200, 5000] {
                for references in [0, 1, groups] {
                    let (room, bytes) = taken(size, groups, references);
                    assert!(bytes <= MOST_BYTES, "{size:?} {groups}: {room:?} {bytes}");
                }
            }
        }
    }

    #[test]
    fn the_page_says_what_is_not_there() {
        let (room, _) = taken([512, 512], 200, 1);
        let notes = room.notes(200, 200).join("\n");
        assert!(notes.contains("mean of 8 x 8 pixels"), "{notes}");
        let (room, _) = taken([256, 256], 30, 1);
        let notes = room.notes(30, 30).join("\n");
        assert!(notes.contains("maps of bias are shown for the first 7 of 30"));
        assert!(notes.contains("maps of deviation are shown for the first 0 of 30"));
        let (room, _) = taken([64, 64], 20, 1);
        assert_eq!(room.notes(20, 20), Vec::<String>::new());
    }

    #[test]
    fn a_box_filter_keeps_the_mean_of_what_it_covers() {
        let pixels: Vec<_> = (0..6).map(|value| [value as f32; 3]).collect();
        let (size, small) = halved([3, 2], &pixels);
        assert_eq!((size, small), ([2, 1], vec![[2.0; 3], [3.5; 3]]));
    }
}
