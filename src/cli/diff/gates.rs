//! `--metric NAME --max X --allow-pixels N`, any number of times: each limit belongs to the metric
//! before it.

use crate::compare::{Allowed, Gate, Metric};
use crate::error::{Error, Result};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, value_parser};

/// Metrics and limits, in the order in which they stand on the command line.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gates {
    words: Vec<(usize, Word)>,
}

#[derive(Clone, Debug)]
enum Word {
    Metric(Metric),
    Max(f64),
    Min(f64),
    Allow(String),
}

impl Args for Gates {
    fn augment_args(command: Command) -> Command {
        let repeated = |arg: Arg| arg.action(ArgAction::Append).help_heading("Limits");
        command
            .arg(repeated(
                Arg::new("metric")
                    .long("metric")
                    .value_name("NAME")
                    .value_parser(value_parser!(Metric))
                    .help("Find this metric; with --max or --min after it, the picture must keep to that"),
            ))
            .arg(repeated(
                Arg::new("max")
                    .long("max")
                    .value_name("X")
                    .value_parser(value_parser!(f64))
                    .allow_negative_numbers(true)
                    .help("The largest value of the metric before it that passes"),
            ))
            .arg(repeated(
                Arg::new("min")
                    .long("min")
                    .value_name("X")
                    .value_parser(value_parser!(f64))
                    .allow_negative_numbers(true)
                    .help("The least value that passes, of psnr, ssim and ms-ssim"),
            ))
            .arg(repeated(
                Arg::new("allow-pixels")
                    .long("allow-pixels")
                    .value_name("N|P%")
                    .help("The limit before it holds for each pixel, and so many may break it"),
            ))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Gates {
    fn from_arg_matches(matches: &ArgMatches) -> std::result::Result<Self, clap::Error> {
        let mut words = Vec::new();
        collect(matches, "metric", &mut words, |metric: &Metric| {
            Word::Metric(*metric)
        });
        collect(matches, "max", &mut words, |limit: &f64| Word::Max(*limit));
        collect(matches, "min", &mut words, |limit: &f64| Word::Min(*limit));
        collect(matches, "allow-pixels", &mut words, |text: &String| {
            Word::Allow(text.clone())
        });
        words.sort_by_key(|(place, _)| *place);
        Ok(Self { words })
    }

    fn update_from_arg_matches(
        &mut self,
        matches: &ArgMatches,
    ) -> std::result::Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn collect<T: Clone + Send + Sync + 'static>(
    matches: &ArgMatches,
    name: &str,
    words: &mut Vec<(usize, Word)>,
    word: impl Fn(&T) -> Word,
) {
    let places = matches.indices_of(name).into_iter().flatten();
    let values = matches.get_many::<T>(name).into_iter().flatten();
    words.extend(places.zip(values.map(word)));
}

/// One metric with what follows it.
struct Open {
    metric: Metric,
    limit: Option<f64>,
    allowed: Option<Allowed>,
}

impl Gates {
    /// Metrics without a limit, and gates.
    pub(crate) fn read(&self) -> Result<(Vec<Metric>, Vec<Gate>)> {
        let mut all: Vec<Open> = Vec::new();
        for (_, word) in &self.words {
            match word {
                Word::Metric(metric) => all.push(Open {
                    metric: *metric,
                    limit: None,
                    allowed: None,
                }),
                Word::Max(limit) => set_limit(all.last_mut(), "--max", *limit, false)?,
                Word::Min(limit) => set_limit(all.last_mut(), "--min", *limit, true)?,
                Word::Allow(text) => set_allowed(all.last_mut(), text)?,
            }
        }
        let metrics = all
            .iter()
            .filter(|open| open.limit.is_none())
            .map(|open| open.metric);
        let gates = all.iter().filter_map(|open| {
            Some(Gate {
                metric: open.metric,
                limit: open.limit?,
                allowed: open.allowed,
            })
        });
        Ok((metrics.collect(), gates.collect()))
    }
}

fn set_limit(open: Option<&mut Open>, flag: &str, limit: f64, least: bool) -> Result<()> {
    let Some(open) = open else {
        return usage(format!(
            "{flag} {limit}: name the metric before it, for example --metric rmse {flag} {limit}"
        ));
    };
    let metric = open.metric;
    if open.limit.is_some() {
        return usage(format!("{flag} {limit}: {metric} has a limit already"));
    }
    if !limit.is_finite() {
        return usage(format!("{flag} {limit}: a limit is a finite number"));
    }
    if metric.rises() != least {
        let (right, way) = if least {
            ("--max", "smaller")
        } else {
            ("--min", "larger")
        };
        return usage(format!(
            "{flag} {limit}: {way} is better for {metric}, so its limit is a {right}"
        ));
    }
    if !metric.range().contains(&limit) {
        let (low, high) = (metric.range().start().to_string(), *metric.range().end());
        return usage(format!("{flag} {limit}: {metric} is from {low} to {high}"));
    }
    open.limit = Some(limit);
    Ok(())
}

fn set_allowed(open: Option<&mut Open>, text: &str) -> Result<()> {
    let Some(open) = open.filter(|open| open.limit.is_some()) else {
        return usage(format!(
            "--allow-pixels {text}: a limit must stand before it, for example --metric flip --max 0.1 --allow-pixels {text}"
        ));
    };
    if !open.metric.has_pixels() || open.metric.rises() {
        return usage(format!(
            "--allow-pixels {text}: {} has no limit for single pixels",
            open.metric
        ));
    }
    let share = |percent: &str| {
        percent
            .trim()
            .parse::<f64>()
            .ok()
            .filter(|p| (0.0..=100.0).contains(p))
    };
    open.allowed = Some(match text.strip_suffix('%') {
        Some(percent) => Allowed::Share(share(percent).ok_or_else(|| wrong_allowed(text))? / 100.0),
        None => Allowed::Pixels(text.trim().parse().map_err(|_| wrong_allowed(text))?),
    });
    Ok(())
}

fn wrong_allowed(text: &str) -> Error {
    Error::Usage(format!(
        "--allow-pixels {text}: give a number of pixels, or a share such as 0.1%"
    ))
}

fn usage<T>(message: String) -> Result<T> {
    Err(Error::Usage(message))
}
