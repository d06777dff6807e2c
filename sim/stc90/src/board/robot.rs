//! The robot: chip, board and home together.

use super::encoder::LineEncoder;
use super::held::{Held, HeldLine};
use super::line::{HostRate, Line};
use super::motors::{Motor, Motors};
use super::{BoardError, CYCLES_PER_MS, Wiring};
use crate::image::Image;
use crate::machine::{Machine, Options};
use crate::peripheral::{ResetSource, Source};
use crate::pins::{Level, Levels, SwitchedInputs};
use home::{Actuation, Bridge, Fnv1a, RobotModel, World};
use monitor::{Drives, Monitor, Pins};
use rvac_channel::FaultRates;
use rvac_protocol::message::ResetCause;

/// A floor sensor switches in the middle between a floor, about 180 of 255, and nothing, about 10.
const FLOOR_LEVEL: u8 = 95;
/// The home says near or far as all or nothing.
const NEAR_LEVEL: u8 = 128;
/// Half a hundredth of a millisecond: wheels that differ by less turn on the spot.
const PULSE_SLACK_MILLIONTHS: i32 = 5_000;
/// Milliseconds between two poses in the digest.
const DIGEST_MS: u64 = 100;
/// Timers whose interrupt can be a firmware's clock.
const CLOCKS: [Source; 3] = [Source::Timer0, Source::Timer1, Source::Timer2];

/// How an emulated robot is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RelaxSettings {
    /// Speed of the host's UART.
    pub rate: HostRate,
    /// Seed of the line's damage.
    pub seed: u64,
}

impl Default for RelaxSettings {
    fn default() -> Self {
        Self {
            rate: HostRate { baud: 38_400 },
            seed: 1,
        }
    }
}

/// Everything of a robot that does not change from run to run: its program and its board.
#[derive(Clone, Debug)]
pub struct RelaxBlueprint {
    image: Image,
    wiring: Wiring,
}

impl RelaxBlueprint {
    /// The board of the Relax with this program.
    ///
    /// # Errors
    /// When the project's own description of the board is wrong.
    pub fn new(image: Image) -> Result<Self, BoardError> {
        Ok(Self {
            image,
            wiring: Wiring::relax()?,
        })
    }
}

/// The emulated chip on its board in a simulated home, with a serial line and the safety monitor. One tick is 1 ms of the
/// home and 5,000 cycles of the chip.
#[derive(Clone, Debug)]
pub struct EmulatedRelax {
    machine: Machine,
    wiring: Wiring,
    world: World,
    encoders: [LineEncoder; 2],
    motors: Motors,
    line: Line,
    monitor: Monitor,
    digest: Fnv1a,
    actuation: Actuation,
    held: Vec<Held>,
    /// Calls of the timers' handlers at the last reset, until the first one after it.
    clock_before: Option<u64>,
    now_ms: u64,
    resets: u32,
}

impl EmulatedRelax {
    /// Switches the robot on where `world` has put it.
    #[must_use]
    pub fn new(blueprint: &RelaxBlueprint, world: World, settings: &RelaxSettings) -> Self {
        let wiring = blueprint.wiring.clone();
        let mut machine = Machine::new(&blueprint.image, Options::RELAX);
        Self {
            motors: Motors::new(&wiring, &mut machine),
            encoders: wiring.wheels.map(|wheel| LineEncoder::new(wheel.encoder)),
            line: Line::new(settings.rate, settings.seed),
            monitor: Monitor::new(),
            digest: Fnv1a::default(),
            actuation: Actuation {
                cliff_emitter: true,
                ..Actuation::default()
            },
            held: Vec::new(),
            clock_before: Some(0),
            now_ms: 0,
            resets: 0,
            machine,
            wiring,
            world,
        }
    }

    /// Advances one millisecond: the home, then what it does to the pins, then the chip, then what the chip did. What
    /// reaches the host's receiver is appended to `to_host`.
    pub fn tick(&mut self, to_host: &mut Vec<u8>) {
        let from = self.now_ms * CYCLES_PER_MS;
        self.now_ms += 1;
        let end = from + CYCLES_PER_MS;
        self.world.step(&self.actuation);
        self.drive_inputs(from);
        for byte in self.line.pass_ms(from, &mut self.machine) {
            self.monitor.heard(self.now_ms, byte);
            self.digest.byte(byte.unwrap_or_default());
        }
        let pins = self.pins();
        self.run_to_holds((from, end));
        self.machine.run_until(end);
        let edges = self.machine.take_edges();
        self.motors.take(&edges, end);
        self.hear_robot(end, to_host);
        self.actuate();
        self.notice_resets();
        let drives = self.drives();
        self.monitor.judge(self.now_ms, &pins, &drives);
        self.digest_pose();
    }

    /// The home moves wheels, switches and shadows.
    fn drive_inputs(&mut self, from: u64) {
        let sensors = *self.world.sensors();
        let wiring = &self.wiring;
        let mut still = Levels::HIGH;
        let mut put = |line: super::DigitalLine, on| still.set(line.pin, line.level(on));
        put(
            wiring.wheel_drop,
            sensors.wheel_drop_left || sensors.wheel_drop_right,
        );
        put(wiring.battery_ok, true);
        wiring.over_currents.into_iter().for_each(|line| put(line, false));
        for encoder in &self.encoders {
            still.set(encoder.pin(), encoder.level());
        }
        for held in self.held.iter().filter(|held| held.from <= from) {
            if let Some(line) = held.signal.plain_line(&self.wiring) {
                still.set(line.pin, line.level(held.is_on));
            }
        }
        self.machine.set_inputs(still);
        self.machine.switch_inputs(self.lit_inputs(from));
        let mut edges = Vec::new();
        let exact = self.world.encoder_positions();
        let shown = [sensors.count_left, sensors.count_right];
        for (side, encoder) in self.encoders.iter_mut().enumerate() {
            encoder.turn((exact[side], shown[side]), from, &mut edges);
        }
        for edge in edges {
            self.machine.schedule_input(edge);
        }
    }

    /// Lets the chip run up to each line that something takes hold of within this millisecond.
    fn run_to_holds(&mut self, (from, end): (u64, u64)) {
        let begun: Vec<Held> = self
            .held
            .iter()
            .filter(|held| held.from > from && held.from < end)
            .copied()
            .collect();
        for held in begun {
            self.machine.run_until(held.from);
            match held.signal.plain_line(&self.wiring) {
                Some(line) => self.machine.set_input(line.pin, line.level(held.is_on)),
                None => self.machine.switch_inputs(self.lit_inputs(held.from)),
            }
        }
    }

    /// Sensors that see by the light that the chip switches: without it bumpers are pressed and floors are missing.
    fn lit_inputs(&self, at: u64) -> SwitchedInputs {
        let sensors = self.world.sensors();
        let [mut lit, mut dark] = [Levels::HIGH; 2];
        let mut put = |line: super::DigitalLine, is_on: bool, is_on_in_the_dark: bool| {
            lit.set(line.pin, line.level(is_on));
            dark.set(line.pin, line.level(is_on_in_the_dark));
        };
        let [left, right] = self.wiring.bumpers;
        put(left, sensors.bumper_left, true);
        put(right, sensors.bumper_right, true);
        for (line, level) in self.wiring.floors.into_iter().zip(sensors.cliff_levels) {
            put(line, level >= FLOOR_LEVEL, false);
        }
        put(self.wiring.wall, sensors.proximity[0] >= NEAR_LEVEL, false);
        let held = || self.held.iter().filter(|held| held.from <= at);
        for (line, is_on) in held().filter_map(|held| Some((held.signal.lit_line(&self.wiring)?, held.is_on)))
        {
            put(line, is_on, is_on);
        }
        if held().any(|held| held.signal == HeldLine::Lamp && !held.is_on) {
            lit = dark;
        }
        let light = self.wiring.sensor_light;
        let [low, high] = match light.active {
            Level::Low => [lit, dark],
            Level::High => [dark, lit],
        };
        SwitchedInputs {
            by: light.pin,
            low,
            high,
        }
    }

    fn hear_robot(&mut self, end: u64, to_host: &mut Vec<u8>) {
        let sent = self.machine.take_sent();
        for byte in self.line.take(&sent, end).into_iter().flatten() {
            self.monitor.said(self.now_ms, byte);
            self.digest.byte(byte);
        }
        self.line.give_out(end, to_host);
    }

    /// What the outputs do to the home in the next millisecond. What a wheel's driver does with both lines off is not
    /// known; here it brakes, as the simulated Relax that runs cordlib does.
    fn actuate(&mut self) {
        let bridge = |motor| Bridge {
            pwm: self.motors.duty(motor),
            brake: true,
        };
        let sucks = self.motors.duty(Motor::Suction) != 0.0;
        self.actuation = Actuation {
            wheel_left: bridge(Motor::WheelLeft),
            wheel_right: bridge(Motor::WheelRight),
            brush_main: self.motors.duty(Motor::Brush),
            brush_sides: sucks,
            vacuum: sucks,
            // The circuit knows whether they are lit when the chip looks.
            cliff_emitter: true,
            dock_signal: false,
            charge_a: None,
        };
    }

    /// What stood at the pins at the beginning of the millisecond, for the judge.
    fn pins(&self) -> Pins {
        let sensors = self.world.sensors();
        let floors = &sensors.cliff_levels[..self.wiring.floors.len()];
        Pins {
            bumper: sensors.bumper_left || sensors.bumper_right,
            cliff: floors.iter().any(|level| *level < FLOOR_LEVEL),
            wheel_drop: sensors.wheel_drop_left || sensors.wheel_drop_right,
            counts: [sensors.count_left, sensors.count_right],
            fallen: self.world.truth().fallen,
            ..Pins::default()
        }
    }

    fn drives(&self) -> Drives {
        let millionths = |motor| (self.motors.duty(motor) * 1e6) as i32;
        let suction = millionths(Motor::Suction);
        let [left, mut right] = [Motor::WheelLeft, Motor::WheelRight].map(millionths);
        // A program switches one wheel some cycles after the other.
        if (left + right).abs() <= PULSE_SLACK_MILLIONTHS {
            right = -left;
        }
        Drives {
            wheels: [left, right],
            cleaners: [millionths(Motor::Brush), suction, suction],
        }
    }

    /// A chip that restarted forgets; the judge must know.
    fn notice_resets(&mut self) {
        for source in self.machine.take_resets() {
            self.resets += 1;
            self.motors.reset(&self.machine);
            self.monitor.reset(self.now_ms, cause_of(source));
            self.clock_before = Some(self.clock_calls());
        }
        if self
            .clock_before
            .is_some_and(|before| self.clock_calls() > before)
        {
            self.clock_before = None;
            self.monitor.clock_started(self.now_ms - 1);
        }
    }

    fn clock_calls(&self) -> u64 {
        let account = self.machine.account();
        CLOCKS.iter().map(|source| account.of(*source).calls).sum()
    }

    fn digest_pose(&mut self) {
        if self.now_ms.is_multiple_of(DIGEST_MS) {
            let pose = self.world.truth().pose;
            for part in [pose.x_m, pose.y_m, pose.heading_rad] {
                self.digest.word(part.to_bits());
            }
        }
    }
}

/// Interface to the world around it.
impl EmulatedRelax {
    /// Hands bytes to the host's serial driver and returns how many it took.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        self.line.send(bytes)
    }

    /// Bytes that [`Self::send`] would take now.
    #[must_use]
    pub fn line_room(&self) -> usize {
        self.line.room()
    }

    /// Bytes that the host's driver still holds.
    #[must_use]
    pub fn line_waiting(&self) -> usize {
        self.line.waiting()
    }

    /// Sets how often what goes wrong on the line, both ways.
    pub fn set_line_rates(&mut self, rates: FaultRates) {
        self.line.set_rates(rates);
    }

    /// The host died: what its driver still held is gone.
    pub fn host_died(&mut self) {
        self.line.flush();
    }

    /// Both ways of the line wait for `ms`.
    pub fn hold_line(&mut self, ms: u32) {
        self.line.hold_until(self.cycle() + u64::from(ms) * CYCLES_PER_MS);
    }

    /// From this cycle on, which is to come, something holds a line, whatever the home says. Lines are held in the order of
    /// these calls, but a dark lamp is dark.
    pub fn hold(&mut self, signal: HeldLine, is_on: bool, from: u64) {
        self.held.push(Held { signal, is_on, from });
    }

    /// Nothing holds a line any more.
    pub fn let_go(&mut self) {
        self.held.clear();
    }

    /// The cycle up to which a motor's line was on, 0 if it never was.
    #[must_use]
    pub fn on_until(&self, motor: Motor) -> u64 {
        self.motors.on_until(motor)
    }

    /// The cable is out for `ms`.
    pub fn cut_line(&mut self, ms: u32) {
        self.line.cut_until(self.cycle() + u64::from(ms) * CYCLES_PER_MS);
    }

    /// Resets the microcontroller.
    pub fn reset(&mut self, cause: ResetCause) {
        self.machine.reset(source_of(cause));
        self.notice_resets();
    }

    /// Resets since the robot was switched on.
    #[must_use]
    pub const fn resets(&self) -> u32 {
        self.resets
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        self.world.model()
    }

    /// Cycles of the chip since power-on, at the end of the last tick.
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.now_ms * CYCLES_PER_MS
    }

    /// Whether a wheel was driven in the last millisecond.
    #[must_use]
    pub fn wheels_driven(&self) -> bool {
        [Motor::WheelLeft, Motor::WheelRight]
            .into_iter()
            .any(|motor| self.duty(motor) != 0.0)
    }

    /// The home around the robot, to lift it and to break sensors: they act from the next tick on.
    pub const fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The home around the robot.
    #[must_use]
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The chip.
    #[must_use]
    pub const fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The chip, to break it and to look into it.
    pub const fn machine_mut(&mut self) -> &mut Machine {
        &mut self.machine
    }

    /// The judge.
    #[must_use]
    pub const fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Simulated milliseconds.
    #[must_use]
    pub const fn now_ms(&self) -> u64 {
        self.now_ms
    }

    /// Mean drive of a motor in the last millisecond, -1..=1, forward positive.
    #[must_use]
    pub fn duty(&self, motor: Motor) -> f64 {
        self.motors.duty(motor)
    }

    /// For how many cycles both direction lines of a wheel were on together, which may be a short.
    #[must_use]
    pub fn short_cycles(&self) -> u64 {
        self.motors.short_cycles()
    }

    /// A hash of everything that happened: every byte on the wire and the true pose ten times a second.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        self.digest.value()
    }
}

/// The chip distinguishes fewer causes than the wire.
const fn source_of(cause: ResetCause) -> ResetSource {
    match cause {
        ResetCause::PowerOn | ResetCause::BrownOut => ResetSource::PowerOn,
        ResetCause::Watchdog => ResetSource::Watchdog,
        ResetCause::Software => ResetSource::Program,
        ResetCause::External | ResetCause::Unknown => ResetSource::Pin,
    }
}

const fn cause_of(source: ResetSource) -> ResetCause {
    match source {
        ResetSource::PowerOn => ResetCause::PowerOn,
        ResetSource::Pin => ResetCause::External,
        ResetSource::Watchdog => ResetCause::Watchdog,
        ResetSource::Program | ResetSource::BootLoader => ResetCause::Software,
    }
}
