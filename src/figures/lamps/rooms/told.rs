//! Whether two means differ, are the same, or cannot be told apart.

use crate::analysis::Quantity;
use crate::compare::verdict::student;

/// Differences up to this share of the light count as none.
const MARGIN: f64 = 0.01;
/// Chance that any of the room's differences is called one by chance.
const LEVEL: f64 = 0.05;

/// What a difference comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    Different,
    Same,
    Neither,
}

impl Told {
    pub fn words(self) -> &'static str {
        match self {
            Told::Different => "different",
            Told::Same => "same within 1 %",
            Told::Neither => "too few samples to tell",
        }
    }
}

/// What a relative difference comes to among so many that are looked at together (Bonferroni 1936).
pub fn told(difference: Quantity, together: usize) -> Told {
    let each = LEVEL / together as f64;
    let reach = |p: f64| student(p, difference.freedom) * difference.error;
    let size = difference.value.abs();
    if size + reach(1.0 - each) < MARGIN {
        Told::Same
    } else if size > reach(1.0 - 0.5 * each) {
        Told::Different
    } else {
        Told::Neither
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_told_at_the_level_of_the_whole_table() {
        let told = |value: f64, error: f64| {
            let difference = Quantity::new(value, error * error, f64::INFINITY);
            super::told(difference, 48)
        };
        // 5 % over 48 differences: 3.28 standard errors on two sides, 3.08 on one.
        assert_eq!(told(0.033, 0.01), Told::Different);
        assert_eq!(told(-0.033, 0.01), Told::Different);
        assert_eq!(told(0.032, 0.01), Told::Neither);
        assert_eq!(told(0.0, 0.0032), Told::Same);
        assert_eq!(told(0.0, 0.0034), Told::Neither);
        // Clearly there, and clearly below the margin: that is the same.
        assert_eq!(told(0.004, 0.001), Told::Same);
    }
}
