//! The robot: chip, board and home together.

mod handles;
mod passing;
mod settings;

pub use settings::{Blueprint, BlueprintError, CalibrationChoice, EmulatedSettings};

use home::{Actuation, Fnv1a, RobotModel, World};
use monitor::{Bridges, Charging, Drives, HardwareTruth, Monitor, Pins, Sensed, Sides, WheelLoad};
use rvac_channel::ReceivedByte;

use crate::board::CYCLES_PER_MS;
use crate::board::beams::Beams;
use crate::board::circuit::Circuit;
use crate::board::contacts::{Contact, Contacts};
use crate::board::dock_code::DockEar;
use crate::board::encoder::{BrushEncoder, Encoder, Position, ScheduledEdge};
use crate::board::gyro::EmulatedGyro;
use crate::board::light::{LampTimes, SpeakerTone};
use crate::board::motors::{MotorOutput, MotorOutputs};
use crate::board::power::{Feed, SLICE, SwitchUse};
use crate::board::serial::{BitReceiver, HostPort, Sender};
use crate::board::wiring::{Wiring, selected};
use crate::machine::Machine;
use crate::pins::{Level, PinDriver};
use passing::BegunTick;

/// Channel of the transmit multiplexer whose emitter the dock sees.
const FRONT: u8 = 3;
/// A lit cliff receiver below this has no floor before it, out of 255: floors give about 180, drops about 10.
const NO_FLOOR_LEVEL: u8 = 20;
/// Time after a change of the emitters in which cliff levels are not valid.
const CLIFF_SETTLE_MS: u32 = 3;
/// The charger's envelope: its mean over less says nothing.
const ENVELOPE_MS: u64 = 20;
/// Vector of the core timer.
const CORE_TIMER: u8 = 0;

/// The emulated chip on its board in a simulated home, with a serial line of edges and the safety monitor. One tick is
/// 1 ms of the home and 80,000 cycles of the chip.
#[derive(Clone, Debug)]
pub struct EmulatedRobot {
    machine: Machine,
    wiring: Wiring,
    model: RobotModel,
    world: World,
    circuit: Circuit,
    contacts: Contacts,
    encoders: [Encoder; 2],
    brush: BrushEncoder,
    beams: Beams,
    gyro: EmulatedGyro,
    motors: MotorOutputs,
    ear: DockEar,
    emitter_selected: bool,
    lights: LampTimes,
    sound: SpeakerTone,
    to_robot: Sender,
    robot_hears: BitReceiver,
    to_host: HostPort,
    monitor: Monitor,
    digest: Fnv1a,
    actuation: Actuation,
    edges: Vec<ScheduledEdge>,
    line_edges: Vec<(u64, Level)>,
    charge_cycles: u64,
    /// The last millisecond in which the charging switch was closed.
    charge_driven_ms: Option<u64>,
    charge_switch_shorted: bool,
    /// Entries of the core timer's handler at the last reset, until the first one after it.
    ticks_before: Option<u64>,
    now_ms: u64,
    /// The millisecond that has begun and not ended.
    begun: Option<BegunTick>,
    resets: u32,
    cliff_settled_ms: u32,
    /// Receivers that saw no floor when they were lit last, from the left.
    cliffs_seen: [bool; 3],
    /// What somebody has broken in the chip.
    broken: HardwareTruth,
}

impl EmulatedRobot {
    /// Switches the robot on where `world` has put it.
    #[must_use]
    pub fn new(blueprint: &Blueprint, world: World, settings: &EmulatedSettings) -> Self {
        let wiring = &blueprint.wiring;
        let particulars = &settings.miscalibration.map_or(blueprint.particulars, |seed| {
            blueprint.particulars.deviating(seed)
        });
        let seed = settings.seed;
        let encoder =
            |side: usize| Encoder::new(wiring.wheels[side].encoder, particulars.encoder_swapped[side]);
        let mut robot = Self {
            machine: Machine::new(&blueprint.image),
            model: world.model().clone(),
            circuit: Circuit::new(wiring.clone(), *particulars, seed),
            contacts: Contacts::new(wiring, settings.bounce_us, seed),
            encoders: [encoder(0), encoder(1)],
            brush: BrushEncoder::new(wiring.brush_encoder, particulars.brush_pulses_per_s),
            beams: Beams::new(wiring.beam_receivers, particulars.beams, particulars.beam_unit_us),
            gyro: EmulatedGyro::new(wiring, (particulars, blueprint.gyro), seed),
            motors: MotorOutputs::new(wiring, settings.bridges == Bridges::DeafToBrake),
            ear: DockEar::new(particulars.dock_code_ones),
            emitter_selected: false,
            lights: LampTimes::new(wiring),
            sound: SpeakerTone::new(wiring),
            to_robot: Sender::new(settings.rate, seed),
            robot_hears: BitReceiver::new(settings.rate.bit_cycles()),
            to_host: HostPort::new(settings.rate, seed.wrapping_add(1)),
            monitor: Monitor::new(),
            digest: Fnv1a::default(),
            actuation: Actuation {
                charge_a: Some(0.0),
                ..Actuation::default()
            },
            edges: Vec::new(),
            line_edges: Vec::new(),
            charge_cycles: 0,
            charge_driven_ms: None,
            charge_switch_shorted: false,
            ticks_before: Some(0),
            now_ms: 0,
            begun: None,
            resets: 0,
            cliff_settled_ms: 0,
            cliffs_seen: [false; 3],
            broken: HardwareTruth::default(),
            wiring: wiring.clone(),
            world,
        };
        robot.connect();
        robot
    }

    /// Sets every line to its level at rest, and watches those that must be observed to the cycle.
    fn connect(&mut self) {
        let now = self.machine.cycle();
        let mut edges = self.contacts.levels(now).to_vec();
        edges.extend(self.encoders.iter().flat_map(|encoder| encoder.levels(now)));
        edges.extend(self.beams.levels(now));
        edges.push(self.brush.level(now));
        for (_, pin, level) in edges {
            self.machine.set_input(pin, level);
        }
        let idle_lines = self.wiring.uart_receive.into_iter();
        let link = self.wiring.link_receive.map(|line| line.pin);
        for pin in idle_lines.chain(link) {
            self.machine.set_input(pin, Level::High);
        }
        let emitter = self.wiring.sensor_select.map(|line| line.pin);
        for pin in emitter.into_iter().chain([
            self.wiring.emit.pin,
            self.wiring.link_transmit.pin,
            self.wiring.charge.pin,
        ]) {
            self.machine.watch(pin);
        }
        // The host's UART holds its input high while it is not driven.
        let host_input = [self.wiring.link_transmit.pin];
        for pin in self.wiring.pulled_up.iter().chain(&host_input) {
            self.machine.pull_up(*pin);
        }
        self.lights.watch(&mut self.machine);
        self.sound.watch(&mut self.machine);
    }

    /// The home moves wheels and switches.
    fn drive_inputs(&mut self, from: u64) {
        let sensors = &self.circuit.sensors;
        self.edges.clear();
        self.contacts.pass_ms(from, sensors, &mut self.edges);
        let shown = [sensors.count_left, sensors.count_right];
        let exact = self.world.encoder_positions();
        for side in 0..2 {
            let position = Position {
                exact: exact[side],
                shown: shown[side],
            };
            self.encoders[side].turn(position, from, &mut self.edges);
        }
        self.brush.turn(self.actuation.brush_main, from, &mut self.edges);
        self.beams.pass_ms(from, sensors.dock_receivers, &mut self.edges);
        for (cycle, pin, level) in self.edges.drain(..) {
            self.machine.schedule_input(cycle, pin, level);
        }
        self.gyro.pass_ms(from, sensors.gyro, &mut self.machine);
    }

    fn send_to_robot(&mut self, from: u64) {
        self.line_edges.clear();
        self.to_robot.pass_ms(from, &mut self.line_edges);
        let mut arrivals = Vec::new();
        let pins = self.wiring.link_receive.map(|line| line.pin);
        for (cycle, level) in &self.line_edges {
            for pin in pins {
                self.machine.schedule_input(*cycle, pin, *level);
            }
            self.robot_hears.edge(*cycle, *level, &mut arrivals);
        }
        self.robot_hears.advance(from + CYCLES_PER_MS, &mut arrivals);
        for (_, received) in arrivals {
            let byte = match received {
                ReceivedByte::Byte(byte) => Some(byte),
                ReceivedByte::FramingError | ReceivedByte::Overrun => None,
            };
            self.monitor.heard(self.now_ms, byte);
            self.digest.byte(byte.unwrap_or_default());
        }
    }

    /// Runs the chip. While the charger's switch is pulsed the circuit is looked at in every period of the PWM.
    fn run(&mut self, from: u64, end: u64) {
        let pulsed = self.machine.high_cycles(self.wiring.charge.pin) != self.charge_cycles;
        let step = if pulsed || self.circuit.charge.is_flowing() {
            SLICE
        } else {
            end - from
        };
        let mut at = from;
        while at < end {
            at = (at + step).min(end);
            self.machine.run_until(at, &mut self.circuit);
            self.charge(step);
        }
    }

    fn charge(&mut self, cycles: u64) {
        let line = self.wiring.charge;
        let total = self.machine.high_cycles(line.pin);
        let high = total - self.charge_cycles;
        self.charge_cycles = total;
        let closed = match (line.active, self.machine.output(line.pin)) {
            (Level::High, _) => high,
            // A resistor opens the switch while nobody drives it.
            (Level::Low, PinDriver::Floating) => 0,
            (Level::Low, _) => cycles.saturating_sub(high),
        };
        let mut switch = SwitchUse {
            cycles,
            closed,
            openings: 0,
        };
        if switch.closed != 0 {
            self.charge_driven_ms = Some(self.now_ms);
            let edges = self.machine.take_edges(line.pin).into_iter();
            switch.openings = edges.filter(|(_, level)| *level != line.active).count() as u32;
        }
        if self.charge_switch_shorted {
            switch = SwitchUse {
                cycles,
                closed: cycles,
                openings: 0,
            };
        }
        let supply = self.supply();
        if switch.closed != 0 || self.circuit.charge.is_flowing() || supply == Feed::Full {
            let pack_v = f64::from(self.circuit.sensors.battery_voltage.0) / 1000.0;
            self.circuit.charge.pass(switch, supply, pack_v);
        }
    }

    fn supply(&self) -> Feed {
        if !self.contacts.is_on(Contact::Adapter) {
            Feed::Absent
        // A dock whose supply is shorted into the pack gives what it can, asked or not.
        } else if self.charge_switch_shorted || self.ear.is_content(self.machine.cycle()) {
            Feed::Full
        } else {
            Feed::Limited(self.model.battery.trickle_a)
        }
    }

    /// Feeds the dock's ear with what the front emitter does.
    fn look_at_emitter(&mut self, end: u64) {
        let emit = self.wiring.emit;
        let mut light = self.machine.take_edges(emit.pin).into_iter().peekable();
        let mut selects: Vec<(u64, usize, Level)> = Vec::new();
        for (bit, line) in self.wiring.sensor_select.iter().enumerate() {
            let edges = self.machine.take_edges(line.pin).into_iter();
            selects.extend(edges.map(|(cycle, level)| (cycle, bit, level)));
        }
        selects.sort_unstable_by_key(|(cycle, ..)| *cycle);
        for (cycle, _, _) in &selects {
            while let Some((at, level)) = light.next_if(|(at, _)| at < cycle) {
                self.show_dock(at, level);
            }
            // The lines settle one after the other; which channel it is matters only once they have.
            self.emitter_selected = false;
        }
        if !selects.is_empty() {
            let machine = &self.machine;
            let channel = selected(&self.wiring.sensor_select, |pin| machine.output(pin));
            self.emitter_selected = channel == FRONT;
        }
        for (at, level) in light {
            self.show_dock(at, level);
        }
        self.ear.advance(end);
    }

    fn show_dock(&mut self, cycle: u64, level: Level) {
        if self.emitter_selected && self.contacts.is_on(Contact::Adapter) {
            let lit = level == self.wiring.emit.active;
            self.ear.edge(cycle, Level::of(lit));
        }
    }

    fn hear_robot(&mut self, end: u64, to_host: &mut Vec<u8>) {
        let edges = self.machine.take_edges(self.wiring.link_transmit.pin);
        for (_, received) in self.to_host.take(&edges, end) {
            if let ReceivedByte::Byte(byte) = received {
                self.monitor.said(self.now_ms, *byte);
                self.digest.byte(*byte);
            }
        }
        self.to_host.give_out(end, to_host);
    }

    /// What the outputs do to the home in the next millisecond.
    fn actuate(&mut self, end: u64) {
        let machine = &self.machine;
        let emitters = self.wiring.cliff_emitters;
        self.actuation = Actuation {
            wheel_left: self.motors.bridge(MotorOutput::WheelLeft, machine),
            wheel_right: self.motors.bridge(MotorOutput::WheelRight, machine),
            brush_main: self.motors.duty(MotorOutput::BrushMain, machine),
            brush_sides: self.motors.duty(MotorOutput::BrushSides, machine) != 0.0,
            vacuum: self.motors.duty(MotorOutput::Vacuum, machine) != 0.0,
            // The circuit knows whether they are lit at the moment of a sample; the home provides both levels.
            cliff_emitter: true,
            dock_signal: self.ear.is_content(end),
            charge_a: self.actuation.charge_a,
        };
        if self.now_ms.is_multiple_of(ENVELOPE_MS) {
            self.actuation.charge_a = Some(self.circuit.charge.take_mean_a());
        }
        if self.circuit.emitters_lit(machine.output(emitters.pin)) {
            self.cliff_settled_ms = self.cliff_settled_ms.saturating_add(1);
        } else {
            self.cliff_settled_ms = 0;
        }
    }

    /// What stood at the pins at the beginning of the millisecond, for the judge.
    fn pins(&mut self) -> Pins {
        let sensors = &self.circuit.sensors;
        if self.cliff_settled_ms > CLIFF_SETTLE_MS {
            let [left, middle, right, _] = sensors.cliff_levels.map(|level| level < NO_FLOOR_LEVEL);
            self.cliffs_seen = [left, middle, right];
        }
        let on = |contact| self.contacts.was_on(contact);
        let truth = self.world.truth();
        Pins {
            bumper: on(Contact::BumperLeft) || on(Contact::BumperRight),
            cliff: self.cliffs_seen.contains(&true),
            wheel_drop: on(Contact::WheelDropLeft) || on(Contact::WheelDropRight),
            docked: on(Contact::Adapter),
            button: on(Contact::AnyButton),
            counts: [sensors.count_left, sensors.count_right],
            rims_mm_per_s: [truth.rim_left_m_per_s, truth.rim_right_m_per_s].map(|rim| (rim * 1e3) as i32),
            speed_mm_per_s: (truth.speed_m_per_s * 1e3) as i32,
            fallen: truth.fallen,
            charging: self.charging(),
            sides: Some(Sides {
                bumpers: [on(Contact::BumperLeft), on(Contact::BumperRight)],
                cliffs: self.cliffs_seen,
                wheel_drops: [on(Contact::WheelDropLeft), on(Contact::WheelDropRight)],
                buttons: sensors.buttons,
            }),
            sensed: self.sensed(),
            loads: Some(self.loads()),
            hardware: self.broken,
        }
    }

    /// Readings to which reports can be compared: an input that the caller holds shows no sensor.
    fn sensed(&self) -> Sensed {
        let sensors = &self.circuit.sensors;
        let is_free = |channel| self.circuit.held(channel, self.cycle()).is_none();
        let currents_ma = [sensors.wheel_left_current.0, sensors.wheel_right_current.0];
        let are_free = self.wiring.wheels.iter().all(|wheel| is_free(wheel.current));
        Sensed {
            pack_mv: is_free(self.wiring.battery_volts).then_some(sensors.battery_voltage.0),
            temperature_dc: is_free(self.wiring.thermistor)
                .then_some(i32::from(sensors.battery_temperature.0)),
            currents_ma: are_free.then_some(currents_ma),
            proximity: is_free(self.wiring.receive).then_some(sensors.proximity),
        }
    }

    fn loads(&self) -> [WheelLoad; 2] {
        let motor = &self.world.model().wheel_motor;
        self.world.wheel_currents_a().map(|current_a| WheelLoad {
            current_ma: (current_a * 1e3) as i32,
            held_ma: ((motor.idle_current_a + motor.stall_current_a) * 1e3) as i32,
        })
    }

    fn charging(&self) -> Charging {
        let truth = self.world.truth();
        Charging {
            driven: self
                .charge_driven_ms
                .is_some_and(|last_ms| self.now_ms - last_ms <= ENVELOPE_MS),
            supplied: self.contacts.was_on(Contact::Adapter),
            current_ma: (truth.battery_a * 1e3) as i32,
            pack_mv: (truth.battery_v * 1e3) as i32,
            temperature_dc: (truth.battery_c * 10.0) as i32,
        }
    }

    /// A chip that restarted forgets; the judge must know.
    fn notice_resets(&mut self) {
        for source in self.machine.take_resets() {
            self.resets += 1;
            self.broken.clock_fails = false;
            self.broken.pulses_damaged = false;
            self.motors.reset();
            self.monitor.reset(self.now_ms, handles::cause_of(source));
            self.ticks_before = Some(self.ticks());
        }
        if self.ticks_before.is_some_and(|before| self.ticks() > before) {
            self.ticks_before = None;
            self.monitor.clock_started(self.now_ms - 1);
        }
    }

    /// Times that the core timer's handler was entered: the firmware's millisecond clock.
    fn ticks(&self) -> u64 {
        let account = self.machine.accounting().vector(CORE_TIMER);
        account.map_or(0, |account| account.entries)
    }

    fn driven(&self) -> Drives {
        let millionths = |motor| (self.motors.duty(motor, &self.machine) * 1e6) as i32;
        Drives {
            wheels: [MotorOutput::WheelLeft, MotorOutput::WheelRight].map(millionths),
            cleaners: [
                MotorOutput::BrushMain,
                MotorOutput::BrushSides,
                MotorOutput::Vacuum,
            ]
            .map(millionths),
        }
    }
}
