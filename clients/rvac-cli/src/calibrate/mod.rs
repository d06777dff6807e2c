//! `rvac calibrate`: guides an owner through measuring what differs from robot to robot.

mod arithmetic;
mod catalog;
mod dialog;
mod driven;
mod file;
mod light;
mod procedure;
mod thermistor;

use std::process::ExitCode;

use anyhow::Context as _;

use crate::arguments::CalibrateOptions;
use crate::robot::Robot;
use catalog::{Catalog, Item};
use dialog::{Dialog, Quit, Wish};
use file::Measurements;
use procedure::{Bench, Procedure};

pub(crate) fn run(options: &CalibrateOptions) -> anyhow::Result<ExitCode> {
    match &options.port {
        None => list(options),
        Some(port) => {
            let mut robot = Robot::open(port, options.baud)?;
            let device = robot.device().to_owned();
            let outcome = walk(&mut robot, &device, options);
            // Whatever went wrong, nothing is left running.
            robot.stop().ok();
            match outcome {
                Err(error) if error.is::<Quit>() => {
                    Dialog::say(&error.to_string())?;
                    Ok(ExitCode::SUCCESS)
                }
                other => other.map(|()| ExitCode::SUCCESS),
            }
        }
    }
}

/// Without a robot: what there is to measure, what it is needed for, and what the file already holds.
fn list(options: &CalibrateOptions) -> anyhow::Result<ExitCode> {
    let catalog = Catalog::of(&options.robot)?;
    let measured = Measurements::open(&options.file, &catalog)?;
    let named: Vec<&Item> = if options.names.is_empty() {
        catalog.items.iter().collect()
    } else {
        let find = |name: &String| catalog.find(name);
        options.names.iter().map(find).collect::<anyhow::Result<_>>()?
    };
    for item in named {
        let state = match (measured.get(&item.name), item.assumed) {
            (Some(value), _) => item.shown(value),
            (None, Some(assumed)) => format!("not measured, taken as {}", item.shown(assumed)),
            (None, None) => "not measured".to_owned(),
        };
        Dialog::say(&format!("{:<24} {state}; for {}", item.name, item.needed_for))?;
    }
    Dialog::say("Name the robot's serial device with --port to measure.")?;
    Ok(ExitCode::SUCCESS)
}

/// Goes through the named values, or through all that the file does not hold yet.
fn walk(robot: &mut Robot, device: &str, options: &CalibrateOptions) -> anyhow::Result<()> {
    let catalog = Catalog::of(device)?;
    let mut measured = Measurements::open(&options.file, &catalog)?;
    let chosen: Vec<&Item> = if options.names.is_empty() {
        let missing = |item: &&Item| measured.get(&item.name).is_none();
        catalog.items.iter().filter(missing).collect()
    } else {
        let find = |name: &String| catalog.find(name);
        options.names.iter().map(find).collect::<anyhow::Result<_>>()?
    };
    for (number, item) in chosen.iter().enumerate() {
        Dialog::say(&format!(
            "\n{} of {}: {}, needed for {}\n  {}",
            number + 1,
            chosen.len(),
            item.name,
            item.needed_for,
            item.measure
        ))?;
        if is_idle(&measured, &item.name) {
            Dialog::say("  not needed: cliff-emitter-line is 1")?;
            continue;
        }
        if let Some(value) = settle(robot, &catalog, &measured, item)? {
            measured.keep(&catalog, &item.name, value)?;
            Dialog::say(&format!("  kept: {} = {}", item.name, item.shown(value)))?;
        }
    }
    Dialog::say(&format!("\nAll is in {}.", options.file.display()))?;
    Ok(())
}

/// The level of a drop is needed only where the emitters cannot be switched off.
fn is_idle(measured: &Measurements, name: &str) -> bool {
    name == "cliff-drop-level" && measured.get("cliff-emitter-line") == Some(1)
}

/// Measures one value until the person is content with it; `None` if it is left out.
fn settle(
    robot: &mut Robot,
    catalog: &Catalog,
    measured: &Measurements,
    item: &Item,
) -> anyhow::Result<Option<i64>> {
    if let Some(warning) = Procedure::of(&item.name).warning() {
        Dialog::say(&format!("  {warning}"))?;
    }
    if Dialog::choose(robot, "  Ready?")? != Wish::Yes {
        return Ok(None);
    }
    loop {
        let mut bench = Bench {
            robot,
            catalog,
            measured,
        };
        let question = match bench.measure(item).and_then(|value| plausible(item, value)) {
            Ok(value) => {
                let question = format!("  {} = {}. Keep it?", item.name, item.shown(value));
                match Dialog::choose(robot, &question)? {
                    Wish::Yes => return Ok(Some(value)),
                    Wish::Skip => return Ok(None),
                    Wish::Again => continue,
                }
            }
            Err(error) if error.is::<Quit>() => return Err(error),
            Err(error) => format!("  {error:#}. Once more?"),
        };
        if Dialog::choose(robot, &question)? == Wish::Skip {
            return Ok(None);
        }
    }
}

/// A value outside of what can be true is a fault of the measurement.
fn plausible(item: &Item, value: i64) -> anyhow::Result<i64> {
    let [low, high] = item.range;
    (low..=high)
        .contains(&value)
        .then_some(value)
        .with_context(|| format!("{} cannot be true: it lies in {low} to {high}", item.shown(value)))
}
