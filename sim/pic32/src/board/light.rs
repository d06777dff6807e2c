//! The robot's lights and tone, as people perceive them.

use crate::machine::Machine;
use crate::pins::{Level, Pin};

use super::CYCLES_PER_S;
use super::wiring::{DigitalLine, Wiring, selected};

/// Channel of the sound multiplexer behind which the speaker is.
const SPEAKER: u8 = 7;

const SUPPLIES: usize = 3;
const DIGITS: usize = 4;
const LIGHT_LINES: usize = 5;
/// Supplies of lights, then commons of digits.
const ROWS: usize = SUPPLIES + DIGITS;
/// Lines of lights, then the two that only the display has.
const COLUMNS: usize = LIGHT_LINES + 2;
/// Segments of a digit.
const SEGMENTS: usize = 7;

/// For how many cycles each light has been lit, by supply (main, battery, unknown) and line (0 to 4), and each segment of a
/// display, if one is fitted there. A light is lit while its supply and its line are on, a segment while its digit and its
/// line are.
#[derive(Clone, Debug)]
pub(super) struct LampTimes {
    rows: [DigitalLine; ROWS],
    columns: [DigitalLine; COLUMNS],
    /// Columns of the segments a to g.
    segments: [usize; SEGMENTS],
    on: [bool; ROWS + COLUMNS],
    at: u64,
    lit: [[u64; COLUMNS]; ROWS],
}

impl LampTimes {
    pub(super) fn new(wiring: &Wiring) -> Self {
        let [s0, s1, s2] = wiring.light_supplies;
        let [d0, d1, d2, d3] = wiring.display.digits;
        let [l0, l1, l2, l3, l4] = wiring.light_lines;
        let [a, b] = wiring.display.own_segments;
        let columns = [l0, l1, l2, l3, l4, a, b];
        let column = |line: DigitalLine| {
            let same = columns.iter().position(|column| column.pin == line.pin);
            // The wiring was made of the same lines.
            same.unwrap_or_default()
        };
        Self {
            rows: [s0, s1, s2, d0, d1, d2, d3],
            columns,
            segments: wiring.display.segments.map(column),
            on: [false; ROWS + COLUMNS],
            at: 0,
            lit: [[0; COLUMNS]; ROWS],
        }
    }

    fn pins(&self) -> impl Iterator<Item = DigitalLine> {
        self.rows.into_iter().chain(self.columns)
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
        let (rows, columns) = self.on.split_at(ROWS);
        for (lit, _) in self.lit.iter_mut().zip(rows).filter(|(_, on)| **on) {
            for (lit, _) in lit.iter_mut().zip(columns).filter(|(_, on)| **on) {
                *lit += passed;
            }
        }
    }

    pub(super) fn lit_cycles(&self) -> [[u64; LIGHT_LINES]; SUPPLIES] {
        std::array::from_fn(|supply| std::array::from_fn(|line| self.lit[supply][line]))
    }

    pub(super) fn digit_cycles(&self) -> [[u64; SEGMENTS]; DIGITS] {
        std::array::from_fn(|digit| self.segments.map(|column| self.lit[SUPPLIES + digit][column]))
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
