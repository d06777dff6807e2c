//! `cargo xtask bench relax`: what the Relax's image holds for long, in the emulated chip, and its cord on this machine.

use super::BenchArguments;
use crate::firmware::sdcc;
use crate::workspace::{self, Profile};
use crate::{process, system};
use anyhow::{Context, bail};
use serde_json::Value;
use std::process::{Command, Stdio};

/// How much of it.
struct Amounts {
    /// Seconds of full duplex.
    seconds: &'static str,
    /// Damaged packets through the chip, and through the cord on this machine.
    in_chip: &'static str,
    on_host: &'static str,
    /// Moments of each fault.
    phases: &'static str,
}

const SHORT: Amounts = Amounts {
    seconds: "20",
    in_chip: "3000",
    on_host: "100000",
    phases: "20",
};
const LONG: Amounts = Amounts {
    seconds: "3600",
    in_chip: "100000",
    on_host: "10000000",
    phases: "200",
};

/// What must be 0 in what the programs say.
const FAULTS: [&str; 10] = [
    "bytes_overrun",
    "host_bad_packets",
    "robot_lost",
    "refused",
    "resets",
    "violations",
    "bridge_shorts",
    "misuses",
    "wrong_actuation_ms",
    "host_wrong_actuation_ms",
];

/// Runs all parts and prints what they found, as one object with `--json`.
pub(super) fn run(arguments: &BenchArguments) -> anyhow::Result<()> {
    let amounts = if arguments.long { LONG } else { SHORT };
    system::need("gcc", &["gcc", "libc6-dev"])?;
    let built = sdcc::built()?;
    workspace::build(&["relax-pace", "bench-relax", "bench-cord"], Profile::Release)?;
    let program = |name: &str| Command::new(workspace::program(name, Profile::Release));
    let pace = |words: &[&str]| -> anyhow::Result<Command> {
        let mut command = program("relax-pace");
        command.arg(built.image()).arg(built.address_of("_cord_pass")?);
        command.args(words);
        Ok(command)
    };
    let mut on_host = program("bench-cord");
    on_host.arg(amounts.on_host);
    let mut rules = program("bench-relax");
    rules.args(["--phases", amounts.phases, "--json", "--firmware"]);
    rules.arg(built.image()).args(&arguments.rest);
    let parts = [
        ("duplex", pace(&["--seconds", amounts.seconds, "--full"])?),
        ("corrupted", pace(&["--corrupted", amounts.in_chip])?),
        ("corrupted_on_host", on_host),
        ("rules", rules),
    ];
    let mut found = serde_json::Map::new();
    let mut wrong = Vec::new();
    for (name, mut command) in parts {
        process::say(&process::name(&command));
        let output = command.stderr(Stdio::inherit()).output()?;
        let figures: Value =
            serde_json::from_slice(&output.stdout).with_context(|| format!("{name} gave no figures"))?;
        if !output.status.success() || has_faults(&figures) {
            wrong.push(name);
        }
        if !arguments.json {
            print(name, &figures);
        }
        found.insert(name.to_owned(), figures);
    }
    if arguments.json {
        process::print(&serde_json::to_string(&found)?);
    }
    match wrong.as_slice() {
        [] => Ok(()),
        wrong => bail!("not as it must be: {}", wrong.join(", ")),
    }
}

fn has_faults(figures: &Value) -> bool {
    FAULTS.iter().any(|name| {
        figures
            .get(name)
            .and_then(Value::as_u64)
            .is_some_and(|count| count > 0)
    })
}

/// Figures for people: a line each, rules as a table.
fn print(name: &str, figures: &Value) {
    process::print(name);
    for (key, value) in figures.as_object().into_iter().flatten() {
        match value.as_array() {
            Some(trials) => trials.iter().for_each(print_trial),
            None => process::print(&format!("  {key:<24} {value}")),
        }
    }
}

fn print_trial(trial: &Value) {
    let text = |key: &str| trial[key].as_str().unwrap_or_default().to_owned();
    let worst = trial["worst_ms"]
        .as_f64()
        .map_or_else(|| "never".to_owned(), |ms| format!("{ms:.2}"));
    process::print(&format!(
        "  {:<7} {:<28} {worst:>9} of {:>6} ms  {}",
        text("rule"),
        text("name"),
        trial["limit_ms"],
        text("what")
    ));
}

#[cfg(test)]
mod tests {
    use super::has_faults;
    use serde_json::json;

    #[test]
    fn a_lost_byte_is_a_fault() {
        assert!(!has_faults(&json!({"bytes_overrun": 0, "states_per_s": 44})));
        assert!(has_faults(&json!({"bytes_overrun": 1})));
    }
}
