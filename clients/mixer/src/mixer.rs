//! The mixer: from readings to outputs, stage by stage.

use std::collections::BTreeSet;

use crate::flight_mode::Fade;
use crate::line::Mix;
use crate::line_step::{LineMemory, Slows, Step, is_on, read};
use crate::readings::PRESSED;
use crate::stop_buttons::StopButtons;
use crate::switch::SwitchMemory;
use crate::trim::{self, TrimButtons};
use crate::{
    Device, FlightMode, Name, OutputKind, OutputName, Profile, ProfileError, Readings, Source, Trim,
    TrimValue, standard_profile,
};

/// A longer pause between two steps is a loss: the page slept, or the lid was closed.
pub const GAP_MAX_US: u64 = 400_000;

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
    /// The flight mode that holds, by its place in the profile; none when no switch of one is on.
    pub mode: Option<usize>,
    /// The trims as they are in that mode, in the order of the profile.
    pub trims: Vec<TrimValue>,
    /// Buttons that rose in this step. Stop does so after a loss too.
    pub fired: Vec<OutputName>,
}

#[derive(Clone, Debug, Default)]
struct OutputMemory {
    lines: Vec<LineMemory>,
    /// What the lines made together in the last step, after slow.
    made: Option<f64>,
    /// What they made when the flight mode changed.
    fades_from: f64,
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
    /// The flight mode that holds, and how the outputs go over to it.
    mode: Option<usize>,
    fade: Option<Fade>,
    trim_buttons: Vec<TrimButtons>,
    /// Those of the profile, as they were set since.
    trims: Vec<Trim>,
    modes: Vec<FlightMode>,
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
            mode: None,
            fade: None,
            trim_buttons: Vec::new(),
            trims: Vec::new(),
            modes: Vec::new(),
            last_us: None,
            state: MixState::Failsafe,
            stops: StopButtons::default(),
        };
        mixer.stops = StopButtons::of(&mixer.profile);
        mixer.trims.clone_from(&mixer.profile.trims);
        mixer.modes.clone_from(&mixer.profile.modes);
        mixer.forget();
        mixer
    }

    /// The profile.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The profile with its trims as they were set since.
    #[must_use]
    pub fn trimmed(&self) -> Profile {
        Profile {
            trims: self.trims.clone(),
            modes: self.modes.clone(),
            ..self.profile.clone()
        }
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
        self.step_mode(now_us);
        self.step_trims(readings);
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
            mode: self.mode,
            trims: self.trim_values(),
            fired,
        }
    }

    /// Forgets everything that lasts: slows, delays, toggles, buttons.
    fn forget(&mut self) {
        let memory = |output: &crate::Output| OutputMemory {
            lines: vec![LineMemory::default(); output.lines.len()],
            made: None,
            fades_from: 0.0,
            freed: false,
        };
        self.outputs = self.profile.outputs.iter().map(memory).collect();
        self.switches = vec![SwitchMemory::default(); self.profile.switches.len()];
        self.trim_buttons = vec![TrimButtons::default(); self.profile.trims.len()];
        self.fade = None;
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

    /// The first flight mode whose switch is on holds from now on.
    fn step_mode(&mut self, now_us: u64) {
        let modes = self.profile.modes.iter();
        let is_on = |mode: &FlightMode| is_on(&self.profile, &self.switches, &mode.when);
        let mode = modes.clone().position(is_on);
        if mode == self.mode {
            return;
        }
        // Out of a mode the outputs go over as slowly as into it.
        let fade_ms = [self.mode, mode]
            .into_iter()
            .flatten()
            .filter_map(|place| self.profile.modes.get(place))
            .map(|mode| mode.fade_ms)
            .max();
        self.fade = Some(Fade {
            began_us: now_us,
            length_us: u64::from(fade_ms.unwrap_or(0)) * 1000,
        });
        for output in &mut self.outputs {
            output.fades_from = output.made.unwrap_or_default();
        }
        self.mode = mode;
    }

    /// Buttons that trim, which do nothing until the outputs follow the inputs.
    fn step_trims(&mut self, readings: &Readings) {
        let Self {
            profile,
            switches,
            trim_buttons,
            ..
        } = self;
        let value = |source: &Source| read(profile, switches, readings, source);
        let presses: Vec<f64> = profile
            .trims
            .iter()
            .zip(trim_buttons)
            .map(|(trim, buttons)| buttons.rise(trim, value))
            .collect();
        if self.state != MixState::Live {
            return;
        }
        let Self {
            trims, modes, mode, ..
        } = self;
        for (trim, steps) in trims.iter_mut().zip(presses).filter(|(_, steps)| *steps != 0.0) {
            trim::press(trim, mode.and_then(|place| modes.get_mut(place)), steps);
        }
    }

    fn trim_values(&self) -> Vec<TrimValue> {
        let mode = self.mode.and_then(|place| self.modes.get(place));
        let trims = self.trims.iter();
        trims
            .map(|trim| TrimValue {
                output: trim.output,
                value: trim::value_in(trim, mode),
            })
            .collect()
    }

    /// The lines of all outputs; the values are not limited yet.
    fn step_outputs(&mut self, step: &mut Step, readings: &Readings) -> Vec<MixedOutput> {
        let Self {
            profile,
            outputs,
            switches,
            mode,
            fade,
            ..
        } = self;
        let mode = mode
            .and_then(|place| profile.modes.get(place))
            .map(|mode| &mode.name);
        let mut all = Vec::with_capacity(outputs.len());
        for (output, memory) in profile.outputs.iter().zip(outputs) {
            let mut total = 0.0;
            let mut slows = Slows::default();
            let mut lines = Vec::with_capacity(output.lines.len());
            let OutputMemory {
                lines: line_memories,
                made,
                fades_from,
                ..
            } = memory;
            let mut is_pushed = false;
            for (line, memory) in output.lines.iter().zip(line_memories) {
                let raw = read(profile, switches, readings, &line.input);
                let is_permitted = line
                    .when
                    .as_ref()
                    .is_none_or(|name| is_on(profile, switches, name))
                    && line.counts_in(mode);
                let input = raw.filter(|_| is_permitted);
                let stages = step.line((line, memory), input, total);
                let reading = readings.value(&line.input).or(raw).unwrap_or_default();
                if output.output.kind() != OutputKind::Button {
                    is_pushed |= step.note((profile, line), &stages, input.map(|_| reading));
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
            // Who lets go waits for no fade.
            if let Some(fade) = fade.filter(|_| is_pushed) {
                total = fade.between(*fades_from, total, step.now_us);
            }
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
        let trims = self.trim_values();
        for (mixed, output) in outputs.iter_mut().zip(&self.profile.outputs) {
            let trim = trims.iter().find(|trim| trim.output == output.output);
            mixed.value = match self.state {
                MixState::Live => output.value(mixed.value, trim.map_or(0.0, |trim| trim.value)),
                MixState::Failsafe => output.failsafe,
            };
        }
        outputs
    }
}
