//! The mixer: from readings to outputs, stage by stage.

use std::collections::BTreeSet;

use crate::line::{Line, Mix};
use crate::stop_buttons::StopButtons;
use crate::switch::SwitchMemory;
use crate::{
    Device, Name, OutputKind, OutputName, Profile, ProfileError, Readings, Source, curved, standard_profile,
    with_expo,
};

/// A longer pause between two steps is a loss: the page slept, or the lid was closed.
pub const GAP_MAX_US: u64 = 400_000;
/// What lines make is kept within this, however they multiply.
const TOTAL_MAX: f64 = 1_000.0;
/// A button is pressed above this.
const PRESSED: f64 = 0.5;

/// Whether the outputs follow the inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MixState {
    /// They do.
    Live,
    /// Everything gives its failsafe until all inputs have come to rest: an input was lost or has just appeared.
    Failsafe,
}

/// What one line made, stage by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineStages {
    /// The input; none when it is absent.
    pub input: Option<f64>,
    /// After calibration, inversion, expo and curve.
    pub shaped: f64,
    /// After delay, weight and offset; what changes nothing when the line is off.
    pub weighted: f64,
    /// What this line and those before it make together.
    pub total: f64,
}

/// An input that keeps the mix from being used, and what it reads.
#[derive(Clone, Debug, PartialEq)]
pub struct AwayFromRest {
    /// Which.
    pub input: Source,
    /// As the device gives it, before calibration.
    pub reading: f64,
}

/// What one output made.
#[derive(Clone, Debug, PartialEq)]
pub struct MixedOutput {
    /// Which.
    pub name: OutputName,
    /// Its lines.
    pub lines: Vec<LineStages>,
    /// What it gives: as slowly as its lines that are on ask for, and within its limits.
    pub value: f64,
}

/// What came of one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixed {
    /// Whether the outputs follow the inputs.
    pub state: MixState,
    /// Something that moves or cleans is away from rest.
    pub held: bool,
    /// The devices whose inputs are.
    pub pushed: BTreeSet<Device>,
    /// The inputs that must come to rest before the outputs follow; none while they do.
    pub away: Vec<AwayFromRest>,
    /// The outputs, in the order of the profile.
    pub outputs: Vec<MixedOutput>,
    /// The switches, in the order of the profile.
    pub switches: Vec<bool>,
    /// Buttons that rose in this step. Stop does so after a loss too.
    pub fired: Vec<OutputName>,
}

#[derive(Clone, Debug, Default)]
struct LineMemory {
    moved_since_us: Option<u64>,
}

#[derive(Clone, Debug, Default)]
struct OutputMemory {
    lines: Vec<LineMemory>,
    /// What the lines made together in the last step, after slow.
    made: Option<f64>,
    /// The button was seen free, so that its next press counts.
    freed: bool,
}

/// A profile at work.
#[derive(Clone, Debug)]
pub struct Mixer {
    profile: Profile,
    devices: Vec<Device>,
    present: Vec<Device>,
    outputs: Vec<OutputMemory>,
    switches: Vec<SwitchMemory>,
    last_us: Option<u64>,
    state: MixState,
    stops: StopButtons,
}

impl Mixer {
    /// A mixer that waits for all inputs to be at rest.
    ///
    /// # Errors
    /// What is wrong with the profile.
    pub fn new(profile: Profile) -> Result<Self, ProfileError> {
        profile.check()?;
        Ok(Self::of(profile))
    }

    /// A mixer by the standard profile.
    #[must_use]
    pub fn standard() -> Self {
        Self::of(standard_profile())
    }

    fn of(profile: Profile) -> Self {
        let mut devices: Vec<Device> = profile.sources().filter_map(Source::device).collect();
        devices.sort_unstable();
        devices.dedup();
        let mut mixer = Self {
            profile,
            devices,
            present: Vec::new(),
            outputs: Vec::new(),
            switches: Vec::new(),
            last_us: None,
            state: MixState::Failsafe,
            stops: StopButtons::default(),
        };
        mixer.stops = StopButtons::of(&mixer.profile);
        mixer.forget();
        mixer
    }

    /// The profile.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Gives all outputs for what the inputs read now.
    pub fn step(&mut self, now_us: u64, readings: &Readings) -> Mixed {
        let span_us = self.last_us.map_or(0, |last_us| now_us.saturating_sub(last_us));
        self.last_us = Some(now_us);
        let present: Vec<Device> = self
            .devices
            .iter()
            .filter(|device| readings.has(device))
            .cloned()
            .collect();
        let changed = present != self.present || span_us > GAP_MAX_US;
        if changed {
            self.present = present;
            self.state = MixState::Failsafe;
            self.forget();
        }
        self.step_switches(now_us, readings);
        let was_live = self.state == MixState::Live;
        let mut step = Step {
            now_us,
            span_s: if changed { 0.0 } else { span_us as f64 * 1e-6 },
            held: false,
            away: Vec::new(),
            pushed: BTreeSet::new(),
            is_live: was_live,
        };
        let outputs = self.step_outputs(&mut step, readings);
        if !changed && step.away.is_empty() {
            self.state = MixState::Live;
        }
        let mut fired = self.fire(&outputs, was_live);
        if self.stops.rise(readings) && !fired.contains(&OutputName::Stop) {
            fired.push(OutputName::Stop);
        }
        let away = match self.state {
            MixState::Live => Vec::new(),
            MixState::Failsafe => step.away,
        };
        Mixed {
            state: self.state,
            held: step.held,
            pushed: step.pushed,
            away,
            outputs: self.limited(outputs),
            switches: self.switches.iter().map(|switch| switch.on).collect(),
            fired,
        }
    }

    /// Forgets everything that lasts: slows, delays, toggles, buttons.
    fn forget(&mut self) {
        let memory = |output: &crate::Output| OutputMemory {
            lines: vec![LineMemory::default(); output.lines.len()],
            made: None,
            freed: false,
        };
        self.outputs = self.profile.outputs.iter().map(memory).collect();
        self.switches = vec![SwitchMemory::default(); self.profile.switches.len()];
    }

    fn step_switches(&mut self, now_us: u64, readings: &Readings) {
        for (place, switch) in self.profile.switches.iter().enumerate() {
            let (earlier, rest) = self.switches.split_at_mut(place);
            let is_on = |name: &Name| is_on(&self.profile, earlier, name);
            let value = |source: &Source| read(&self.profile, earlier, readings, source);
            if let Some(memory) = rest.first_mut() {
                memory.step(now_us, &switch.on, (value, is_on));
            }
        }
    }

    /// The lines of all outputs; the values are not limited yet.
    fn step_outputs(&mut self, step: &mut Step, readings: &Readings) -> Vec<MixedOutput> {
        let Self {
            profile,
            outputs,
            switches,
            ..
        } = self;
        let mut all = Vec::with_capacity(outputs.len());
        for (output, memory) in profile.outputs.iter().zip(outputs) {
            let mut total = 0.0;
            let mut slows = Slows::default();
            let mut lines = Vec::with_capacity(output.lines.len());
            let OutputMemory {
                lines: line_memories,
                made,
                ..
            } = memory;
            for (line, memory) in output.lines.iter().zip(line_memories) {
                let raw = read(profile, switches, readings, &line.input);
                let is_permitted = line
                    .when
                    .as_ref()
                    .is_none_or(|name| is_on(profile, switches, name));
                let input = raw.filter(|_| is_permitted);
                let stages = step.line((line, memory), input, total);
                let reading = readings.value(&line.input).or(raw).unwrap_or_default();
                if output.output.kind() != OutputKind::Button {
                    step.note((profile, line), &stages, input.map(|_| reading));
                } else if stages.weighted > PRESSED {
                    step.away_from_rest(&line.input, reading);
                }
                if input.is_some() {
                    slows.tighten(line);
                }
                total = stages.total;
                lines.push(LineStages { input: raw, ..stages });
            }
            let target = total;
            total = step.slow(slows, *made, target);
            *made = Some(total);
            let moves = output
                .lines
                .iter()
                .any(|line| line.mix != Mix::Multiply && !line.is_background());
            step.held |= moves && total != target && output.output.kind() != OutputKind::Button;
            all.push(MixedOutput {
                name: output.output,
                lines,
                value: total,
            });
        }
        all
    }

    /// Buttons that rise. While the inputs are not trusted only Stop does.
    fn fire(&mut self, outputs: &[MixedOutput], was_live: bool) -> Vec<OutputName> {
        let mut fired = Vec::new();
        for (output, memory) in outputs.iter().zip(&mut self.outputs) {
            if output.name.kind() != OutputKind::Button {
                continue;
            }
            let pressed = output.value > PRESSED;
            let rises = pressed && memory.freed;
            memory.freed = !pressed;
            if rises && (was_live || output.name == OutputName::Stop) {
                fired.push(output.name);
            }
        }
        fired
    }

    fn limited(&self, mut outputs: Vec<MixedOutput>) -> Vec<MixedOutput> {
        for (mixed, output) in outputs.iter_mut().zip(&self.profile.outputs) {
            mixed.value = match self.state {
                MixState::Live => output.value(mixed.value),
                MixState::Failsafe => output.failsafe,
            };
        }
        outputs
    }
}

/// One step of all lines.
struct Step {
    now_us: u64,
    span_s: f64,
    /// Something that moves or cleans is away from rest, slows included.
    held: bool,
    /// The inputs that are.
    away: Vec<AwayFromRest>,
    /// Their devices.
    pushed: BTreeSet<Device>,
    /// The outputs followed the inputs in the step before.
    is_live: bool,
}

impl Step {
    /// One line. `input` is none while it is absent or the line is switched off.
    fn line(&self, (line, memory): (&Line, &mut LineMemory), input: Option<f64>, total: f64) -> LineStages {
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
    fn slow(&self, slows: Slows, from: Option<f64>, to: f64) -> f64 {
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

    /// Notes whether a line makes the person the driver.
    fn note(&mut self, (profile, line): (&Profile, &Line), stages: &LineStages, reading: Option<f64>) {
        let Some(reading) = reading else { return };
        if line.mix == Mix::Multiply || line.is_background() {
            return;
        }
        let idle = if line.when.is_some() {
            0.0
        } else {
            idle(profile, line)
        };
        if stages.weighted != idle {
            self.away_from_rest(&line.input, reading);
            self.pushed.extend(profile.devices_of(line));
            self.held = true;
        }
    }

    fn away_from_rest(&mut self, input: &Source, reading: f64) {
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
struct Slows {
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
    fn tighten(&mut self, line: &Line) {
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
fn read(profile: &Profile, switches: &[SwitchMemory], readings: &Readings, source: &Source) -> Option<f64> {
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

fn is_on(profile: &Profile, switches: &[SwitchMemory], name: &Name) -> bool {
    let place = profile.switches.iter().position(|switch| switch.name == *name);
    place
        .and_then(|place| switches.get(place))
        .is_some_and(|switch| switch.on)
}
