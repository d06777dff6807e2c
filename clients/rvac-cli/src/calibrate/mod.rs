//! `rvac calibrate`: guides an owner through measuring what differs from robot to robot.

mod console;

use std::process::ExitCode;

use calibration::{CalibrationError, Plan, Robot, walk};
use calibration_values::{Catalog, Item, Measurements};

use crate::arguments::CalibrateOptions;
use crate::robot;
use console::{TerminalScreen, say};

pub(crate) fn run(options: &CalibrateOptions) -> anyhow::Result<ExitCode> {
    match &options.port {
        None => list(options)?,
        Some(port) => {
            let mut robot = robot::open(port, options.baud)?;
            let outcome = measure(&mut robot, options);
            // Whatever went wrong, nothing is left running.
            robot.stop().ok();
            match outcome {
                Err(CalibrationError::Quit) => say(&CalibrationError::Quit.to_string())?,
                other => other?,
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Without a robot: what there is to measure, what it is needed for, and what the file already holds.
fn list(options: &CalibrateOptions) -> Result<(), CalibrationError> {
    let catalog = Catalog::of(&options.robot)?;
    let measured = Measurements::open(&options.file, &catalog)?;
    let named: Vec<&Item> = if options.names.is_empty() {
        catalog.items.iter().collect()
    } else {
        let find = |name: &String| catalog.find(name);
        options.names.iter().map(find).collect::<Result<_, _>>()?
    };
    for item in named {
        let state = match (measured.get(&item.name), item.assumed) {
            (Some(value), _) => item.shown(value),
            (None, Some(assumed)) => format!("not measured, taken as {}", item.shown(assumed)),
            (None, None) => "not measured".to_owned(),
        };
        say(&format!("{:<24} {state}; for {}", item.name, item.needed_for))?;
    }
    say("Name the robot's serial device with --port to measure.")?;
    Ok(())
}

/// Goes through the named values, or through all that the file does not hold yet.
fn measure(robot: &mut Robot, options: &CalibrateOptions) -> Result<(), CalibrationError> {
    let catalog = Catalog::of(robot.device())?;
    let measured = Measurements::open(&options.file, &catalog)?;
    let mut plan = Plan {
        catalog,
        measured,
        names: options.names.clone(),
    };
    walk(robot, &mut plan, &mut TerminalScreen)?;
    say(&format!("\nAll is in {}.", options.file.display()))?;
    Ok(())
}
