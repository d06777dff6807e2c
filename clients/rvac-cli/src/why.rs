//! `rvac why`: what the robot decided lately, and why.

mod evidence;

use std::io::{Write as _, stdout};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use anyhow::bail;
use rvac_api::{Topic, Update};

use crate::arguments::WhyOptions;
use crate::socket::Connection;

/// The daemon answers at once; this covers a machine under load.
const PATIENCE: Duration = Duration::from_secs(10);

/// Prints what was asked for.
pub(crate) fn run(options: &WhyOptions) -> anyhow::Result<ExitCode> {
    let connection = Connection::open(&options.daemon)?;
    if options.stop {
        evidence::print_stop(connection, options.json)?;
    } else if options.felt {
        evidence::print_evidence(connection, options.json)?;
    } else {
        print_decisions(connection, options)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints the newest decisions, the newest last.
fn print_decisions(mut connection: Connection, options: &WhyOptions) -> anyhow::Result<()> {
    let mut decisions = Vec::new();
    let now_s = past_updates(&mut connection, Topic::Decisions, |update, text| {
        if let Update::Decision(decision) = update {
            decisions.push((decision, text));
        }
    })?;
    if decisions.is_empty() {
        bail!("the robot has decided nothing yet");
    }
    let skipped = decisions.len().saturating_sub(options.lines);
    for (decision, text) in decisions.iter().skip(skipped) {
        if options.json {
            writeln!(stdout(), "{text}")?;
        } else {
            writeln!(stdout(), "{:>12}  {}", ago(now_s - decision.t), decision.text)?;
        }
    }
    Ok(())
}

/// A robot that can drive tells its pose many times in this time. One that cannot tells none.
const POSE_WAIT: Duration = Duration::from_secs(1);

/// Gives `take` the past updates of `topic`, each with its JSON, and returns the daemon's time: that of the robot's pose, or, where none
/// comes, that of the newest of these updates.
fn past_updates(
    connection: &mut Connection,
    topic: Topic,
    mut take: impl FnMut(Update, String),
) -> anyhow::Result<f64> {
    // The topic first, then the pose, whose time is the present one. The device table comes even without a robot.
    connection.watch(vec![topic, Topic::Pose, Topic::Device])?;
    let mut deadline = Instant::now() + PATIENCE;
    let mut is_answered = false;
    let mut newest_s = 0.0_f64;
    loop {
        let Some(message) = connection.receive_until(deadline)? else {
            if is_answered {
                return Ok(newest_s);
            }
            bail!("vthal told nothing within {} s", PATIENCE.as_secs());
        };
        match message.update {
            Some(Update::Pose(pose)) => return Ok(pose.t),
            Some(Update::Device(_)) if !is_answered => {
                is_answered = true;
                deadline = Instant::now() + POSE_WAIT;
            }
            Some(Update::Device(_)) => {}
            Some(Update::Decision(decision)) => {
                newest_s = newest_s.max(decision.t);
                take(Update::Decision(decision), message.text);
            }
            Some(Update::Failed(failure)) => bail!("refused ({}): {}", failure.reason, failure.text),
            Some(update) => take(update, message.text),
            None => {}
        }
    }
}

pub(crate) fn ago(seconds: f64) -> String {
    if seconds < 120.0 {
        format!("{:.0} s ago", seconds.max(0.0))
    } else {
        format!("{:.0} min ago", seconds / 60.0)
    }
}

#[cfg(test)]
mod tests {
    use super::ago;

    #[test]
    fn a_decision_of_the_future_was_made_now() {
        assert_eq!(ago(-0.02), "0 s ago");
        assert_eq!(ago(3.4), "3 s ago");
        assert_eq!(ago(600.0), "10 min ago");
    }
}
