//! `rvac probe`: raw readings of a robot, before any threshold or unit.

mod frames;
mod gyro;

use std::io::Write as _;
use std::process::ExitCode;

use anyhow::Context as _;
use rvac_protocol::message::{ProbeTarget, ProbedContent};

use crate::arguments::{ProbeJob, ProbeWhat};
use crate::robot;

pub(crate) fn run(job: &ProbeJob) -> anyhow::Result<ExitCode> {
    let port = job
        .port
        .as_deref()
        .context("name the robot's serial device with --port")?;
    let mut robot = robot::open(port, job.baud)?;
    let target = match &job.target {
        ProbeWhat::Analog => ProbeTarget::Analog,
        ProbeWhat::Encoders => ProbeTarget::Encoders,
        ProbeWhat::Lines => ProbeTarget::Lines,
        ProbeWhat::Buttons => ProbeTarget::Buttons,
        ProbeWhat::Gyro { file } => return gyro::run(&mut robot, file).map(|()| ExitCode::SUCCESS),
    };
    say(&describe(&robot.probe(target)?))?;
    Ok(ExitCode::SUCCESS)
}

fn say(line: &str) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}").and_then(|()| out.flush())?;
    Ok(())
}

fn describe(content: &ProbedContent) -> String {
    let rows = |cells: &mut dyn Iterator<Item = String>| cells.collect::<Vec<_>>().join("\n");
    match content {
        ProbedContent::Analog(counts) => {
            let mut cells = counts.iter().enumerate();
            rows(
                &mut cells
                    .by_ref()
                    .map(|(channel, count)| format!("AN{channel:<2} {count:4}")),
            )
        }
        ProbedContent::Encoders(seen) => {
            let brush = seen.brush.map(|pulses| format!("\nbrush {pulses:11} pulses"));
            format!(
                "left  {:11}, {} illegal transitions\nright {:11}, {} illegal transitions{}",
                seen.left,
                seen.left_illegal,
                seen.right,
                seen.right_illegal,
                brush.unwrap_or_default()
            )
        }
        ProbedContent::Lines(ports) => {
            let mut cells = ('A'..).zip(ports);
            rows(
                &mut cells
                    .by_ref()
                    .map(|(letter, levels)| format!("R{letter} {levels:016b}")),
            )
        }
        ProbedContent::Buttons(seen) => format!(
            "level {:4}, {}",
            seen.level,
            match seen.pressed {
                true => "a button is pressed",
                false => "no button is pressed",
            }
        ),
        ProbedContent::Serial(serial) => serial.bytes.iter().map(|byte| format!("{byte:02X} ")).collect(),
    }
}
