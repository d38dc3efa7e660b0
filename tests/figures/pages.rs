//! The page and its Markdown: everything is there, nothing comes from outside, and words stay words.

use super::sample::{about, figures};
use lampray::figures::page::{html, markdown};
use lampray::figures::*;

const HOSTILE: &str = "</script><img src=x onerror=alert(1)> & {{script}} {{figures}}";

/// A figure whose every word is hostile.
fn hostile() -> Figure {
    let word = || String::from(HOSTILE);
    Figure {
        number: 5,
        title: word(),
        claim: word(),
        reading: word(),
        verdict: Verdict {
            holds: Holds::No,
            text: word(),
        },
        results: vec![word()],
        blocks: vec![
            Block::Table(Table {
                caption: word(),
                head: vec![word()],
                rows: vec![vec![word(), "a | b".into()]],
            }),
            Block::Pictures(Pictures {
                name: "../../etc/\"x".into(),
                caption: word(),
                columns: vec![word()],
                rows: vec![PictureRow {
                    label: word(),
                    cells: vec![Shown {
                        note: word(),
                        width: 1,
                        height: 1,
                        rgb: vec![1, 2, 3],
                    }],
                }],
            }),
        ],
        sweeps: Vec::new(),
        commands: vec![word(), "``` fence".into()],
        data: vec![DataFile {
            name: "../a b.csv".into(),
            csv: "x\n".into(),
        }],
    }
}

#[test]
fn a_page_asks_for_nothing_outside_itself() {
    let page = html(&figures(), &about()).unwrap();
    for (mark, _) in page.match_indices("src=\"") {
        assert!(
            page[mark..].starts_with("src=\"data:image/png;base64,"),
            "{}",
            &page[mark..mark + 60]
        );
    }
    for outside in [
        "//cdn",
        "@import",
        "<link rel=\"stylesheet",
        "<iframe",
        "fetch(",
    ] {
        assert!(!page.contains(outside), "{outside}");
    }
    let addresses: Vec<&str> = page
        .match_indices("http")
        .map(|(at, _)| &page[at..at + 26])
        .collect();
    assert!(
        addresses
            .iter()
            .all(|each| each.starts_with("http://www.w3.org/2000/svg")
                || each.starts_with("http-equiv")),
        "{addresses:?}"
    );
    assert!(page.contains("default-src 'none'"));
    assert!(!page.contains("{{"));
}

#[test]
fn a_page_shows_every_word() {
    let page = html(&figures(), &about()).unwrap();
    for figure in figures() {
        for word in [
            &figure.title,
            &figure.verdict.text,
            &figure.claim,
            &figure.reading,
        ] {
            let word = word.replace('\'', "&#39;");
            assert!(page.contains(&word), "{word}");
        }
        assert!(page.contains(&format!("id=\"figure-{}\"", figure.number)));
        assert!(page.contains(figure.verdict.holds.words()));
        assert!(page.contains(&format!("href=\"{}\"", figure.data[0].name)));
    }
    assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
}

#[test]
fn hostile_words_stay_words() {
    let page = html(
        &[hostile()],
        &About {
            device: HOSTILE.into(),
            command: HOSTILE.into(),
            ..about()
        },
    )
    .unwrap();
    assert!(!page.contains("<img src=x"));
    assert_eq!(page.matches("</script").count(), 1);
    assert!(page.contains("{{script}} {{figures}}"));
    assert!(!page.contains("href=\"../"));
}

#[test]
fn no_figures_make_a_page() {
    let page = html(&[], &About::default()).unwrap();
    assert!(page.contains("No figure was made."));
    assert!(markdown(&[], &About::default()).starts_with("# What the paper claims"));
}

#[test]
fn a_picture_without_its_pixels_is_a_fault() {
    let mut figure = hostile();
    if let Block::Pictures(pictures) = &mut figure.blocks[1] {
        pictures.rows[0].cells[0].rgb.pop();
    }
    assert!(html(&[figure], &about()).is_err());
}

/// Cells of a row of Markdown: pipes that are escaped end none.
fn cells(row: &str) -> usize {
    row.replace("\\\\", "")
        .replace("\\|", "")
        .matches('|')
        .count()
        - 1
}

#[test]
fn markdown_tables_have_as_many_cells_as_heads() {
    let page = markdown(
        &[hostile()].into_iter().chain(figures()).collect::<Vec<_>>(),
        &about(),
    );
    let lines: Vec<&str> = page.lines().collect();
    let mut tables = 0;
    for (index, line) in lines
        .iter()
        .enumerate()
        .filter(|(_, line)| line.starts_with("| -") || line.starts_with("|-"))
    {
        tables += 1;
        let rows = lines[index + 1..]
            .iter()
            .take_while(|row| row.starts_with('|'));
        for row in rows.chain([&lines[index - 1]]) {
            assert_eq!(cells(row), cells(line), "{row}\n{line}");
        }
    }
    assert_eq!(tables, 3);
    assert!(page.contains("Noise \\| one sample") && page.contains("a \\| b"));
}

#[test]
fn markdown_is_no_markup() {
    let page = markdown(&[hostile()], &about());
    let fences: Vec<&str> = page
        .lines()
        .filter(|line| line.starts_with("```"))
        .collect();
    assert!(
        fences.len() == 5 && fences.iter().any(|fence| fence.starts_with("````")),
        "{fences:?}"
    );
    let outside: String = page.split("````").step_by(2).collect();
    assert!(!outside.contains("<img src=x") && !outside.contains("</script>"));
}

/// A rule of the page that meets a class inside a plot would change the plot.
#[test]
fn rules_of_the_page_do_not_reach_into_plots() {
    let page = html(&figures(), &about()).unwrap();
    let (style, body) = page.split_once("</style>").unwrap();
    let rules: String = style
        .lines()
        .filter(|line| !line.contains(".lampray-plot"))
        .collect();
    let of_plots = body
        .split("<svg")
        .skip(1)
        .filter_map(|rest| rest.split("</svg>").next());
    for class in of_plots
        .flat_map(|plot| plot.split(" class=\"").skip(2))
        .filter_map(|rest| rest.split('"').next())
    {
        for class in class.split(' ') {
            for end in [" ", ",", "{", ":", ".", ">"] {
                assert!(!rules.contains(&format!(".{class}{end}")), "{class}");
            }
        }
    }
}
