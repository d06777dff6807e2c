//! The robot's lights and tone, as people perceive them.

use crate::machine::Machine;
use crate::pins::{Level, Pin};

use super::CYCLES_PER_S;
use super::wiring::{DigitalLine, Wiring, selected};

/// Channel of the sound multiplexer behind which the speaker is.
const SPEAKER: u8 = 7;

/// For how many cycles each light has been lit: by supply (main, battery, unknown) and line (0 to 4). A light is lit
/// while its supply and its line are on.
#[derive(Clone, Debug)]
pub(super) struct LampTimes {
    supplies: [DigitalLine; 3],
    lines: [DigitalLine; 5],
    on: [bool; 8],
    at: u64,
    lit: [[u64; 5]; 3],
}

impl LampTimes {
    pub(super) fn new(wiring: &Wiring) -> Self {
        Self {
            supplies: wiring.light_supplies,
            lines: wiring.light_lines,
            on: [false; 8],
            at: 0,
            lit: [[0; 5]; 3],
        }
    }

    fn pins(&self) -> impl Iterator<Item = DigitalLine> {
        self.supplies.into_iter().chain(self.lines)
    }

    /// All pins whose edges this needs.
    pub(super) fn watch(&self, machine: &mut Machine) {
        self.pins().for_each(|line| machine.watch(line.pin));
    }

    /// Takes the edges up to `end`.
    pub(super) fn take(&mut self, machine: &mut Machine, end: u64) {
        let mut changes: Vec<(u64, usize, bool)> = Vec::new();
        for (number, line) in self.pins().enumerate() {
            let edges = machine.take_edges(line.pin).into_iter();
            changes.extend(edges.map(|(cycle, level)| (cycle, number, level == line.active)));
        }
        changes.sort_unstable();
        for (cycle, number, on) in changes {
            self.pass(cycle);
            self.on[number] = on;
        }
        self.pass(end);
    }

    fn pass(&mut self, cycle: u64) {
        let passed = cycle.saturating_sub(self.at);
        self.at = cycle.max(self.at);
        for (supply, lit) in self.lit.iter_mut().enumerate() {
            for (line, lit) in lit.iter_mut().enumerate() {
                if self.on[supply] && self.on[self.supplies.len() + line] {
                    *lit += passed;
                }
            }
        }
    }

    pub(super) const fn lit_cycles(&self) -> [[u64; 5]; 3] {
        self.lit
    }
}

/// The tone of the speaker.
#[derive(Clone, Debug)]
pub(super) struct SpeakerTone {
    tone: Pin,
    enable: DigitalLine,
    select: [DigitalLine; 3],
    last_rise: Option<u64>,
    period: Option<u64>,
}

/// A tone has ended when there was no period for this long: 20 Hz is the lowest that is heard.
const SILENCE: u64 = CYCLES_PER_S / 15;

impl SpeakerTone {
    pub(super) fn new(wiring: &Wiring) -> Self {
        Self {
            tone: wiring.sound_tone.pin,
            enable: wiring.sound_enable,
            select: wiring.sound_select,
            last_rise: None,
            period: None,
        }
    }

    pub(super) fn watch(&self, machine: &mut Machine) {
        machine.watch(self.tone);
    }

    /// Takes the edges of the last millisecond.
    pub(super) fn take(&mut self, machine: &mut Machine) {
        for (cycle, level) in machine.take_edges(self.tone) {
            if level == Level::High {
                // A longer pause is silence between two tones.
                let since = self.last_rise.map(|last| cycle - last);
                self.period = since.filter(|period| *period < SILENCE);
                self.last_rise = Some(cycle);
            }
        }
    }

    /// What the speaker sounds, Hz; `None` while it is silent.
    pub(super) fn pitch_hz(&self, machine: &Machine) -> Option<f64> {
        let output = |pin| machine.output(pin);
        let routed = selected(&self.select, output) == SPEAKER && self.enable.is_on(output(self.enable.pin));
        let fresh = self
            .last_rise
            .is_some_and(|last| machine.cycle() - last < SILENCE);
        let period = self.period.filter(|period| routed && fresh && *period > 0)?;
        Some(CYCLES_PER_S as f64 / period as f64)
    }
}
