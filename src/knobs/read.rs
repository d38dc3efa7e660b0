//! Reading a knob's value from TOML.

use super::find::{nearest, short};
use super::kind::{Kind, Range, Value};
use super::table::Knob;
use std::borrow::Cow;
use std::ops;
use toml::Spanned;
use toml::de::{DeFloat, DeInteger, DeValue};

/// Why a value cannot be taken; the reason reads on from the knob's path.
#[derive(Debug)]
pub struct Refusal {
    /// The part that is at fault.
    pub span: ops::Range<usize>,
    pub reason: String,
    pub note: Option<String>,
}

impl Knob {
    /// The value, or why this knob cannot take it.
    pub fn read(&self, value: &Spanned<DeValue<'_>>) -> Result<Value, Refusal> {
        match (&self.kind, value.get_ref()) {
            (Kind::Integer { least, most }, _) => integer(value, *least, *most).map(Value::Integer),
            (Kind::OptionalNumber(_), DeValue::String(word)) if is_off(word) => Ok(Value::Off),
            (Kind::Number(range) | Kind::OptionalNumber(range), _) => {
                number(value, range, self.kind.type_name()).map(Value::Number)
            }
            (Kind::Triple(range), _) => triple(value, range).map(Value::Triple),
            (Kind::Choice(names), _) => choice(value, names),
            (Kind::Pole, DeValue::String(word)) if word == "receiver" => {
                Ok(Value::Text(Cow::Borrowed("receiver")))
            }
            (Kind::Pole, _) => pole(value),
            (Kind::Material, DeValue::String(word)) => {
                Ok(Value::Text(Cow::Owned(word.to_string())))
            }
            (Kind::Material, other) => Err(refuse(
                value.span(),
                format!("must be a material's name in quotes, not {}", a(other)),
            )),
        }
    }
}

/// Words that turn an optional number off.
fn is_off(word: &str) -> bool {
    matches!(word, "off" | "absent")
}

fn refuse(span: ops::Range<usize>, reason: String) -> Refusal {
    Refusal {
        span,
        reason,
        note: None,
    }
}

fn integer(value: &Spanned<DeValue<'_>>, least: u64, most: u64) -> Result<u64, Refusal> {
    let DeValue::Integer(written) = value.get_ref() else {
        let reason = format!("must be a whole number, not {}", a(value.get_ref()));
        return Err(refuse(value.span(), reason));
    };
    let number = i128::from_str_radix(written.as_str(), written.radix()).ok();
    number
        .and_then(|number| u64::try_from(number).ok())
        .filter(|number| (least..=most).contains(number))
        .ok_or_else(|| {
            let shown = short(&written.to_string());
            let reason = format!("must be {least} to {most}, not {shown}");
            refuse(value.span(), reason)
        })
}

fn number(value: &Spanned<DeValue<'_>>, range: &Range, wanted: &str) -> Result<f64, Refusal> {
    let number = match value.get_ref() {
        DeValue::Float(written) => float(written),
        DeValue::Integer(written) => whole(written),
        other => Err(format!("must be a {wanted}, not {}", a(other))),
    };
    number
        .and_then(|number| range.check(number))
        .map_err(|reason| refuse(value.span(), reason))
}

/// The number, which may be infinite only where it is written so.
fn float(written: &DeFloat<'_>) -> Result<f64, String> {
    let text = written.as_str();
    let number: f64 = text
        .parse()
        .map_err(|_| format!("must be a number, not {}", short(text)))?;
    if number.is_infinite() && !text.contains("inf") {
        return Err(format!(
            "must fit 32-bit floats; {} is too large",
            short(text)
        ));
    }
    Ok(number)
}

fn whole(written: &DeInteger<'_>) -> Result<f64, String> {
    let text = written.as_str();
    let number = if written.radix() == 10 {
        text.parse().ok().filter(|number: &f64| number.is_finite())
    } else {
        i128::from_str_radix(text, written.radix())
            .ok()
            .map(|number| number as f64)
    };
    number.ok_or_else(|| format!("must fit 32-bit floats; {} is too large", short(text)))
}

fn triple(value: &Spanned<DeValue<'_>>, range: &Range) -> Result<[f64; 3], Refusal> {
    let DeValue::Array(items) = value.get_ref() else {
        let reason = format!(
            "must be three numbers in square brackets, not {}",
            a(value.get_ref())
        );
        return Err(refuse(value.span(), reason));
    };
    if items.len() != 3 {
        let reason = format!("must be three numbers, not {}", items.len());
        return Err(refuse(value.span(), reason));
    }
    let mut triple = [0.0; 3];
    for (number_of_three, item) in triple.iter_mut().zip(items.iter()) {
        *number_of_three = number(item, range, "number")?;
    }
    Ok(triple)
}

fn pole(value: &Spanned<DeValue<'_>>) -> Result<Value, Refusal> {
    if let DeValue::String(word) = value.get_ref() {
        let reason = format!(
            "must be three numbers or \"receiver\", not \"{}\"",
            short(word)
        );
        let mut refusal = refuse(value.span(), reason);
        refusal.note = nearest(word, ["receiver"]).map(|near| format!("did you mean `{near}`?"));
        return Err(refusal);
    }
    let axis = triple(value, &Range::ANY)?;
    if axis.iter().all(|part| part.abs() < super::kind::SMALLEST) {
        let reason = "must be a direction: its length must not be zero".into();
        return Err(refuse(value.span(), reason));
    }
    Ok(Value::Triple(axis))
}

fn choice(value: &Spanned<DeValue<'_>>, names: &'static [&'static str]) -> Result<Value, Refusal> {
    let one_of = format!("must be one of {}", names.join(", "));
    let DeValue::String(word) = value.get_ref() else {
        let reason = format!("{one_of} in quotes, not {}", a(value.get_ref()));
        return Err(refuse(value.span(), reason));
    };
    let known = names.iter().find(|name| *name == word);
    known
        .map(|name| Value::Text(Cow::Borrowed(name)))
        .ok_or_else(|| Refusal {
            span: value.span(),
            reason: format!("{one_of}, not \"{}\"", short(word)),
            note: nearest(word, names.iter().copied())
                .map(|near| format!("did you mean `{near}`?")),
        })
}

/// What a TOML value is, in words.
pub fn a(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number with a fraction",
        DeValue::Boolean(_) => "a boolean",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
