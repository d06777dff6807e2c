//! What one idle pass of the main loop costs on this machine. Run it with `--release`.

use std::time::Instant;

#[path = "../tests/all/rig/parts.rs"]
#[allow(dead_code, unreachable_pub, reason = "the parts serve tests as well")]
mod parts;

use cordlib::board::{Board, Emitters, WheelDrive};
use cordlib::{Cord, Parameters};
use rvac_protocol::message::{Cliffs, Limits};
use rvac_units::{AngularSpeed, Length, Speed};

const PASSES: u32 = 5_000_000;

fn main() {
    let limits = Limits {
        speed_max: Speed(350_000),
        turn_max: AngularSpeed(1_500_000),
        track: Length(230_000),
        count_nm: 500_000,
        radius: Length(175_000),
        swath: Length(300_000),
    };
    let board = Board::<parts::Memory> {
        clock: parts::Time(0),
        link: parts::Wire {
            to_robot: std::collections::VecDeque::new(),
            to_host: Vec::new(),
            room: 1_000,
        },
        wheels: parts::Bridges {
            left: WheelDrive::Brake,
            right: WheelDrive::Brake,
        },
        reset: parts::Record::default(),
        watchdog: parts::Fed::default(),
        encoders: parts::Counters::default(),
        bumpers: parts::Switches::default(),
        cliffs: parts::Floor {
            missing: Cliffs::default(),
            stuck_left: None,
            emitters: Emitters::On,
        },
        wheel_drops: parts::Drops::default(),
        proximity: parts::Sight,
        gyro: parts::Needle::default(),
        currents: parts::Shunts::default(),
        brush_main: parts::Brush::default(),
        brush_sides: parts::Brush::default(),
        vacuum: parts::Brush::default(),
        charger: parts::Pack::default(),
        dock_contacts: parts::Contacts::default(),
        dock_beams: parts::Beams,
        dust_box: parts::DustBoxSwitch,
        beeper: parts::Speaker::default(),
        lights: parts::Lamps::default(),
        buttons: parts::Keys::default(),
        probe: parts::Pins::default(),
    };
    let mut cord = Cord::new(board, Parameters::for_machine("pace", "0", limits));
    let start = Instant::now();
    for tick in 1..=PASSES {
        cord.board_mut().clock.0 = tick;
        cord.step();
        cord.board_mut().link.to_host.clear();
    }
    let each_ns = start.elapsed().as_secs_f64() * 1e9 / f64::from(PASSES);
    println!(
        "idle pass: {each_ns:.1} ns; Cord of this board: {} bytes",
        size_of_val(&cord)
    );
}
