//! `rvac statistics`: what all runs come to.

use std::fmt::Write as _;
use std::io::{Write as _, stdout};
use std::process::ExitCode;

use rvac_api::{RequestBody, RunResult, Statistics, Update};

use crate::arguments::StatisticsOptions;
use crate::control;
use crate::history::when;
use crate::socket::Connection;

pub(crate) fn run(options: &StatisticsOptions) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&options.daemon)?;
    let (sums, text) = control::answer(
        &mut connection,
        RequestBody::Statistics,
        control::ANSWER,
        |update, text| match update {
            Update::Statistics(sums) => Some((sums, text)),
            _ => None,
        },
    )?;
    if options.json {
        writeln!(stdout(), "{text}")?;
    } else {
        write!(stdout(), "{}", in_words(&sums))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn in_words(sums: &Statistics) -> String {
    if sums.runs.is_empty() {
        return "no runs yet: a run counts when it ends\n".to_owned();
    }
    let job = |name: &str| sums.runs.get(name).copied().unwrap_or(0);
    let results = RunResult::ALL.into_iter().filter_map(|result| {
        let count = sums.results.get(result.name())?;
        Some(format!("{count} {}", result.name()))
    });
    let mut text = format!(
        "since     {}\n\
         runs      {} cleanings, {} spots, {} returns to the dock\n\
         ends      {}\n\
         time      {:.1} h, {:.1} h of it in motion\n\
         cleaned   {:.0} m2\n\
         distance  {:.1} km, {} bumps\n",
        when(sums.since_s),
        job("clean"),
        job("spot"),
        job("dock"),
        results.collect::<Vec<_>>().join(", "),
        sums.duration_h,
        sums.moving_h,
        sums.swept_m2,
        sums.path_km,
        sums.bumps,
    );
    for (reason, count) in sums.stops_most_first() {
        // Writing to a string cannot fail.
        writeln!(text, "stopped   {count:>5} x {reason}").ok();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::in_words;
    use rvac_api::Statistics;

    #[test]
    fn the_most_frequent_stop_comes_first() {
        let counts = |all: &[(&str, u64)]| {
            all.iter()
                .map(|(name, count)| ((*name).to_owned(), *count))
                .collect()
        };
        let sums = Statistics {
            runs: counts(&[("clean", 12), ("dock", 3)]),
            results: counts(&[("gave-up", 1), ("finished", 14)]),
            stops: counts(&[("command", 2), ("wheel-drop", 5)]),
            moving_h: 9.75,
            path_km: 7.25,
            ..Statistics::default()
        };
        let text = in_words(&sums);
        assert!(
            text.contains("12 cleanings, 0 spots, 3 returns to the dock\n"),
            "{text}"
        );
        assert!(text.contains("ends      14 finished, 1 gave-up\n"), "{text}");
        assert!(
            text.ends_with("stopped       5 x wheel-drop\nstopped       2 x command\n"),
            "{text}"
        );
        assert_eq!(
            in_words(&Statistics::default()),
            "no runs yet: a run counts when it ends\n"
        );
    }
}
