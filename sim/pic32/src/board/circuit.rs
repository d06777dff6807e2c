//! Levels of the ADC's inputs at the moment of a sample.

use home::{Pcg, Sensors};

use super::CYCLES_PER_S;
use super::calibration::Particulars;
use super::power::{ChargeCurrent, divider_counts};
use super::wiring::{Wiring, selected};
use crate::machine::{Outputs, Surroundings};
use crate::pins::PinDriver;

/// Highest reading of the converter.
const FULL_SCALE: f64 = 1023.0;
/// Noise of a reading, counts, one standard deviation: what a board with a switching charger has at least.
const NOISE: f64 = 0.6;
/// Counts of the converter for one step of the home's 8-bit levels.
const COUNTS_PER_LEVEL: f64 = 4.0;
/// Light of the room on a proximity receiver, counts.
const ROOM_LIGHT: f64 = 60.0;
/// Channels of the multiplexers with a sensor.
const SENSORS: u8 = 7;

/// An analog input that is held at a reading from a cycle on, whatever its circuit says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Held {
    counts: u16,
    from: u64,
    until: u64,
}

/// All circuits at analog inputs.
#[derive(Clone, Debug)]
pub(super) struct Circuit {
    wiring: Wiring,
    particulars: Particulars,
    random: Pcg,
    held: [Option<Held>; 16],
    /// What the home says, of this millisecond.
    pub(super) sensors: Sensors,
    pub(super) charge: ChargeCurrent,
    proximity: Follower,
    cliffs: [Follower; 3],
}

/// A receiver that follows the light slowly.
#[derive(Clone, Copy, Debug, Default)]
struct Follower {
    /// What it would read after a long time, and before the last change.
    target: f64,
    before: f64,
    changed: u64,
}

impl Follower {
    /// The reading at `cycle`, when the light has been `target` since `changed`.
    fn read(&mut self, target: f64, (changed, cycle): (u64, u64), receiver_s: f64) -> f64 {
        if changed != self.changed {
            self.before = self.target;
            self.changed = changed;
        }
        self.target = target;
        let passed_s = cycle.saturating_sub(changed) as f64 / CYCLES_PER_S as f64;
        target + (self.before - target) * (-passed_s / receiver_s).exp()
    }
}

const STREAM: u64 = 0xADC0;

impl Circuit {
    pub(super) fn new(wiring: Wiring, particulars: Particulars, seed: u64) -> Self {
        Self {
            wiring,
            particulars,
            random: Pcg::new(seed, STREAM),
            held: [None; 16],
            sensors: Sensors::default(),
            charge: ChargeCurrent::default(),
            proximity: Follower::default(),
            cliffs: [Follower::default(); 3],
        }
    }

    /// Holds an input at a reading from a cycle on; `until` may be `u64::MAX`.
    pub(super) fn hold(&mut self, channel: u8, counts: u16, (from, until): (u64, u64)) {
        if let Some(held) = self.held.get_mut(usize::from(channel)) {
            *held = Some(Held { counts, from, until });
        }
    }

    /// Whether the cliff sensors' emitters shine, by what the chip does to the line that may switch them.
    pub(super) fn emitters_lit(&self, line: PinDriver) -> bool {
        !self.particulars.cliff_emitters_switched || self.wiring.cliff_emitters.is_on(line)
    }

    /// Whether the input is held now, and at which reading.
    pub(super) fn held(&self, channel: u8, cycle: u64) -> Option<u16> {
        let held = (*self.held.get(usize::from(channel))?)?;
        (held.from <= cycle && cycle < held.until).then_some(held.counts)
    }

    fn counts(&mut self, channel: u8, cycle: u64, outputs: &Outputs<'_>) -> f64 {
        let wiring = &self.wiring;
        if channel == wiring.receive {
            return self.proximity_counts(cycle, outputs);
        }
        if let Some(number) = wiring.cliffs.iter().position(|known| *known == channel) {
            return self.cliff_counts(number, cycle, outputs);
        }
        if let Some(number) = wiring.wheels.iter().position(|wheel| wheel.current == channel) {
            return self.current_counts(number);
        }
        let pack_v = f64::from(self.sensors.battery_voltage.0) / 1000.0;
        match channel {
            _ if channel == wiring.button_ladder => self.ladder_counts(),
            _ if channel == wiring.battery_volts => divider_counts(pack_v, &self.particulars),
            _ if channel == wiring.charger_volts => {
                let offset = f64::from(self.particulars.charge_zero) / 100.0;
                divider_counts(pack_v + self.charge.shunt_v(), &self.particulars) + offset
            }
            _ if channel == wiring.thermistor => {
                let celsius = f64::from(self.sensors.battery_temperature.0) / 10.0;
                self.particulars.thermistor.counts(celsius)
            }
            // Nothing is connected there.
            _ => 0.0,
        }
    }

    fn ladder_counts(&self) -> f64 {
        let down = |number: &usize| self.sensors.buttons >> number & 1 == 1;
        let lowest = (0..3)
            .filter(down)
            .map(|number| self.particulars.ladder[number])
            .min();
        f64::from(lowest.unwrap_or(0))
    }

    fn current_counts(&self, wheel: usize) -> f64 {
        let current = [self.sensors.wheel_left_current, self.sensors.wheel_right_current][wheel];
        let zero = f64::from(self.particulars.current_zero[wheel]);
        let scale = match self.particulars.current_scale {
            0 => 1,
            scale => scale,
        };
        zero + f64::from(current.0) * 1000.0 / f64::from(scale)
    }

    fn cliff_counts(&mut self, number: usize, cycle: u64, outputs: &Outputs<'_>) -> f64 {
        let emitters = self.wiring.cliff_emitters;
        let lit = self.emitters_lit(outputs.output(emitters.pin));
        let levels = if lit {
            self.sensors.cliff_levels
        } else {
            self.sensors.cliff_dark
        };
        let target = f64::from(levels[number]) * COUNTS_PER_LEVEL * self.particulars.cliff_gain[number];
        let moments = (outputs.changed(emitters.pin), cycle);
        self.cliffs[number].read(target, moments, self.particulars.receiver_s)
    }

    /// The receive multiplexer shows the sensor that is selected; the transmit multiplexer, which has the same select
    /// lines, lights its emitter.
    fn proximity_counts(&mut self, cycle: u64, outputs: &Outputs<'_>) -> f64 {
        let emit = self.wiring.emit;
        let select = &self.wiring.sensor_select;
        let channel = selected(select, |pin| outputs.output(pin));
        let target = if channel >= SENSORS {
            0.0
        } else if emit.is_on(outputs.output(emit.pin)) {
            ROOM_LIGHT + self.reflected(usize::from(channel))
        } else {
            ROOM_LIGHT
        };
        let pins = select.iter().map(|line| line.pin).chain([emit.pin]);
        let changed = pins.map(|pin| outputs.changed(pin)).max().unwrap_or(0);
        self.proximity
            .read(target, (changed, cycle), self.particulars.receiver_s)
    }

    fn reflected(&self, sensor: usize) -> f64 {
        let [none, touching] = self.particulars.proximity.map(f64::from);
        none + (touching - none) * f64::from(self.sensors.proximity[sensor]) / 255.0
    }
}

impl Surroundings for Circuit {
    fn analog(&mut self, channel: u8, cycle: u64, outputs: &Outputs<'_>) -> u16 {
        let counts = self.counts(channel, cycle, outputs);
        if let Some(counts) = self.held(channel, cycle) {
            return counts;
        }
        let read = counts * self.particulars.converter_gain + self.particulars.converter_offset;
        let noisy = read + NOISE * self.random.normal();
        noisy.round().clamp(0.0, FULL_SCALE) as u16
    }
}
