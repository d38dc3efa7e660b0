//! `report.html`: one file that holds a sweep's numbers and pictures and everything that shows them.

pub mod data;

pub use data::ReportData;

use crate::error::{Error, Result};

const FRAME: &str = include_str!("page.html");

const STYLE: &[&str] = &[
    include_str!("style/page.css"),
    include_str!("style/controls.css"),
    include_str!("style/tables.css"),
    include_str!("style/pictures.css"),
    include_str!("style/plots.css"),
    include_str!("style/print.css"),
];

/// One module once they are joined, so each may use what stands before it.
const SCRIPT: &[&str] = &[
    include_str!("script/data.js"),
    include_str!("script/dom.js"),
    include_str!("script/format.js"),
    include_str!("script/chosen.js"),
    include_str!("script/half.js"),
    include_str!("script/colour.js"),
    include_str!("script/picture.js"),
    include_str!("script/svg.js"),
    include_str!("script/head.js"),
    include_str!("script/table.js"),
    include_str!("script/groups.js"),
    include_str!("script/runs.js"),
    include_str!("script/gestures.js"),
    include_str!("script/panes.js"),
    include_str!("script/viewer.js"),
    include_str!("script/series.js"),
    include_str!("script/convergence.js"),
    include_str!("script/bars.js"),
    include_str!("script/maps.js"),
    include_str!("script/page.js"),
];

/// The whole page: it asks for nothing outside itself.
///
/// # Errors
/// [`Error::Internal`] where the data cannot be written as JSON.
pub fn page(data: &ReportData) -> Result<String> {
    let json = serde_json::to_string(data).map_err(|error| Error::Internal(error.to_string()))?;
    let (head, rest) = split(FRAME, "{{style}}")?;
    let (body, rest) = split(rest, "{{data}}")?;
    let (between, tail) = split(rest, "{{script}}")?;
    Ok([
        head,
        &STYLE.concat(),
        body,
        &inside_script(&json),
        between,
        &SCRIPT.concat(),
        tail,
    ]
    .concat())
}

fn split<'a>(text: &'a str, mark: &str) -> Result<(&'a str, &'a str)> {
    text.split_once(mark)
        .ok_or_else(|| Error::Internal(format!("the report's frame has no {mark}")))
}

/// JSON that no browser takes for an end of the script or a comment: `<` is only ever inside strings.
fn inside_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The JSON between its tags, as a browser finds it.
    fn embedded(page: &str) -> &str {
        let start = page.find("id=\"data\">").expect("a data element") + "id=\"data\">".len();
        let end = page[start..].find("</script").expect("its end");
        &page[start..start + end]
    }

    #[test]
    fn hostile_names_survive_and_end_nothing() {
        let name = "</script><b><!--<script> {{script}} {{style}} \u{2028}";
        let data = ReportData {
            title: name.into(),
            findings: vec![name.into()],
            ..ReportData::default()
        };
        let page = page(&data).unwrap();
        let read: ReportData = serde_json::from_str(embedded(&page)).unwrap();
        assert_eq!(read.title, name);
        assert_eq!(read.findings, data.findings);
        assert!(!embedded(&page).contains('<'));
    }

    #[test]
    fn every_part_is_in_the_page_once() {
        let page = page(&ReportData::default()).unwrap();
        for part in STYLE.iter().chain(SCRIPT) {
            assert_eq!(page.matches(part).count(), 1, "{part:.60}");
            assert!(!part.contains("</script") && !part.contains("</style"));
        }
        assert!(!page.contains("{{"));
        assert_eq!(page.matches("</script").count(), 2);
    }
}
