//! The Huffman code book of a PIZ block, looked at before the block is decompressed.
//!
//! The decompressor looks up the first 14 bits of a code, and tries all longer codes that share
//! them one after another. Those that an encoder makes are few. In a block that was made to do harm
//! there can be 65536, tried for each of its values: half a megabyte took 20 seconds.

/// Bits that the decompressor looks up.
const LOOKED_UP: u32 = 14;
/// So many codes are tried in next to no time.
const HARMLESS: usize = 1024;
/// A code is as long as its value is rare: where the values of a block are `n`, at most n / 610
/// share the first 14 bits of an optimal book (610 is the 15th Fibonacci number).
const VALUES_PER_CODE: usize = 256;

/// Whether no encoder would have made such a book for a block of `values` 16-bit values. `false`
/// for a broken book too: of that the decompressor tells.
pub(super) fn is_made_up(block: &[u8], values: usize) -> bool {
    let limit = HARMLESS.max(values / VALUES_PER_CODE);
    sharing(block).is_some_and(|codes| codes > limit)
}

/// How many codes can share their first 14 bits. Codes of the same length are consecutive numbers.
fn sharing(block: &[u8]) -> Option<usize> {
    let lengths = lengths(block)?;
    let longer = (LOOKED_UP + 1..).zip(&lengths[LOOKED_UP as usize + 1..]);
    Some(
        longer
            .map(|(length, codes)| (*codes).min(1_usize << (length - LOOKED_UP)))
            .sum(),
    )
}

/// How many codes there are of each length, up to 58 bits.
fn lengths(block: &[u8]) -> Option<[usize; 59]> {
    let (head, rest) = block.split_first_chunk::<4>()?;
    let word = |i: usize| usize::from(u16::from_le_bytes([head[i], head[i + 1]]));
    // A bitmap of the values that occur, from its first byte to its last.
    let bitmap = (word(2) + 1).saturating_sub(word(0));
    // The size of what follows.
    let rest = rest.get(bitmap + 4..)?;
    let (first, rest) = rest.split_first_chunk()?;
    let (last, rest) = rest.split_first_chunk()?;
    let last = u32::from_le_bytes(*last);
    // Three sizes that do not matter here.
    let mut bits = Bits {
        bytes: rest.get(12..)?,
        place: 0,
    };
    let mut lengths = [0; 59];
    let mut value = u32::from_le_bytes(*first);
    while value <= last && last <= 1 << 16 {
        // Values that do not occur come in runs.
        value += match bits.take(6)? {
            length @ ..59 => {
                lengths[length as usize] += 1;
                1
            }
            63 => bits.take(8)? + 6,
            run => run - 57,
        };
    }
    Some(lengths)
}

/// Bits from the most significant one on.
struct Bits<'a> {
    bytes: &'a [u8],
    place: usize,
}

impl Bits<'_> {
    /// At most eight of them, which are in two bytes at most.
    fn take(&mut self, count: usize) -> Option<u32> {
        let (byte, skipped) = (self.place / 8, self.place % 8);
        let high = *self.bytes.get(byte)?;
        let low = match self.bytes.get(byte + 1) {
            Some(low) => *low,
            None if skipped + count > 8 => return None,
            None => 0,
        };
        self.place += count;
        let both = u32::from(u16::from_be_bytes([high, low]));
        Some(both >> (16 - skipped - count) & ((1 << count) - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_taken_across_bytes() {
        let mut bits = Bits {
            bytes: &[0b1010_1100, 0b0111_0001, 0b1000_0000],
            place: 0,
        };
        let taken = [6, 6, 8].map(|count| bits.take(count));
        assert_eq!(taken, [Some(0b101011), Some(0b000111), Some(0b0001_1000)]);
        assert_eq!(bits.take(4), Some(0));
        assert_eq!(bits.take(1), None);
    }
}
