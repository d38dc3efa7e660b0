//! Changes of a kernel's joined text. One that no longer fits the text is an error: it would measure
//! the shipping kernel against itself.

/// One change.
#[derive(Clone, Copy, Debug)]
pub enum Edit {
    /// A piece of text that stands once, and what takes its place.
    Text(&'static str, &'static str),
    /// A piece of text that stands more than once, and what takes its place everywhere.
    Every(&'static str, &'static str),
    /// A function, by its name, and what takes its place.
    Function(&'static str, &'static str),
    /// A function that is taken from the general kernel of the same scene.
    General(&'static str),
}

/// Where a function stands: from its `fn` to the line of its closing brace.
fn function(text: &str, name: &str) -> Result<std::ops::Range<usize>, String> {
    let head = format!("\nfn {name}(");
    let mut places = text.match_indices(&head);
    let (start, _) = places
        .next()
        .ok_or(format!("there is no function {name}"))?;
    if places.next().is_some() {
        return Err(format!("there are two functions {name}"));
    }
    let length = text[start..]
        .find("\n}\n")
        .ok_or(format!("the function {name} has no end"))?;
    Ok(start + 1..start + length + 3)
}

impl Edit {
    fn apply(&self, text: &str, general: &str) -> Result<String, String> {
        match self {
            Self::Text(from, to) => match text.matches(from).count() {
                1 => Ok(text.replacen(from, to, 1)),
                count => Err(format!("this stands {count} times, not once:\n{from}")),
            },
            Self::Every(from, to) => match text.matches(from).count() {
                0 | 1 => Err(format!("this does not stand several times:\n{from}")),
                _ => Ok(text.replace(from, to)),
            },
            Self::Function(name, to) => {
                let mut edited = text.to_string();
                edited.replace_range(function(text, name)?, to);
                Ok(edited)
            }
            Self::General(name) => {
                let taken = &general[function(general, name)?];
                let mut edited = text.to_string();
                edited.replace_range(function(text, name)?, taken);
                Ok(edited)
            }
        }
    }
}

/// The text with all the changes in it; `general` is that of the general kernel of the same scene.
///
/// # Errors
/// Says which change does not fit, or changes nothing.
pub fn edited(text: &str, general: &str, edits: &[Edit]) -> Result<String, String> {
    let mut edited = text.to_string();
    for edit in edits {
        let next = edit.apply(&edited, general)?;
        if next == edited {
            return Err(format!("this changes nothing: {edit:?}"));
        }
        edited = next;
    }
    Ok(edited)
}
