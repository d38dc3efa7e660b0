//! The README's tables are printed from the table of knobs, and the files that it names are there.

use std::path::Path;

const README: &str = include_str!("../README.md");

/// The README with its tables as they are now.
fn with_tables(text: &str) -> String {
    let both = lampray::knobs::markdown();
    let (knobs, presets) = both.trim().split_once("\n\n").expect("two tables");
    let text = between(text, "knobs", knobs);
    between(&text, "presets", presets)
}

fn between(text: &str, name: &str, table: &str) -> String {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let (head, rest) = text.split_once(&open).expect("the opening mark");
    let (_, tail) = rest.split_once(&close).expect("the closing mark");
    format!("{head}{open}{}\n{close}{tail}", table.trim())
}

/// `UPDATE_README=1 cargo test --release --test readme` writes the tables.
#[test]
fn tables_are_those_of_the_program() {
    let fresh = with_tables(README);
    if std::env::var_os("UPDATE_README").is_some() {
        std::fs::write("README.md", &fresh).expect("README.md can be written");
    }
    assert!(
        fresh == README,
        "README.md is out of date: UPDATE_README=1 cargo test --release --test readme"
    );
}

#[test]
fn files_that_it_names_exist() {
    let words = README.split(|c: char| c.is_whitespace() || "()`,".contains(c));
    let mut seen = 0;
    for word in words.filter(|word| word.starts_with("scenes/") || word.starts_with("tests/run")) {
        assert!(Path::new(word).exists(), "{word}");
        seen += 1;
    }
    assert!(seen >= 4, "only {seen} files named");
}
