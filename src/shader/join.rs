//! Joins a kernel with the libraries it imports, each once, and remembers where every line came from.
//!
//! A file imports another with a comment line at its top: `// #import name`. The name `traversal` stands
//! for one of several files that declare the same functions: [`Traversal`] says which.

use super::library::Library;
use crate::error::{Error, Result};
use crate::pack::Traversal;

const IMPORT: &str = "// #import ";
const GENERATED: &str = "constants";

/// A kernel's text with the table that leads back to the files.
#[derive(Clone, Debug)]
pub struct Joined {
    pub text: String,
    kernel: String,
    /// Name of each file and the line of the joined text that it starts at, counted from 1.
    files: Vec<(String, usize)>,
}

impl Joined {
    /// `file.wgsl:line` of a line of the joined text, both counted from 1.
    pub fn place(&self, line: usize) -> String {
        let file = self.files.iter().rev().find(|(_, start)| *start <= line);
        match file {
            Some((name, start)) => format!("{name}.wgsl:{}", line - start + 1),
            None => format!("{}.wgsl:{line}", self.kernel),
        }
    }

    /// Names of the files that were joined.
    pub fn file_names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|(name, _)| name.as_str())
    }

    /// A fault's message: its place, or all files where the place is not known.
    pub fn fault(&self, place: Option<String>, reason: &str) -> String {
        let files = || self.file_names().collect::<Vec<_>>().join(", ");
        match place {
            Some(place) => format!("kernel {}: {place}: {reason}", self.kernel),
            None => format!("kernel {} (files {}): {reason}", self.kernel, files()),
        }
    }
}

/// The file that an import names.
fn file_of(import: &str, traversal: Traversal) -> &str {
    match (import, traversal) {
        ("traversal", Traversal::General) => "loops",
        ("traversal", Traversal::Bvh) => "bvh",
        ("traversal", Traversal::Baked) => "baked",
        _ => import,
    }
}

/// Joins `kernel` with what it imports, after the generated text `constants`.
///
/// # Errors
/// [`Error::Internal`] for an import of a file that there is none of, or that imports itself.
pub fn join(
    library: &Library,
    kernel: &str,
    constants: &str,
    traversal: Traversal,
) -> Result<Joined> {
    let files: Vec<_> = library.files().collect();
    join_files(kernel, constants, &files, traversal)
}

fn join_files(
    kernel: &str,
    constants: &str,
    library: &[(&str, &str)],
    traversal: Traversal,
) -> Result<Joined> {
    let mut order = Vec::new();
    collect(kernel, library, traversal, &mut Vec::new(), &mut order)?;
    let mut joined = Joined {
        text: String::new(),
        kernel: kernel.into(),
        files: Vec::new(),
    };
    let mut line = 1;
    for (name, text) in std::iter::once((GENERATED, constants)).chain(order) {
        joined.files.push((name.to_string(), line));
        joined.text.push_str(text);
        if !text.ends_with('\n') {
            joined.text.push('\n');
        }
        line += text.lines().count();
    }
    Ok(joined)
}

/// Appends `name` after everything it imports. `open` is the chain of files that led here.
fn collect<'a>(
    name: &str,
    library: &[(&'a str, &'a str)],
    traversal: Traversal,
    open: &mut Vec<&'a str>,
    order: &mut Vec<(&'a str, &'a str)>,
) -> Result<()> {
    let Some(&(name, text)) = library.iter().find(|(known, _)| *known == name) else {
        let by = open.last().unwrap_or(&"the program");
        return Err(Error::Internal(format!(
            "shader {by} imports {name}, which is not there"
        )));
    };
    if order.iter().any(|(known, _)| *known == name) {
        return Ok(());
    }
    if open.contains(&name) {
        let chain = open.join(" -> ");
        return Err(Error::Internal(format!(
            "shaders import each other: {chain} -> {name}"
        )));
    }
    open.push(name);
    for import in text.lines().filter_map(|line| line.strip_prefix(IMPORT)) {
        collect(
            file_of(import.trim(), traversal),
            library,
            traversal,
            open,
            order,
        )?;
    }
    open.pop();
    order.push((name, text));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_file_is_joined_once_and_lines_lead_back() {
        let files = [
            ("a", "// #import b\n// #import c\nfn a() {}\n"),
            ("b", "// #import c\nfn b() {}"),
            ("c", "fn c() {}\n"),
        ];
        let joined = join_files("a", "const X: u32 = 1u;\n", &files, Traversal::General).unwrap();
        assert_eq!(joined.text.matches("fn c()").count(), 1);
        let line = joined
            .text
            .lines()
            .position(|line| line == "fn b() {}")
            .unwrap()
            + 1;
        assert_eq!(joined.place(line), "b.wgsl:2");
        assert_eq!(joined.place(1), "constants.wgsl:1");
    }

    #[test]
    fn a_traversal_is_one_of_several_files() {
        let files = [
            ("a", "// #import traversal\nfn a() {}\n"),
            ("loops", "fn found() -> u32 {\n    return 1u;\n}\n"),
            ("bvh", "fn found() -> u32 {\n    return 2u;\n}\n"),
        ];
        for (traversal, name) in [(Traversal::General, "loops"), (Traversal::Bvh, "bvh")] {
            let joined = join_files("a", "", &files, traversal).unwrap();
            let names: Vec<_> = joined.file_names().collect();
            assert_eq!(names, ["constants", name, "a"]);
        }
    }

    #[test]
    fn circles_and_missing_files_are_refused() {
        let circle = [("a", "// #import b\n"), ("b", "// #import a\n")];
        assert!(
            join_files("a", "", &circle, Traversal::General)
                .unwrap_err()
                .to_string()
                .contains("a -> b -> a")
        );
        let missing = [("a", "// #import b\n")];
        assert!(
            join_files("a", "", &missing, Traversal::General)
                .unwrap_err()
                .to_string()
                .contains("a imports b")
        );
    }

    #[test]
    fn faults_name_the_original_file_and_line() {
        let files = [
            ("a", "// #import b\nfn a() {}\n"),
            ("b", "fn b() {}\n\nfn broken() { let x = ; }\n"),
        ];
        let joined = join_files("a", "const X: u32 = 1u;\n", &files, Traversal::General).unwrap();
        let fault = crate::shader::parse(&joined).unwrap_err().to_string();
        assert!(fault.contains("b.wgsl:3"), "{fault}");
    }

    #[test]
    fn validation_faults_name_the_original_file_and_line() {
        let files = [
            ("a", "// #import b\nfn a() {}\n"),
            (
                "b",
                "fn b() {}\n\nfn broken() -> u32 {\n    let x = vec2<f32>(1.0) * vec3<f32>(1.0);\n    return 1u;\n}\n",
            ),
        ];
        let joined = join_files("a", "const X: u32 = 1u;\n", &files, Traversal::General).unwrap();
        let outcome = crate::shader::parse(&joined)
            .and_then(|module| crate::shader::validate(&joined, &module));
        let fault = outcome.unwrap_err().to_string();
        assert!(fault.contains("b.wgsl:4"), "{fault}");
    }
}
