//! Thousands of simulated charges, and what each stop is worth alone.
//!
//!     cargo run --release -p robot --example charges -- --seeds 0..10000 [--json] [--everything-only]

use std::process::ExitCode;
use std::thread;

use robot::charging::{ChargeTally, ChargeTrial, Conditions};
use rvac_protocol::message::ChargeEnd;

/// Each stop alone is tried on so many times fewer charges than all together.
const ALONE_SHARE: u64 = 25;
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
        eprintln!("usage: charges --seeds FIRST..LAST [--json] [--everything-only]");
        return ExitCode::FAILURE;
    };
    let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let everything = tally(ChargeTrial::Everything, first, last);
    let mut rows = vec![("all".to_owned(), everything.clone())];
    if !has("--everything-only") {
        let last = first + ((last - first) / ALONE_SHARE).max(1);
        rows.extend(STOPS.into_iter().map(|stop| {
            (
                stop.name().to_owned(),
                tally(ChargeTrial::Only(stop), first, last),
            )
        }));
    }
    if has("--json") {
        let rows: Vec<String> = rows.iter().map(|(name, tally)| json(name, tally)).collect();
        println!("[{}]", rows.join(","));
    } else {
        for (name, tally) in &rows {
            print(name, tally);
        }
    }
    let good = everything.too_hot == 0 && everything.violations == 0 && everything.healthy_share() >= 0.99;
    if good {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
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
                    let healthy = match trial {
                        ChargeTrial::Everything => Conditions::drawn(seed).is_healthy(),
                        ChargeTrial::Only(_) => true,
                    };
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

fn print(name: &str, tally: &ChargeTally) {
    println!(
        "{name}: {} charges, {} sound: {:.2} % of them above 85 %, least {:.1} %; hottest {:.1} C (seed {}), {} above 55 C; \
         longest {:.2} h (seed {}); violations {}{}; estimate off by {:.1} % on average",
        tally.charges,
        tally.healthy,
        100.0 * tally.healthy_share(),
        100.0 * tally.healthy_least,
        tally.hottest.0,
        tally.hottest.1,
        tally.too_hot,
        tally.longest.0,
        tally.longest.1,
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

fn json(name: &str, tally: &ChargeTally) -> String {
    let ends: Vec<String> = tally
        .ends
        .iter()
        .map(|(name, count)| format!("\"{name}\":{count}"))
        .collect();
    format!(
        "{{\"stops\":\"{name}\",\"charges\":{},\"sound\":{},\"sound_above_85_share\":{:.4},\"sound_least\":{:.4},\
         \"hottest_c\":{:.2},\"above_55_c\":{},\"longest_h\":{:.3},\"violations\":{},\"ends\":{{{}}}}}",
        tally.charges,
        tally.healthy,
        tally.healthy_share(),
        tally.healthy_least,
        tally.hottest.0,
        tally.too_hot,
        tally.longest.0,
        tally.violations,
        ends.join(","),
    )
}
