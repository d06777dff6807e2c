//! The Rust cord on a board of plain memory that has what a Relax has.

use crate::bench::{Actuation, Senses, SimulatedCord};
use cordlib::board::{
    Absent, Board, BumperSwitches, CleaningMotor, CliffLevels, CliffSensors, Clock, Emitters, Encoders, Link,
    Parts, Received, ResetRecord, Watchdog, WheelCounts, WheelDrive, WheelDropSwitches, WheelMotors,
};
use cordlib::{Cord, Parameters};
use home::RobotModel;
use rvac_protocol::message::{Bumpers, Cliffs, ResetCause, WheelDrops};
use rvac_units::{Throttle, Tick};
use std::collections::VecDeque;

/// What a receiver shows above a floor that is lit, and else.
const FLOOR: u16 = 600;
const NOTHING: u16 = 40;

struct Time(u32);

impl Clock for Time {
    fn tick(&mut self) -> Tick {
        Tick(self.0)
    }
}

#[derive(Default)]
struct Wire {
    to_robot: VecDeque<u8>,
    to_host: Vec<u8>,
}

impl Link for Wire {
    fn receive(&mut self) -> Option<Received> {
        self.to_robot.pop_front().map(Received::Byte)
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        self.to_host.extend_from_slice(bytes);
        bytes.len()
    }
}

struct Bridges([WheelDrive; 2]);

impl WheelMotors for Bridges {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        self.0 = [left, right];
    }
}

struct FirstStart;

impl ResetRecord for FirstStart {
    fn cause(&mut self) -> ResetCause {
        ResetCause::PowerOn
    }

    fn boot_count(&mut self) -> u32 {
        1
    }

    fn recent(&mut self) -> u8 {
        0
    }

    fn forget_recent(&mut self) {}
}

struct Unwatched;

impl Watchdog for Unwatched {
    fn feed(&mut self) {}
}

#[derive(Default)]
struct Counters(WheelCounts);

impl Encoders for Counters {
    const PRESENT: bool = true;

    fn counts(&mut self) -> WheelCounts {
        self.0
    }
}

#[derive(Default)]
struct Touch(Bumpers);

impl BumperSwitches for Touch {
    const ZONES: u8 = 2;

    fn pressed(&mut self) -> Bumpers {
        self.0
    }
}

struct Floor {
    missing: Cliffs,
    emitters: Emitters,
}

impl CliffSensors for Floor {
    const FITTED: Cliffs = Cliffs {
        left: true,
        middle: true,
        right: true,
    };

    fn set_emitters(&mut self, emitters: Emitters) {
        self.emitters = emitters;
    }

    fn levels(&mut self) -> CliffLevels {
        let level = |is_missing: bool| match self.emitters {
            Emitters::On if !is_missing => FLOOR,
            Emitters::On | Emitters::Off => NOTHING,
        };
        CliffLevels {
            left: level(self.missing.left),
            middle: level(self.missing.middle),
            right: level(self.missing.right),
        }
    }
}

#[derive(Default)]
struct Drops(WheelDrops);

impl WheelDropSwitches for Drops {
    const SWITCHES: u8 = 1;

    fn hanging(&mut self) -> WheelDrops {
        self.0
    }
}

#[derive(Default)]
struct Cleaner(Throttle);

impl CleaningMotor for Cleaner {
    const PRESENT: bool = true;

    fn set(&mut self, duty: Throttle) {
        self.0 = duty;
    }
}

struct Memory;

impl Parts for Memory {
    type Clock = Time;
    type Link = Wire;
    type Wheels = Bridges;
    type Reset = FirstStart;
    type Watchdog = Unwatched;
    type Kept = Absent;
    type Checks = Absent;
    type Encoders = Counters;
    type Bumpers = Touch;
    type Cliffs = Floor;
    type WheelDrops = Drops;
    type Proximity = Absent;
    type Gyro = Absent;
    type Currents = Absent;
    type BrushMain = Cleaner;
    type BrushSides = Cleaner;
    type Vacuum = Cleaner;
    type Charger = Absent;
    type DockContacts = Absent;
    type DockBeams = Absent;
    type DustBox = Absent;
    type Beeper = Absent;
    type Lights = Absent;
    type Buttons = Absent;
    type Probe = Absent;
}

fn board() -> Board<Memory> {
    Board {
        clock: Time(0),
        link: Wire::default(),
        wheels: Bridges([WheelDrive::Brake; 2]),
        reset: FirstStart,
        watchdog: Unwatched,
        kept: Absent,
        checks: Absent,
        encoders: Counters::default(),
        bumpers: Touch::default(),
        cliffs: Floor {
            missing: Cliffs::default(),
            emitters: Emitters::On,
        },
        wheel_drops: Drops::default(),
        proximity: Absent,
        gyro: Absent,
        currents: Absent,
        brush_main: Cleaner::default(),
        brush_sides: Cleaner::default(),
        vacuum: Cleaner::default(),
        charger: Absent,
        dock_contacts: Absent,
        dock_beams: Absent,
        dust_box: Absent,
        beeper: Absent,
        lights: Absent,
        buttons: Absent,
        probe: Absent,
    }
}

/// The cord.
pub(crate) struct RustCord(Cord<Memory>);

impl RustCord {
    pub(crate) fn new() -> Self {
        let model = RobotModel::by_name("relax").expect("it comes with the project");
        let parameters: Parameters = robot::parameters_for("relax", &model);
        Self(Cord::new(board(), parameters))
    }
}

impl SimulatedCord for RustCord {
    fn millisecond(&mut self, senses: &Senses, bytes: &[u8]) -> (Actuation, Vec<u8>) {
        let board = self.0.board_mut();
        board.clock.0 += 1;
        board.link.to_robot.extend(bytes);
        board.encoders.0.left = board.encoders.0.left.wrapping_add(senses.counts[0]);
        board.encoders.0.right = board.encoders.0.right.wrapping_add(senses.counts[1]);
        board.bumpers.0 = Bumpers {
            left: senses.bumpers[0],
            right: senses.bumpers[1],
        };
        board.cliffs.missing.middle = senses.cliff;
        board.wheel_drops.0 = WheelDrops {
            left: senses.hangs,
            right: senses.hangs,
        };
        self.0.step();
        let board = self.0.board_mut();
        let duty = board
            .wheels
            .0
            .map(|drive| f64::from(drive.duty().millionths()) / 1e6);
        let is_on = |cleaner: &Cleaner| cleaner.0 != Throttle::ZERO;
        let actuation = Actuation {
            duty,
            cleaners: [
                is_on(&board.brush_main),
                // One line serves both on a Relax, and is on while both are.
                is_on(&board.brush_sides) && is_on(&board.vacuum),
            ],
        };
        (actuation, std::mem::take(&mut board.link.to_host))
    }
}
