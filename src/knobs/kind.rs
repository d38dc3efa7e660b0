//! What a knob can hold: its kind, its range, its value.

use glam::DVec3;
use std::borrow::Cow;
use std::fmt;

/// The largest size a number may have: squares and areas of it still fit 32-bit floats.
pub const LARGEST: f64 = 1e12;
/// The smallest number that counts as positive: squares of it are normal 32-bit floats.
pub const SMALLEST: f64 = 1e-12;

/// What a knob takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A whole number, both ends included.
    Integer {
        least: u64,
        most: u64,
    },
    Number(Range),
    /// A number, or "off" (or "absent") for none.
    OptionalNumber(Range),
    /// Three numbers in square brackets: a point, a direction, angles or R, G, B.
    Triple(Range),
    /// One of these names.
    Choice(&'static [&'static str]),
    /// Three numbers that are not all zero, or "receiver".
    Pole,
    /// The name of a material.
    Material,
}

/// The numbers that a knob takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub least: f64,
    pub most: f64,
    /// Whether the ends themselves are excluded.
    pub open: bool,
}

impl Range {
    pub const ANY: Self = Self::closed(-LARGEST, LARGEST);
    pub const POSITIVE: Self = Self::closed(SMALLEST, LARGEST);
    pub const NOT_NEGATIVE: Self = Self::closed(0.0, LARGEST);
    pub const UNIT: Self = Self::closed(0.0, 1.0);

    pub const fn closed(least: f64, most: f64) -> Self {
        Self {
            least,
            most,
            open: false,
        }
    }

    pub const fn open(least: f64, most: f64) -> Self {
        Self {
            least,
            most,
            open: true,
        }
    }

    /// The number itself, minus zero made plain zero, or why it is refused.
    pub fn check(&self, number: f64) -> Result<f64, String> {
        if !number.is_finite() {
            let shown = number.to_string().to_lowercase();
            return Err(format!("must be a finite number, not {shown}"));
        }
        // What 32-bit devices see counts too: 179.99999999 would be 180 there.
        let single = f64::from(number as f32);
        if self.holds(number) && (!self.open || self.holds(single)) {
            return Ok(number + 0.0);
        }
        let shown = shown(number);
        Err(if number.abs() > LARGEST {
            format!(
                "must be at most {LARGEST:e} in size so that 32-bit floats neither overflow nor vanish, not {shown}"
            )
        } else if self.least == SMALLEST && number > 0.0 {
            format!(
                "must be at least {SMALLEST:e} so that 32-bit floats neither overflow nor vanish, not {shown}"
            )
        } else {
            format!("must be {self}, not {shown}")
        })
    }

    fn holds(&self, number: f64) -> bool {
        if self.open {
            number > self.least && number < self.most
        } else {
            number >= self.least && number <= self.most
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (least, most) = (shown(self.least), shown(self.most));
        match (self.least, self.most) {
            (low, high) if low == -LARGEST && high == LARGEST => f.write_str("finite"),
            (low, high) if low == SMALLEST && high == LARGEST => f.write_str("> 0"),
            (_, high) if high == LARGEST => write!(f, ">= {least}"),
            _ if self.open => write!(f, "> {least} and < {most}"),
            _ => write!(f, "{least} to {most}"),
        }
    }
}

impl Kind {
    /// The name of the type, for tables.
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::Integer { .. } => "integer",
            Self::Number(_) => "number",
            Self::OptionalNumber(_) => "number or off",
            Self::Triple(_) => "three numbers",
            Self::Choice(_) => "choice",
            Self::Pole => "direction",
            Self::Material => "text",
        }
    }

    /// Which values of the type are taken.
    pub fn range(&self) -> String {
        match self {
            Self::Integer { least, most } if *most == u64::MAX => format!("{least} to 2^64-1"),
            Self::Integer { least, most } => format!("{least} to {most}"),
            Self::Number(range) | Self::Triple(range) => range.to_string(),
            Self::OptionalNumber(range) => format!("{range}, or off"),
            Self::Choice(names) => names.join(", "),
            Self::Pole => "three numbers, or receiver".into(),
            Self::Material => "a material's name".into(),
        }
    }
}

/// A value of a knob.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Integer(u64),
    Number(f64),
    Triple([f64; 3]),
    /// The name of a choice or a material, or the pole "receiver".
    Text(Cow<'static, str>),
    /// An optional number that is not there.
    Off,
}

/// Said where a value is asked for a type that its knob's kind rules out: a fault of the table.
const WRONG_KIND: &str = "the table of knobs gives this knob another kind";

impl Value {
    pub fn integer(&self) -> u64 {
        match self {
            Self::Integer(value) => *value,
            other => unreachable!("{WRONG_KIND}: {other}"),
        }
    }

    pub fn number(&self) -> f64 {
        match self {
            Self::Number(value) => *value,
            other => unreachable!("{WRONG_KIND}: {other}"),
        }
    }

    pub fn optional(&self) -> Option<f64> {
        match self {
            Self::Off => None,
            other => Some(other.number()),
        }
    }

    pub fn triple(&self) -> DVec3 {
        match self {
            Self::Triple(value) => DVec3::from_array(*value),
            other => unreachable!("{WRONG_KIND}: {other}"),
        }
    }

    pub fn text(&self) -> &str {
        match self {
            Self::Text(value) => value,
            other => unreachable!("{WRONG_KIND}: {other}"),
        }
    }

    /// The value as records carry it; a number that is off is null.
    pub fn to_json(&self) -> serde_json::Value {
        match self {
            Self::Integer(value) => (*value).into(),
            Self::Number(value) => (*value).into(),
            Self::Triple(value) => value.to_vec().into(),
            Self::Text(value) => value.as_ref().into(),
            Self::Off => serde_json::Value::Null,
        }
    }

    /// The value as a scene file has it.
    pub fn to_toml(&self) -> String {
        match self {
            Self::Text(value) => format!("\"{value}\""),
            Self::Off => "\"off\"".into(),
            other => other.to_string(),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(value) => write!(f, "{value}"),
            Self::Number(value) => f.write_str(&shown(*value)),
            Self::Triple([x, y, z]) => {
                write!(f, "[{}, {}, {}]", shown(*x), shown(*y), shown(*z))
            }
            Self::Text(value) => f.write_str(value),
            Self::Off => f.write_str("off"),
        }
    }
}

/// A number as a person would write it: no tail of zeros, powers of ten where digits run long.
pub fn shown(number: f64) -> String {
    let plain = number.to_string();
    if plain.len() <= 18 {
        plain
    } else {
        format!("{number:e}")
    }
}
