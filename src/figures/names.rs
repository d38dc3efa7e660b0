//! Names of the files beside a page.

use super::escape::file_name;
use super::{Block, DataFile, Figure};

/// For each block of a figure, the files that show it: one sheet of pictures, one file a plot, and
/// none for a table. No two are alike.
pub(super) fn of_blocks(figure: &Figure) -> Vec<Vec<String>> {
    let mut taken: Vec<String> = Vec::new();
    let mut names = Vec::with_capacity(figure.blocks.len());
    for block in &figure.blocks {
        names.push(match block {
            Block::Pictures(pictures) => {
                let stem = free(stem(figure, &pictures.name), &mut taken);
                vec![format!("{stem}.png")]
            }
            Block::Plots(plots) => {
                let stem = free(stem(figure, &plots.name), &mut taken);
                match plots.plots.len() {
                    1 => vec![format!("{stem}.svg")],
                    many => (1..=many)
                        .map(|plot| format!("{stem}-{plot}.svg"))
                        .collect(),
                }
            }
            Block::Table(_) => Vec::new(),
        });
    }
    names
}

fn stem(figure: &Figure, name: &str) -> String {
    format!("fig{}-{}", figure.number, file_name(name))
}

/// The name itself, or the first that is free when numbers are put behind it.
fn free(stem: String, taken: &mut Vec<String>) -> String {
    let numbered = (2..).map(|number| format!("{stem}-again{number}"));
    let name = std::iter::once(stem.clone())
        .chain(numbered)
        .find(|name| !taken.contains(name))
        .expect("there are more numbers than names");
    taken.push(name.clone());
    name
}

pub(super) fn of_data(file: &DataFile) -> String {
    file_name(&file.name)
}
