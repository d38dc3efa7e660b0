//! Finding a knob by its path, and the nearest name to one that does not exist.

use super::table::{KNOBS, Knob};

/// Tables of the scene file with one entry a material, sphere or box.
pub const REPEATED: [&str; 3] = ["materials", "spheres", "boxes"];

/// A knob, and which material, sphere or box it belongs to.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    pub knob: &'static Knob,
    /// Name of the material, or number of the sphere or box, as written.
    pub item: Option<&'a str>,
}

/// The knob that a path names: `light.sampler`, `materials.white.albedo`, `spheres.*.radius`.
pub fn find(path: &str) -> Option<Target<'_>> {
    let (section, rest) = path.split_once('.')?;
    if !REPEATED.contains(&section) {
        let knob = KNOBS.iter().find(|knob| knob.path == path)?;
        return Some(Target { knob, item: None });
    }
    // A material's name may hold dots, a key never does.
    let (item, key) = rest.rsplit_once('.')?;
    let knob = in_section(section).find(|knob| knob.key() == key)?;
    let item = Some(item);
    Some(Target { knob, item })
}

/// The knobs of one table of the scene file.
pub fn in_section(section: &str) -> impl Iterator<Item = &'static Knob> {
    KNOBS.iter().filter(move |knob| knob.section() == section)
}

/// The tables of the scene file, in order.
pub fn sections() -> Vec<&'static str> {
    let mut sections: Vec<_> = KNOBS.iter().map(Knob::section).collect();
    sections.dedup();
    sections
}

/// Why no knob has this path, with the nearest that there are.
pub fn unknown(path: &str) -> String {
    if let Some(whole) = whole_table(path) {
        return whole;
    }
    let generic = generic(path);
    let near = nearest(&generic, KNOBS.iter().map(|knob| knob.path));
    let near = near.or_else(|| {
        let key = path.rsplit_once('.').map_or(path, |(_, key)| key);
        let same_key = |knob: &&Knob| knob.key() == key;
        KNOBS.iter().find(same_key).map(|knob| knob.path)
    });
    let near = match near {
        // Keep the name that was written: `materials.white.albdo` is near `materials.white.albedo`.
        Some(near) => format!("did you mean `{}`?", specific(near, path)),
        None => "`lampray knobs` lists them all".into(),
    };
    format!("there is no knob `{}`; {near}", short(path))
}

/// What is wrong with a path that stops at a table of the scene file, whose values are set one by one.
fn whole_table(path: &str) -> Option<String> {
    let (section, item) = match path.split_once('.') {
        Some((section, item)) => (section, Some(item)),
        None => (path, None),
    };
    let shown = short(path);
    if section == "sweep" {
        return Some(format!(
            "`{shown}` is no knob: a sweep's own arguments say what it does, or the scene's [sweep] table"
        ));
    }
    let is_item = |item: &str| {
        let key = in_section(section).any(|knob| knob.key() == item);
        REPEATED.contains(&section) && !item.contains('.') && !key
    };
    if !sections().contains(&section) || !item.is_none_or(is_item) {
        return None;
    }
    let paths = in_section(section).map(|knob| match item {
        Some(item) => format!("`{}`", knob.path.replace('*', &short(item))),
        None => format!("`{}`", knob.path),
    });
    let paths: Vec<_> = paths.take(3).collect();
    let more = if in_section(section).count() > 3 {
        ", ..."
    } else {
        ""
    };
    Some(format!(
        "`{shown}` is a table: set its values one by one, {}{more} (`lampray knobs {section}`)",
        paths.join(", ")
    ))
}

/// The path with the item's name replaced by `*`.
fn generic(path: &str) -> String {
    let parts = path
        .split_once('.')
        .and_then(|(section, rest)| rest.rsplit_once('.').map(|(_, key)| (section, key)));
    match parts {
        Some((section, key)) => format!("{section}.*.{key}"),
        None => path.into(),
    }
}

/// A knob's path with `*` replaced by the item that another path names, if it names one.
fn specific(known: &str, path: &str) -> String {
    let item = path
        .split_once('.')
        .and_then(|(_, rest)| rest.rsplit_once('.'));
    match item {
        Some((item, _)) => known.replace('*', &short(item)),
        None => known.into(),
    }
}

/// Comparing two names takes the product of their lengths, and a file may hold a thousand mistakes beside
/// thousands of names: longer words, and names after so many, are not looked at.
const LONGEST: usize = 64;
const MOST_NAMES: usize = 256;

/// The name nearest to a word that is none of them, if any is near enough to be meant.
pub fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase().replace(' ', "_");
    let length = word.chars().count();
    if length > LONGEST {
        return None;
    }
    let distance = |name: &'a str| {
        (
            strsim::damerau_levenshtein(&word, &name.to_lowercase()),
            name,
        )
    };
    let near = names.into_iter().take(MOST_NAMES);
    let near = near.filter(|name| name.len() <= 4 * LONGEST);
    let (distance, name) = near.map(distance).min_by_key(|(distance, _)| *distance)?;
    let limit = (length.max(name.chars().count()) / 3).max(1);
    let begins = length >= 3 && name.to_lowercase().starts_with(&word);
    (distance <= limit || begins).then_some(name)
}

/// A user's own words, cut to a length that fits a message, on one line.
pub fn short(word: &str) -> String {
    const MOST: usize = 60;
    let clean = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut cut: String = word.chars().take(MOST).map(clean).collect();
    if word.chars().nth(MOST).is_some() {
        cut.push('…');
    }
    cut
}
