//! A master of SPI in mode 1 on the pins of the chip: data changes with the rising edge of the clock and is read with the falling
//! one.

use std::convert::Infallible;

use pic32::board::{CYCLES_PER_S, EmulatedRobot, SpiPlaces};
use pic32::pins::{Level, Pin};
use robot_link::SpiBus;
use rvac_protocol::fill::FillDecoder;

use super::noise::PulseFault;
use super::{Cable, DRIVER_CYCLES, advance, now};

const PLACES: SpiPlaces = SpiPlaces::SR8730;
/// From the select line to the first clock, and from the last clock to the select line: 2 us.
const SELECT_CYCLES: u64 = CYCLES_PER_S * 2 / 1_000_000;

/// What the chip's pins carried, as whole bytes since the select line fell.
#[derive(Clone, Debug, Default)]
struct PinBytes {
    bits: u32,
    heard: u8,
    said: u8,
    from_host: FillDecoder,
    from_robot: FillDecoder,
}

impl PinBytes {
    /// A falling edge of the clock, with the levels of both lines.
    fn clock(&mut self, (heard, said): (bool, bool)) -> Option<(Option<u8>, Option<u8>)> {
        self.heard = self.heard << 1 | u8::from(heard);
        self.said = self.said << 1 | u8::from(said);
        self.bits += 1;
        if self.bits < 8 {
            return None;
        }
        self.bits = 0;
        Some((self.from_host.push(self.heard), self.from_robot.push(self.said)))
    }
}

/// The master, and the cable to the chip.
#[derive(Clone, Debug)]
pub struct SpiMaster {
    half_cycles: u64,
    /// The cable.
    pub cable: Cable,
    is_connected: bool,
    is_selected: bool,
    pins: PinBytes,
    /// What the robot drives, as of the last edge.
    output: bool,
}

impl SpiMaster {
    /// A master with this clock that lets go of the select line.
    #[must_use]
    pub fn new(robot: &mut EmulatedRobot, hz: u32) -> Self {
        let machine = robot.machine_mut();
        machine.watch(PLACES.output);
        machine.set_input(PLACES.select, Level::High);
        machine.set_input(PLACES.clock, Level::Low);
        machine.set_input(PLACES.input, Level::Low);
        Self {
            half_cycles: CYCLES_PER_S / 2 / u64::from(hz),
            cable: Cable::new(PLACES.attention),
            is_connected: true,
            is_selected: false,
            pins: PinBytes::default(),
            output: false,
        }
    }

    /// When the clock rises and falls for a bit that begins at this cycle.
    fn pulses(&mut self, begin: u64) -> Vec<(u64, u64)> {
        let half = self.half_cycles;
        match self.cable.pulse() {
            PulseFault::None => vec![(begin, begin + half)],
            PulseFault::Lost => Vec::new(),
            PulseFault::Doubled => vec![(begin, begin + half / 3), (begin + 2 * half / 3, begin + half)],
        }
    }
}

/// The master at work on a robot.
#[derive(Debug)]
pub struct SpiWires<'a> {
    /// The robot.
    pub robot: &'a mut EmulatedRobot,
    /// The master.
    pub master: &'a mut SpiMaster,
}

impl SpiWires<'_> {
    fn put(&mut self, cycle: u64, pin: Pin, high: bool) {
        if self.master.is_connected {
            let machine = self.robot.machine_mut();
            machine.schedule_input(cycle, pin, Level::of(high));
        }
    }

    /// Pulls the cable out or puts it in, if that is due. Without it the chip's pull-up holds the select line high.
    fn follow_cable(&mut self, cycle: u64) {
        let is_connected = !self.master.cable.is_out(cycle);
        if is_connected == self.master.is_connected {
            return;
        }
        // What is put on the pins in this moment counts in both directions.
        self.master.is_connected = true;
        let is_selected = is_connected && self.master.is_selected;
        self.put(cycle, PLACES.select, !is_selected);
        self.put(cycle, PLACES.clock, false);
        self.put(cycle, PLACES.input, false);
        self.master.is_connected = is_connected;
        if !is_selected {
            self.master.pins.bits = 0;
        }
    }

    fn select(&mut self, is_selected: bool) {
        let cycle = now(self.robot);
        self.follow_cable(cycle);
        self.master.is_selected = is_selected;
        self.put(cycle, PLACES.select, !is_selected);
        if !is_selected {
            self.master.pins.bits = 0;
        }
        advance(self.robot, cycle + SELECT_CYCLES);
    }

    /// Clocks one bit out and in.
    fn exchange_bit(&mut self, out: bool) -> bool {
        let begin = now(self.robot);
        let half = self.master.half_cycles;
        self.follow_cable(begin);
        let is_connected = self.master.is_connected;
        let level = self.master.cable.bit(out);
        self.put(begin, PLACES.input, level);
        let pulses = self.master.pulses(begin);
        for (rise, fall) in &pulses {
            self.put(*rise, PLACES.clock, true);
            self.put(*fall, PLACES.clock, false);
        }
        advance(self.robot, begin + 2 * half);
        let edges = self.robot.machine_mut().take_edges(PLACES.output);
        let before = self.master.output;
        let said_at = |cycle: u64| {
            let last = edges.iter().rev().find(|(at, _)| *at < cycle);
            last.map_or(before, |(_, level)| level.is_high())
        };
        let read = is_connected && said_at(begin + half);
        if is_connected {
            for (_, fall) in &pulses {
                self.note((level, said_at(*fall)));
            }
        }
        self.master.output = said_at(u64::MAX);
        self.master.cable.bit(read)
    }

    fn note(&mut self, levels: (bool, bool)) {
        if let Some((heard, said)) = self.master.pins.clock(levels) {
            self.master.cable.say(said);
            self.robot.carried_by_bus(heard, said);
        }
    }
}

impl SpiBus for SpiWires<'_> {
    type Error = Infallible;

    fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        self.select(true);
        for byte in bytes.iter_mut() {
            let out = *byte;
            *byte = (0..8).rev().fold(0, |read, bit| {
                read << 1 | u8::from(self.exchange_bit(out >> bit & 1 != 0))
            });
        }
        self.select(false);
        let free = now(self.robot) + DRIVER_CYCLES;
        advance(self.robot, free);
        Ok(())
    }
}
