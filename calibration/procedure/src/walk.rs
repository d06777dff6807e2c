//! From value to value.

use calibration_values::{Catalog, Item, Measurements};

use crate::bench::{Bench, Wish};
use crate::error::CalibrationError;
use crate::procedure::Procedure;
use crate::robot::Robot;
use crate::screen::{Screen, Shown};

/// What is to be measured, and where it goes.
#[derive(Debug)]
pub struct Plan {
    /// Of which robot.
    pub catalog: Catalog,
    /// The file.
    pub measured: Measurements,
    /// Names of the values; none = all that the file lacks.
    pub names: Vec<String>,
}

impl Plan {
    fn chosen(&self) -> Result<Vec<Item>, CalibrationError> {
        if self.names.is_empty() {
            let missing = |item: &&Item| self.measured.get(&item.name).is_none();
            return Ok(self.catalog.items.iter().filter(missing).cloned().collect());
        }
        let find = |name: &String| Ok(self.catalog.find(name)?.clone());
        self.names.iter().map(find).collect()
    }
}

/// Goes through the values of the plan. Each that the person keeps is in the file at once.
///
/// # Errors
/// The robot or the person is gone, or the file cannot be written.
pub fn walk(robot: &mut Robot, plan: &mut Plan, screen: &mut dyn Screen) -> Result<(), CalibrationError> {
    let chosen = plan.chosen()?;
    for (index, item) in chosen.iter().enumerate() {
        screen.show(Shown::Value {
            number: index + 1,
            of: chosen.len(),
            item,
            kept: plan.measured.get(&item.name),
        })?;
        if is_idle(&plan.measured, &item.name) {
            screen.show(Shown::NotNeeded)?;
            continue;
        }
        let mut bench = Bench {
            robot,
            catalog: &plan.catalog,
            measured: &plan.measured,
            screen,
        };
        if let Some(value) = settle(&mut bench, item)? {
            plan.measured.keep(&plan.catalog, &item.name, value)?;
            screen.show(Shown::Kept { item, value })?;
        }
    }
    Ok(())
}

/// The level of a drop is needed only where the emitters cannot be switched off.
fn is_idle(measured: &Measurements, name: &str) -> bool {
    name == "cliff-drop-level" && measured.get("cliff-emitter-line") == Some(1)
}

/// Measures one value until the person is content with it; `None` if it is left out.
fn settle(bench: &mut Bench<'_>, item: &Item) -> Result<Option<i64>, CalibrationError> {
    let danger = Procedure::of(&item.name).danger();
    if bench.choose(Shown::Ready(danger))? != Wish::Yes {
        return Ok(None);
    }
    loop {
        let wish = match bench.measure(item).and_then(|value| plausible(item, value)) {
            Ok(value) => match bench.choose(Shown::Keep { item, value })? {
                Wish::Yes => return Ok(Some(value)),
                other => other,
            },
            Err(error) if error.is_of_step() => bench.choose(Shown::Failed(&error))?,
            Err(error) => return Err(error),
        };
        if wish == Wish::Skip {
            return Ok(None);
        }
    }
}

/// A value outside of what can be true is a fault of the measurement.
fn plausible(item: &Item, value: i64) -> Result<i64, CalibrationError> {
    let [low, high] = item.range;
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    Err(CalibrationError::Implausible {
        shown: item.shown(value),
        low,
        high,
    })
}
