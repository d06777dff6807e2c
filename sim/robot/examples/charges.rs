//! Thousands of simulated charges, and what each stop is worth alone.
//!
//!     cargo run --release -p robot --example charges -- --seeds 0..10000 [--json] [--everything-only | --weather-only]

use std::process::ExitCode;
use std::thread;

use robot::charging::{ChargeTally, ChargeTrial};
use rvac_protocol::message::ChargeEnd;

/// Each stop alone is tried on so many times fewer charges than all together.
const ALONE_SHARE: u64 = 25;
/// A tenth of the capacity an hour of the campaign's packs of 2 Ah, and 5 % for the converter, ampere.
const COOL_MAX_A: f64 = 0.21;
/// The stops of the phase of full current.
const STOPS: [ChargeEnd; 8] = [
    ChargeEnd::TemperatureSlope,
    ChargeEnd::NegativeDeltaV,
    ChargeEnd::ZeroDeltaV,
    ChargeEnd::TemperatureRise,
    ChargeEnd::Hot,
    ChargeEnd::Voltage,
    ChargeEnd::Charge,
    ChargeEnd::Time,
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some((first, last)) = seeds(&arguments) else {
        eprintln!("usage: charges --seeds FIRST..LAST [--json] [--everything-only | --weather-only]");
        return ExitCode::FAILURE;
    };
    let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let few = first + ((last - first) / ALONE_SHARE).max(1);
    let rows: Vec<(ChargeTrial, ChargeTally)> = trials(&has)
        .into_iter()
        .map(|trial| match trial {
            ChargeTrial::Only(_) => (trial, tally(trial, first, few)),
            ChargeTrial::Everything | ChargeTrial::Weather { .. } => (trial, tally(trial, first, last)),
        })
        .collect();
    if has("--json") {
        let rows: Vec<String> = rows.iter().map(|(trial, tally)| json(*trial, tally)).collect();
        println!("[{}]", rows.join(","));
    } else {
        for (trial, tally) in &rows {
            print(*trial, tally);
        }
    }
    if rows.iter().all(|(trial, tally)| is_good(*trial, tally)) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn trials(has: &impl Fn(&str) -> bool) -> Vec<ChargeTrial> {
    let weather = [true, false].map(|calibrated| ChargeTrial::Weather { calibrated });
    match (has("--everything-only"), has("--weather-only")) {
        (true, _) => vec![ChargeTrial::Everything],
        (false, true) => weather.to_vec(),
        (false, false) => [ChargeTrial::Everything]
            .into_iter()
            .chain(weather)
            .chain(STOPS.map(ChargeTrial::Only))
            .collect(),
    }
}

const fn name_of(trial: ChargeTrial) -> &'static str {
    match trial {
        ChargeTrial::Everything => "all",
        ChargeTrial::Weather { calibrated: true } => "weather-calibrated",
        ChargeTrial::Weather { calibrated: false } => "weather-uncalibrated",
        ChargeTrial::Only(stop) => stop.name(),
    }
}

/// One stop alone may leave a sound pack short; all else must hold in every row.
fn is_good(trial: ChargeTrial, tally: &ChargeTally) -> bool {
    let safe = tally.too_hot == 0 && tally.violations == 0 && tally.frozen == 0 && tally.cool.0 <= COOL_MAX_A;
    safe && (matches!(trial, ChargeTrial::Only(_)) || tally.healthy_share() >= 0.99)
}

fn seeds(arguments: &[String]) -> Option<(u64, u64)> {
    let place = arguments.iter().position(|argument| argument == "--seeds")?;
    let (first, last) = arguments.get(place + 1)?.split_once("..")?;
    let (first, last) = (first.parse().ok()?, last.parse().ok()?);
    (first < last).then_some((first, last))
}

/// Seeds are shared out evenly, so the sum does not depend on how many threads there are.
fn tally(trial: ChargeTrial, first: u64, last: u64) -> ChargeTally {
    let threads = thread::available_parallelism().map_or(1, std::num::NonZero::get) as u64;
    let workers: Vec<_> = (0..threads)
        .map(|worker| {
            thread::spawn(move || {
                let mut tally = ChargeTally::default();
                for seed in (first + worker..last).step_by(threads as usize) {
                    let healthy = trial.conditions(seed).is_healthy();
                    tally.add(&trial.run(seed), healthy);
                }
                tally
            })
        })
        .collect();
    let mut sum = ChargeTally::default();
    for worker in workers {
        sum.merge(&worker.join().expect("a worker does not panic"));
    }
    sum
}

fn print(trial: ChargeTrial, tally: &ChargeTally) {
    let name = name_of(trial);
    println!(
        "{name}: {} charges, {} sound: {:.2} % of them above 85 %, least {:.1} %; hottest {:.1} C (seed {}), {} above 55 C; \
         longest {:.2} h (seed {}); below 0 C {} with current, below 5 C at most {:.3} A (seed {}), coldest start {}; violations {}{}; estimate off by {:.1} % on average",
        tally.charges,
        tally.healthy,
        100.0 * tally.healthy_share(),
        100.0 * tally.healthy_least,
        tally.hottest.0,
        tally.hottest.1,
        tally.too_hot,
        tally.longest.0,
        tally.longest.1,
        tally.frozen,
        tally.cool.0,
        tally.cool.1,
        tally.coldest_start.map_or_else(
            || "none".to_owned(),
            |(celsius, seed)| format!("{celsius:.1} C (seed {seed})")
        ),
        tally.violations,
        tally
            .first_violation
            .map(|seed| format!(" (first: seed {seed})"))
            .unwrap_or_default(),
        100.0 * tally.estimate_error(),
    );
    let ends: Vec<String> = tally
        .ends
        .iter()
        .map(|(name, count)| format!("{name} {count}"))
        .collect();
    println!("    {}", ends.join(", "));
}

fn json(trial: ChargeTrial, tally: &ChargeTally) -> String {
    let name = name_of(trial);
    let ends: Vec<String> = tally
        .ends
        .iter()
        .map(|(name, count)| format!("\"{name}\":{count}"))
        .collect();
    format!(
        "{{\"stops\":\"{name}\",\"charges\":{},\"sound\":{},\"sound_above_85_share\":{:.4},\"sound_least\":{:.4},\
         \"hottest_c\":{:.2},\"above_55_c\":{},\"longest_h\":{:.3},\"frozen\":{},\"cool_a\":{:.3},\"coldest_start_c\":{},\"violations\":{},\"ends\":{{{}}}}}",
        tally.charges,
        tally.healthy,
        tally.healthy_share(),
        tally.healthy_least,
        tally.hottest.0,
        tally.too_hot,
        tally.longest.0,
        tally.frozen,
        tally.cool.0,
        tally
            .coldest_start
            .map_or_else(|| "null".to_owned(), |(celsius, _)| format!("{celsius:.2}")),
        tally.violations,
        ends.join(","),
    )
}
