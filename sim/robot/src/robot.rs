//! A robot whose firmware runs in a simulated home.

use cordlib::Cord;
use cordlib::board::{ChargeDrive, CliffLevels, DockRequest, Emitters, Received, WheelCounts, WheelDrive};
use home::{Actuation, Bridge, Fnv1a, RobotModel, Sensors, World};
use monitor::{Bridges, Charging, Drives, HardwareTruth, Monitor, Pins, Sensed, Sides, WheelLoad};
use rvac_channel::{FaultRates, ReceivedByte};
use rvac_protocol::message::{Bumpers, Currents, Gyro, Inhibits, ResetCause, WheelDrops};
use rvac_units::{Throttle, Tick};

use crate::board::{
    self, KeptRam, OneLine, Outfit, PersistentMemory, SimulatedParts, Sr8730Outfit, WATCHDOG_MS,
};
use crate::line::SerialLine;
use crate::parameters::parameters_for;
use crate::power::{self, ChargeSwitch};
use crate::sensor_errors::SensorErrors;

/// How a simulated robot is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotSettings {
    /// Speed of the serial line in bits per second.
    pub baud: u32,
    /// Seed of the line's damage.
    pub seed: u64,
    /// What the bridges are like.
    pub bridges: Bridges,
    /// Its sensors show what those of the robot with this number show; `None` = the truth, as far as the home's noise lets them.
    pub miscalibration: Option<u64>,
}

impl Default for RobotSettings {
    fn default() -> Self {
        Self {
            baud: 230_400,
            seed: 1,
            bridges: Bridges::Sound,
            miscalibration: None,
        }
    }
}

/// cordlib on a simulated board in a simulated home, with a paced serial line and the safety monitor.
#[derive(Debug)]
pub struct SimulatedRobot<O: Outfit = Sr8730Outfit> {
    cord: Cord<SimulatedParts<O>>,
    one_line: OneLine,
    model: RobotModel,
    world: World,
    to_robot: SerialLine,
    to_host: SerialLine,
    monitor: Monitor,
    bridges: Bridges,
    errors: SensorErrors,
    driven: [WheelDrive; 2],
    charge_switch: ChargeSwitch,
    /// Current that the switch lets through, ampere.
    charge_a: f64,
    now_ms: u64,
    reset_ms: u64,
    resets: u32,
    cliff_settled_ms: u32,
    /// Receivers that saw no floor when they were lit last, from the left.
    cliffs_seen: [bool; 3],
    digest: Fnv1a,
}

/// Time after a change of the emitters in which levels are not valid.
const CLIFF_SETTLE_MS: u32 = 3;
/// A lit receiver below this has no floor before it, out of 255: floors give about 180, drops about 10.
const NO_FLOOR_LEVEL: u8 = 20;

impl<O: Outfit> SimulatedRobot<O> {
    /// Switches the robot on at its place in `world`. `model` is what its firmware believes; the world has its own.
    #[must_use]
    pub fn new(model: &RobotModel, world: World, settings: &RobotSettings) -> Self {
        Self {
            cord: Cord::new(
                board::fresh(PersistentMemory::first(), KeptRam::default()),
                parameters_for(O::NAME, model),
            ),
            one_line: OneLine::default(),
            model: model.clone(),
            world,
            to_robot: SerialLine::new(settings.baud, settings.seed),
            to_host: SerialLine::new(settings.baud, settings.seed.wrapping_add(1)),
            monitor: Monitor::new(),
            bridges: settings.bridges,
            errors: settings
                .miscalibration
                .map(SensorErrors::drawn)
                .unwrap_or_default(),
            driven: [WheelDrive::Brake; 2],
            charge_switch: ChargeSwitch::Sound,
            charge_a: 0.0,
            now_ms: 0,
            reset_ms: 0,
            resets: 0,
            cliff_settled_ms: 0,
            cliffs_seen: [false; 3],
            digest: Fnv1a::default(),
        }
    }

    /// Hands bytes to the host's serial driver and returns how many it took.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        self.to_robot.send(bytes)
    }

    /// Advances one millisecond: the home, then the bytes on the line, then one pass of the firmware's loop, then the
    /// monitor. Bytes that reach the host's receiver are appended to `to_host`.
    pub fn tick(&mut self, to_host: &mut Vec<u8>) {
        self.now_ms += 1;
        self.charge_a = power::charge_a(self.charge_switch, &self.cord.board().charger, &self.world);
        self.world.step(&self.actuation());
        self.read_pins();
        self.receive();
        self.cord.step();
        self.drive_bridges();
        self.transmit(to_host);
        let (pins, drives) = (self.pins(), self.drives());
        self.monitor.judge(self.now_ms, &pins, &drives);
        self.watch();
        if self.now_ms.is_multiple_of(100) {
            let pose = self.world.truth().pose;
            for part in [pose.x_m, pose.y_m, pose.heading_rad] {
                self.digest.word(part.to_bits());
            }
        }
    }

    fn actuation(&self) -> Actuation {
        let board = self.cord.board();
        Actuation {
            wheel_left: bridge(self.driven[0]),
            wheel_right: bridge(self.driven[1]),
            brush_main: board.brush_main.duty.as_f64(),
            brush_sides: board.brush_sides.duty != Throttle::ZERO,
            vacuum: board.vacuum.duty != Throttle::ZERO,
            cliff_emitter: board.cliffs.emitters == Emitters::On,
            dock_signal: board.charger.request == DockRequest::Current,
            charge_a: Some(self.charge_a),
        }
    }

    fn read_pins(&mut self) {
        let sensors = self.world.sensors();
        let errors = &self.errors;
        let board = self.cord.board_mut();
        board.clock.tick = Tick((self.now_ms - self.reset_ms) as u32);
        let edges = [sensors.count_left, sensors.count_right];
        board.encoders.counts = if self.model.drive.encoder_lines >= 2 {
            WheelCounts {
                left: sensors.count_left,
                right: sensors.count_right,
            }
        } else {
            self.one_line.take(edges, self.driven)
        };
        board.bumpers.pressed = Bumpers {
            left: sensors.bumper_left,
            right: sensors.bumper_right,
        };
        board.cliffs.levels = errors.cliffs(cliff_levels(sensors, self.model.cliffs.len()));
        board.wheel_drops.hanging = WheelDrops {
            left: sensors.wheel_drop_left,
            right: sensors.wheel_drop_right,
        };
        board.proximity.closeness = errors.proximity(sensors.proximity);
        board.gyro.gyro = sensors.gyro.map(|gyro| Gyro {
            heading: gyro.heading,
            rate: gyro.rate,
        });
        board.currents.currents = Some(errors.currents(Currents {
            wheel_left: sensors.wheel_left_current,
            wheel_right: sensors.wheel_right_current,
            brush_main: sensors.brush_main_current,
        }));
        board.charger.readings = Some(errors.pack(power::readings(self.charge_a, &self.world)));
        board.dock_contacts.closed = sensors.dock_contacts;
        board.dock_beams.symbols = sensors.dock_receivers;
        board.dust_box.inserted = sensors.dust_box;
        board.buttons.down = sensors.buttons;
    }

    fn receive(&mut self) {
        let link = &mut self.cord.board_mut().link;
        for frame in self.to_robot.pass_ms() {
            let (heard, frame) = match *frame {
                ReceivedByte::Byte(byte) => (Some(byte), Received::Byte(byte)),
                ReceivedByte::FramingError => (None, Received::FramingError),
                ReceivedByte::Overrun => (None, Received::Overrun),
            };
            self.monitor.heard(self.now_ms, heard);
            self.digest.byte(heard.unwrap_or_default());
            link.arrive(frame);
        }
    }

    fn drive_bridges(&mut self) {
        let wheels = self.cord.board().wheels;
        for (driven, wanted) in self.driven.iter_mut().zip([wheels.left, wheels.right]) {
            if self.bridges == Bridges::Sound || wanted != WheelDrive::Brake {
                *driven = wanted;
            }
        }
    }

    fn transmit(&mut self, to_host: &mut Vec<u8>) {
        let link = &mut self.cord.board_mut().link;
        for byte in link.said() {
            self.monitor.said(self.now_ms, byte);
            self.digest.byte(byte);
        }
        while self.to_host.room() > 0 {
            let Some(byte) = link.depart() else { break };
            self.to_host.send(&[byte]);
        }
        for frame in self.to_host.pass_ms() {
            // A serial driver hands over a byte with a wrong stop bit as NUL, and drops what overran.
            match *frame {
                ReceivedByte::Byte(byte) => to_host.push(byte),
                ReceivedByte::FramingError => to_host.push(0),
                ReceivedByte::Overrun => {}
            }
        }
    }

    fn pins(&mut self) -> Pins {
        self.look_for_cliffs();
        let counts = self.cord.board().encoders.counts;
        let sensors = self.world.sensors();
        let truth = self.world.truth();
        Pins {
            bumper: sensors.bumper_left || sensors.bumper_right,
            cliff: self.cliffs_seen.contains(&true),
            wheel_drop: sensors.wheel_drop_left || sensors.wheel_drop_right,
            docked: sensors.dock_contacts,
            button: sensors.buttons != 0,
            counts: [counts.left, counts.right],
            rims_mm_per_s: [truth.rim_left_m_per_s, truth.rim_right_m_per_s].map(|rim| (rim * 1e3) as i32),
            speed_mm_per_s: (truth.speed_m_per_s * 1e3) as i32,
            fallen: truth.fallen,
            charging: self.charging(),
            sides: Some(Sides {
                bumpers: [sensors.bumper_left, sensors.bumper_right],
                cliffs: self.cliffs_seen,
                wheel_drops: [sensors.wheel_drop_left, sensors.wheel_drop_right],
                buttons: sensors.buttons,
            }),
            sensed: Sensed {
                pack_mv: Some(sensors.battery_voltage.0),
                temperature_dc: Some(i32::from(sensors.battery_temperature.0)),
                currents_ma: Some([sensors.wheel_left_current.0, sensors.wheel_right_current.0]),
                proximity: Some(sensors.proximity),
            },
            loads: Some(self.loads()),
            hardware: HardwareTruth::default(),
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
            driven: self.cord.board().charger.drive != ChargeDrive::Off,
            supplied: self.world.sensors().dock_contacts,
            current_ma: (truth.battery_a * 1e3) as i32,
            pack_mv: (truth.battery_v * 1e3) as i32,
            temperature_dc: (truth.battery_c * 10.0) as i32,
        }
    }

    fn look_for_cliffs(&mut self) {
        if self.cord.board().cliffs.emitters == Emitters::Off {
            self.cliff_settled_ms = 0;
            return;
        }
        self.cliff_settled_ms = self.cliff_settled_ms.saturating_add(1);
        if self.cliff_settled_ms > CLIFF_SETTLE_MS {
            let dark = self
                .world
                .sensors()
                .cliff_levels
                .map(|level| level < NO_FLOOR_LEVEL);
            self.cliffs_seen = match (self.model.cliffs.len(), dark) {
                (4.., [left, inner_left, inner_right, right]) => [left, inner_left || inner_right, right],
                (fitted, [left, middle, right, _]) => {
                    [left && fitted > 0, middle && fitted > 1, right && fitted > 2]
                }
            };
        }
    }

    fn drives(&self) -> Drives {
        let board = self.cord.board();
        Drives {
            wheels: self.driven.map(|drive| drive.duty().millionths()),
            cleaners: [board.brush_main, board.brush_sides, board.vacuum]
                .map(|cleaner| cleaner.duty.millionths()),
        }
    }

    fn watch(&mut self) {
        let watchdog = &mut self.cord.board_mut().watchdog;
        watchdog.unfed_ms += 1;
        if watchdog.unfed_ms > WATCHDOG_MS {
            self.reset(ResetCause::Watchdog);
        }
    }

    /// Resets the microcontroller: all bytes in its queues and all memory of the firmware are lost, but for what is kept
    /// over a reset; all outputs are off.
    pub fn reset(&mut self, cause: ResetCause) {
        let before = self.cord.board();
        let (persistent, kept) = (before.reset.restarted(cause), before.kept.restarted(cause));
        self.cord = Cord::new(board::fresh(persistent, kept), *self.cord.parameters());
        self.driven = [WheelDrive::Brake; 2];
        self.one_line = OneLine::default();
        self.reset_ms = self.now_ms;
        self.resets += 1;
        self.monitor.reset(self.now_ms, cause);
        self.read_pins();
    }

    /// Inhibits as the firmware reports them.
    #[must_use]
    pub fn inhibits(&self) -> Inhibits {
        self.cord.inhibits()
    }

    /// Breaks or repairs the switch of the charger.
    pub const fn set_charge_switch(&mut self, switch: ChargeSwitch) {
        self.charge_switch = switch;
    }

    /// Sets the rates of faults on the line, in both directions.
    pub fn set_line_rates(&mut self, rates: FaultRates) {
        self.to_robot.set_rates(rates);
        self.to_host.set_rates(rates);
    }

    /// Both directions of the line wait for `ms`.
    pub fn hold_line(&mut self, ms: u32) {
        self.to_robot.hold(ms);
        self.to_host.hold(ms);
    }

    /// The cable is out for `ms`.
    pub fn cut_line(&mut self, ms: u32) {
        self.to_robot.cut(ms);
        self.to_host.cut(ms);
    }

    /// Bytes that [`Self::send`] would take now.
    #[must_use]
    pub fn line_room(&self) -> usize {
        self.to_robot.room()
    }

    /// The host died: the bytes in its driver are lost.
    pub fn host_died(&mut self) {
        self.to_robot.flush();
    }

    /// The home around the robot.
    #[must_use]
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The home around the robot, to lift it, press buttons and break sensors.
    pub const fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }

    /// The monitor.
    #[must_use]
    pub const fn monitor(&self) -> &Monitor {
        &self.monitor
    }

    /// Simulated milliseconds.
    #[must_use]
    pub const fn now_ms(&self) -> u64 {
        self.now_ms
    }

    /// Resets since the robot was switched on.
    #[must_use]
    pub const fn resets(&self) -> u32 {
        self.resets
    }

    /// Whether a wheel is driven now.
    #[must_use]
    pub fn wheels_driven(&self) -> bool {
        self.driven.iter().any(|drive| drive.duty() != Throttle::ZERO)
    }

    /// A hash of everything that happened: every byte on the wire and the true pose ten times a second.
    #[must_use]
    pub fn state_hash(&self) -> u64 {
        self.digest.value()
    }
}

fn bridge(drive: WheelDrive) -> Bridge {
    Bridge {
        pwm: drive.duty().as_f64(),
        brake: true,
    }
}

/// Eight bits of the home to the ten bits of the board's converter. Of a board with four sensors the two
/// inner ones are the middle, and the darker of them counts.
fn cliff_levels(sensors: &Sensors, fitted: usize) -> CliffLevels {
    let [first, second, third, fourth] = sensors.cliff_levels.map(|level| u16::from(level) * 4);
    if fitted < 4 {
        CliffLevels {
            left: first,
            middle: second,
            right: third,
        }
    } else {
        CliffLevels {
            left: first,
            middle: second.min(third),
            right: fourth,
        }
    }
}
