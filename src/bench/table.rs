//! A benchmark's outcome as text.

use super::against::Against;
use super::report::{Figures, Report, Row, Status};
use super::spread::Spread;
use std::fmt::Write as _;

/// The whole page. Writing into a string cannot fail, so nothing is lost by not asking.
pub fn table(report: &Report) -> String {
    let mut text = heading(report);
    text += &rows(report);
    text += &ratios(report);
    if let Some(against) = &report.against {
        text += &earlier(against);
    }
    if !report.complete {
        text += "\nstopped early: medians are of the turns that were finished\n";
    }
    text
}

fn heading(report: &Report) -> String {
    let machine = &report.machine;
    let mut text = format!(
        "lampray {}, {}, {} threads{}\n",
        report.version,
        machine.system,
        machine.threads,
        match machine.processor.as_str() {
            "" => String::new(),
            name => format!(", {name}"),
        }
    );
    let mut seen: Vec<&str> = Vec::new();
    for row in &report.rows {
        if !seen.contains(&row.device.as_str()) {
            let info = &row.device_info;
            let _ = writeln!(text, "  {}: {}, {}", row.device, info.name, info.driver);
            seen.push(&row.device);
        }
    }
    if !report.set.is_empty() {
        let _ = writeln!(text, "  with {}", report.set.join(", "));
    }
    let _ = writeln!(
        text,
        "  medians of {} turns of about {} s, [middle half]; the first turn of each is not counted\n",
        report.repeats, report.seconds
    );
    text
}

/// What distinguishes the rows, then what was measured.
fn rows(report: &Report) -> String {
    let several = |value: fn(&Row) -> &str| {
        let first = report.rows.first().map(value);
        report.rows.iter().any(|row| Some(value(row)) != first)
    };
    let kernel = |row: &Row| match (&row.figures, &row.kernel) {
        (Some(figures), Some(asked)) if figures.traced_by != *asked => {
            format!("{asked}: {}", figures.traced_by)
        }
        (Some(figures), _) => figures.traced_by.clone(),
        (None, asked) => asked.clone().unwrap_or_default(),
    };
    let devices = several(|row| &row.device);
    let presets = several(|row| &row.preset);
    let shaders = report.rows.iter().any(|row| row.shaders.is_some());
    let mut lines = vec![head(devices, presets, shaders)];
    let mut notes: Vec<&str> = Vec::new();
    for row in &report.rows {
        let mut line = vec![row.scene.clone(), row.primitives.to_string()];
        line.extend(devices.then(|| row.device.clone()));
        line.extend(presets.then(|| row.preset.clone()));
        line.push(kernel(row));
        line.extend(shaders.then(|| row.shaders.clone().unwrap_or_default()));
        match &row.figures {
            Some(figures) => line.extend(cells(figures)),
            None => line.push(state(row, &mut notes)),
        }
        lines.push(line);
    }
    let left = 3 + usize::from(devices) + usize::from(presets) + usize::from(shaders);
    let mut text = aligned(&lines, |column| column != 1 && column < left);
    for (index, note) in notes.iter().enumerate() {
        let _ = writeln!(text, "\n({}) {note}", index + 1);
    }
    text
}

fn head(devices: bool, presets: bool, shaders: bool) -> Vec<String> {
    let mut head = vec!["scene", "bodies"];
    head.extend(devices.then_some("device"));
    head.extend(presets.then_some("preset"));
    head.push("kernel");
    head.extend(shaders.then_some("shaders"));
    head.extend([
        "Mrays/s",
        "[middle half]",
        "Msamples/s",
        "rays/path",
        "pack",
        "compile",
        "outside",
        "memory",
    ]);
    head.into_iter().map(String::from).collect()
}

fn cells(figures: &Figures) -> [String; 8] {
    let peak = figures.peak.as_ref();
    [
        digits(figures.mrays.median),
        half(&figures.mrays),
        digits(figures.msamples.median),
        format!("{:.1}", figures.rays_per_sample),
        time(figures.pack.median),
        time(figures.compile.median),
        format!("{:.1} %", 100.0 * figures.outside.median),
        peak.map_or("-".into(), |peak| {
            format!("{:.0} MiB", peak.median / 1048576.0)
        }),
    ]
}

/// In place of numbers; a reason is said once, below.
fn state<'a>(row: &'a Row, notes: &mut Vec<&'a str>) -> String {
    let word = match row.status {
        Status::Refused => "cannot",
        Status::Failed => "failed",
        Status::Stopped | Status::Measured => return "not reached".into(),
    };
    let reason = row.reason.as_deref().unwrap_or_default();
    let known = notes.iter().position(|note| *note == reason);
    let number = known.unwrap_or_else(|| {
        notes.push(reason);
        notes.len() - 1
    });
    format!("{word} ({})", number + 1)
}

fn ratios(report: &Report) -> String {
    if report.ratios.is_empty() {
        return String::new();
    }
    let mut lines = Vec::new();
    for ratio in &report.ratios {
        lines.push(vec![
            ratio.scene.clone(),
            ratio.axis.name().into(),
            format!("{} : {}", ratio.of, ratio.to),
            ratio.at.join(", "),
            digits(ratio.mrays.median),
            half(&ratio.mrays),
            digits(ratio.msamples.median),
            half(&ratio.msamples),
        ]);
    }
    let head = [
        "scene",
        "axis",
        "ratio",
        "at",
        "Mrays/s",
        "[middle half]",
        "Msamples/s",
        "[middle half]",
    ];
    lines.insert(0, head.map(String::from).to_vec());
    format!(
        "\nratios inside this run, each turn against its own pair\n{}",
        aligned(&lines, |column| column < 4)
    )
}

fn earlier(against: &Against) -> String {
    let where_ = match against.same_machine {
        true => "the same machine by its record, at another time",
        false => "ANOTHER MACHINE",
    };
    let shaders = match against.same_shaders {
        true => ", the same shaders",
        false => ", other shaders (then and now above, where they were measured in turns)",
    };
    let mut lines = vec![
        ["scene", "of", "to", "Mrays/s", "[if quartiles differ]"]
            .map(String::from)
            .to_vec(),
    ];
    for one in &against.comparisons {
        let kernel = one
            .kernel
            .as_ref()
            .map_or(String::new(), |kernel| format!(", {kernel}"));
        let other = if one.same_device {
            ""
        } else {
            " (another device)"
        };
        lines.push(vec![
            one.scene.clone(),
            format!("{}, {}{kernel}", one.device, one.preset),
            format!("{}{other}", one.to),
            digits(one.mrays),
            format!(
                "[{} .. {}]",
                digits(one.quartiles[0]),
                digits(one.quartiles[1])
            ),
        ]);
    }
    let mut text = format!(
        "\nagainst {}: DIFFERENT RUNS, not paired; {where_}{shaders}\n{}",
        against.file,
        aligned(&lines, |column| column < 3)
    );
    if against.unmatched > 0 {
        let _ = writeln!(text, "{} rows have no counterpart there", against.unmatched);
    }
    text
}

fn half(spread: &Spread) -> String {
    let [low, high] = spread.quartiles;
    format!("[{} .. {}]", digits(low), digits(high))
}

/// About three digits.
fn digits(value: f64) -> String {
    match value.abs() {
        100.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.1}"),
        1.0.. => format!("{value:.2}"),
        0.01.. => format!("{value:.3}"),
        0.0 => "0".into(),
        _ => format!("{value:.1e}"),
    }
}

fn time(seconds: f64) -> String {
    match seconds {
        10.0.. => format!("{seconds:.0} s"),
        1.0.. => format!("{seconds:.1} s"),
        0.001.. => format!("{:.0} ms", 1e3 * seconds),
        _ => format!("{:.0} us", 1e6 * seconds),
    }
}

/// Columns two blanks apart; short lines end early. `left` says which stand on the left.
fn aligned(lines: &[Vec<String>], left: impl Fn(usize) -> bool) -> String {
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let full = || lines.iter().filter(|line| line.len() == columns);
    let width = |column: usize| {
        let cells = full().map(|line| line[column].chars().count());
        cells.max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let mut row = String::new();
        for (column, cell) in line.iter().enumerate() {
            let width = widths[column];
            let gap = if column == 0 { "" } else { "  " };
            let _ = match left(column) {
                true => write!(row, "{gap}{cell:<width$}"),
                false => write!(row, "{gap}{cell:>width$}"),
            };
        }
        text += row.trim_end();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_about_three_digits() {
        let shown = [0.0, 1234.5, 12.34, 1.234, 0.1234, 1.2e-5].map(digits);
        assert_eq!(shown, ["0", "1234", "12.3", "1.23", "0.123", "1.2e-5"]);
        let times = [12.3, 1.23, 0.0123, 1.2e-5].map(time);
        assert_eq!(times, ["12 s", "1.2 s", "12 ms", "12 us"]);
    }

    #[test]
    fn columns_stand_below_each_other() {
        let lines = [vec!["a", "22"], vec!["long", "1"], vec!["cut"]];
        let lines: Vec<Vec<String>> = lines
            .iter()
            .map(|line| line.iter().map(|cell| (*cell).into()).collect())
            .collect();
        assert_eq!(
            aligned(&lines, |column| column == 0),
            "a     22\nlong   1\ncut\n"
        );
    }

    fn refused(scene: &str, reason: &str) -> Row {
        Row {
            scene: scene.into(),
            primitives: 7,
            device: "gpu".into(),
            device_info: crate::cpu::info(),
            preset: "reference".into(),
            kernel: None,
            shaders: None,
            status: Status::Refused,
            reason: Some(reason.into()),
            figures: None,
        }
    }

    #[test]
    fn rows_without_numbers_say_why_and_each_reason_once() {
        let mut stopped = refused("late", "");
        (stopped.status, stopped.reason) = (Status::Stopped, None);
        let report = Report {
            version: "0".into(),
            shader_hash: String::new(),
            shaders: None,
            machine: crate::bench::Machine::here(),
            repeats: 3,
            seconds: 1.0,
            set: vec!["light.strategy=sample".into()],
            complete: false,
            rows: vec![
                refused("a", "too long"),
                refused("b", "too long"),
                refused("c", "too wide"),
                stopped,
            ],
            ratios: Vec::new(),
            against: None,
        };
        let text = table(&report);
        let count = |part: &str| text.matches(part).count();
        assert_eq!((count("cannot (1)"), count("cannot (2)")), (2, 1), "{text}");
        assert_eq!((count("too long"), count("too wide")), (1, 1), "{text}");
        assert_eq!(count("not reached"), 1, "{text}");
        assert!(text.contains("stopped early") && text.contains("with light.strategy=sample"));
    }
}
