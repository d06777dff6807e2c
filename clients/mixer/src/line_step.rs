//! What the lines of a mix make in one step.

use std::collections::BTreeSet;

use crate::line::{Line, Mix};
use crate::mixer::{AwayFromRest, LineStages};
use crate::switch::SwitchMemory;
use crate::{Device, Name, Profile, Readings, Source, curved, with_expo};

/// What lines make is kept within this, however they multiply.
const TOTAL_MAX: f64 = 1_000.0;

/// What a line remembers.
#[derive(Clone, Debug, Default)]
pub(crate) struct LineMemory {
    moved_since_us: Option<u64>,
}

/// One step of all lines.
pub(crate) struct Step {
    pub(crate) now_us: u64,
    pub(crate) span_s: f64,
    /// Something that moves or cleans is away from rest, slows included.
    pub(crate) held: bool,
    /// The inputs that are.
    pub(crate) away: Vec<AwayFromRest>,
    /// Their devices.
    pub(crate) pushed: BTreeSet<Device>,
    /// The outputs followed the inputs in the step before.
    pub(crate) is_live: bool,
}

impl Step {
    /// One line. `input` is none while it is absent or the line is switched off.
    pub(crate) fn line(
        &self,
        (line, memory): (&Line, &mut LineMemory),
        input: Option<f64>,
        total: f64,
    ) -> LineStages {
        let rest = match line.mix {
            Mix::Replace => total,
            mix => mix.rest(),
        };
        let shaped = input.map_or(0.0, |input| shape(line, input));
        let moved = shaped != 0.0;
        let since_us = *memory.moved_since_us.get_or_insert(self.now_us);
        if !moved {
            memory.moved_since_us = None;
        }
        let waited = self.now_us.saturating_sub(since_us) >= u64::from(line.delay_ms) * 1000;
        let followed = if moved && waited { shaped } else { 0.0 };
        // What is on without a person waits as a whole.
        let is_off = input.is_none() || (line.input == Source::Always && !waited);
        let weighted = if is_off { rest } else { weigh(line, followed) };
        let total = match line.mix {
            Mix::Add => total + weighted,
            Mix::Multiply => total * weighted,
            Mix::Replace => weighted,
        };
        LineStages {
            input,
            shaped,
            weighted,
            total: total.clamp(-TOTAL_MAX, TOTAL_MAX),
        }
    }

    /// What an output makes that made `from` and is to make `to`. While nothing follows the inputs there is nothing to be slow about.
    pub(crate) fn slow(&self, slows: Slows, from: Option<f64>, to: f64) -> f64 {
        let Some(from) = from.filter(|_| self.is_live) else {
            return to;
        };
        // Without a limit the product with a span of 0 would be none.
        let reach = |per_s: f64| match per_s.is_finite() {
            true => per_s * self.span_s,
            false => f64::INFINITY,
        };
        to.clamp(from - reach(slows.down_per_s), from + reach(slows.up_per_s))
    }

    /// Notes whether a line makes the person the driver, and gives that.
    pub(crate) fn note(
        &mut self,
        (profile, line): (&Profile, &Line),
        stages: &LineStages,
        reading: Option<f64>,
    ) -> bool {
        let Some(reading) = reading else { return false };
        if line.mix == Mix::Multiply || line.is_background() {
            return false;
        }
        let idle = if line.is_switched() {
            0.0
        } else {
            idle(profile, line)
        };
        let is_pushed = stages.weighted != idle;
        if is_pushed {
            self.away_from_rest(&line.input, reading);
            self.pushed.extend(profile.devices_of(line));
            self.held = true;
        }
        is_pushed
    }

    pub(crate) fn away_from_rest(&mut self, input: &Source, reading: f64) {
        if !self.away.iter().any(|away| away.input == *input) {
            self.away.push(AwayFromRest {
                input: input.clone(),
                reading,
            });
        }
    }
}

/// The tightest slows of the lines of an output that are on, per second.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slows {
    up_per_s: f64,
    down_per_s: f64,
}

impl Default for Slows {
    fn default() -> Self {
        Self {
            up_per_s: f64::INFINITY,
            down_per_s: f64::INFINITY,
        }
    }
}

impl Slows {
    pub(crate) fn tighten(&mut self, line: &Line) {
        for (limit, per_s) in [
            (&mut self.up_per_s, line.slow_up_per_s),
            (&mut self.down_per_s, line.slow_down_per_s),
        ] {
            if per_s > 0.0 {
                *limit = limit.min(per_s);
            }
        }
    }
}

/// What a line makes while nobody touches its input.
fn idle(profile: &Profile, line: &Line) -> f64 {
    let centre = profile
        .calibration(&line.input)
        .map_or(0.0, |calibration| calibration.centre);
    response(profile, line, centre)
}

/// What a line of the profile makes of a reading in the end, when its delay is over and it needs to be slow no more.
#[must_use]
pub fn response(profile: &Profile, line: &Line, reading: f64) -> f64 {
    weigh(line, shape(line, calibrated(profile, &line.input, reading)))
}

fn shape(line: &Line, input: f64) -> f64 {
    let turned = if line.invert { -input } else { input };
    curved(with_expo(turned, line.expo), &line.curve)
}

fn weigh(line: &Line, shaped: f64) -> f64 {
    shaped * line.weight + line.offset
}

/// The calibrated value of an input, -1..=1.
pub(crate) fn read(
    profile: &Profile,
    switches: &[SwitchMemory],
    readings: &Readings,
    source: &Source,
) -> Option<f64> {
    if let Source::Switch(name) = source {
        return Some(f64::from(u8::from(is_on(profile, switches, name))));
    }
    Some(calibrated(profile, source, readings.value(source)?))
}

fn calibrated(profile: &Profile, source: &Source, raw: f64) -> f64 {
    profile
        .calibration(source)
        .map_or(raw, |calibration| calibration.apply(raw))
        .clamp(-1.0, 1.0)
}

pub(crate) fn is_on(profile: &Profile, switches: &[SwitchMemory], name: &Name) -> bool {
    let place = profile.switches.iter().position(|switch| switch.name == *name);
    place
        .and_then(|place| switches.get(place))
        .is_some_and(|switch| switch.on)
}
