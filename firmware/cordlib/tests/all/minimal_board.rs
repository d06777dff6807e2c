//! The least a board author has to write: five parts, everything else absent.

use cordlib::board::{
    Absent, Board, Clock, Link, Parts, Received, ResetRecord, Watchdog, WheelDrive, WheelMotors,
};
use cordlib::{Cord, Parameters};
use rvac_protocol::message::{Limits, ResetCause};
use rvac_units::{AngularSpeed, Length, Speed, Tick};

struct Timer(u32);

impl Clock for Timer {
    fn tick(&mut self) -> Tick {
        Tick(self.0)
    }
}

struct Silence;

impl Link for Silence {
    fn receive(&mut self) -> Option<Received> {
        None
    }

    fn transmit(&mut self, bytes: &[u8]) -> usize {
        bytes.len()
    }
}

#[derive(Default)]
struct Bridges(Option<(WheelDrive, WheelDrive)>);

impl WheelMotors for Bridges {
    fn drive(&mut self, left: WheelDrive, right: WheelDrive) {
        self.0 = Some((left, right));
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

#[derive(Default)]
struct Feedings(u32);

impl Watchdog for Feedings {
    fn feed(&mut self) {
        self.0 += 1;
    }
}

struct Minimal;

impl Parts for Minimal {
    type Clock = Timer;
    type Link = Silence;
    type Wheels = Bridges;
    type Reset = FirstStart;
    type Watchdog = Feedings;
    type Kept = Absent;
    type Checks = Absent;
    type Encoders = Absent;
    type Bumpers = Absent;
    type Cliffs = Absent;
    type WheelDrops = Absent;
    type Proximity = Absent;
    type Gyro = Absent;
    type Currents = Absent;
    type BrushMain = Absent;
    type BrushSides = Absent;
    type Vacuum = Absent;
    type Charger = Absent;
    type DockContacts = Absent;
    type DockBeams = Absent;
    type DustBox = Absent;
    type Beeper = Absent;
    type Lights = Absent;
    type Buttons = Absent;
    type Probe = Absent;
}

const LIMITS: Limits = Limits {
    speed_max: Speed(350_000),
    turn_max: AngularSpeed(1_500_000),
    track: Length(230_000),
    count_nm: 400_000,
    radius: Length(175_000),
    swath: Length(300_000),
};

fn minimal() -> Board<Minimal> {
    Board {
        clock: Timer(0),
        link: Silence,
        wheels: Bridges::default(),
        reset: FirstStart,
        watchdog: Feedings::default(),
        kept: Absent,
        checks: Absent,
        encoders: Absent,
        bumpers: Absent,
        cliffs: Absent,
        wheel_drops: Absent,
        proximity: Absent,
        gyro: Absent,
        currents: Absent,
        brush_main: Absent,
        brush_sides: Absent,
        vacuum: Absent,
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

#[test]
fn a_board_of_five_parts_runs_and_brakes_from_the_start() {
    let mut cord = Cord::new(minimal(), Parameters::for_machine("minimal", "0.1.0", LIMITS));
    assert_eq!(
        cord.board().wheels.0,
        Some((WheelDrive::Brake, WheelDrive::Brake))
    );
    for tick in 0..1_000 {
        cord.board_mut().clock.0 = tick;
        cord.step();
    }
    assert_eq!(
        cord.board().wheels.0,
        Some((WheelDrive::Brake, WheelDrive::Brake))
    );
    assert!(!cord.is_armed());
    assert_eq!(Board::<Minimal>::capabilities().bumpers, 0);
}
