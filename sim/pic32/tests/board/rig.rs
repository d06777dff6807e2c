//! Homes, robots in them, and what the programs have in common.

use std::sync::Arc;

use home::{Home, Noise, Pose, RobotModel, World};
use pic32::board::{Blueprint, CalibrationChoice, EmulatedRobot, EmulatedSettings};

use crate::program::{Program, store};

pub(crate) const TRISA: u32 = 0xBF88_6000;
pub(crate) const TRISB: u32 = 0xBF88_6040;
pub(crate) const TRISC: u32 = 0xBF88_6080;
pub(crate) const TRISD: u32 = 0xBF88_60C0;
pub(crate) const TRISE: u32 = 0xBF88_6100;
pub(crate) const TRISF: u32 = 0xBF88_6140;
pub(crate) const TRISG: u32 = 0xBF88_6180;
pub(crate) const PORT: u32 = 0x10;
pub(crate) const LAT: u32 = 0x20;
pub(crate) const AD1PCFG: u32 = 0xBF80_9060;
pub(crate) const DDPCON: u32 = 0xBF80_F200;

/// Stores constants at addresses, one after the other.
pub(crate) fn stores(registers: &[(u32, u32)]) -> Vec<u32> {
    registers
        .iter()
        .flat_map(|(address, value)| store(*address, *value))
        .collect()
}

/// A room of 4 m by 3 m with the robot in its middle, or at `start` (x, y, heading in the room).
pub(crate) fn world(start: Option<(f64, f64, f64)>) -> World {
    let model = RobotModel::by_name("sr8730").expect("it comes with the project");
    let text = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n";
    let home = Arc::new(Home::from_floorplan("room", text, &model).expect("a valid home"));
    let (x_m, y_m, heading_rad) = start.unwrap_or((2.0, 1.5, 0.0));
    let pose = home
        .file_from_plan()
        .inverse()
        .then(Pose::new(x_m, y_m, heading_rad));
    World::new(home, &model, &Noise::ideal(), 1, Some(pose))
}

/// A robot in that room that runs this program.
pub(crate) fn robot(code: &[u32]) -> EmulatedRobot {
    robot_with(code, world(None), &EmulatedSettings::default())
}

pub(crate) fn robot_with(code: &[u32], world: World, settings: &EmulatedSettings) -> EmulatedRobot {
    let image = Program::new(code).image().clone();
    let blueprint =
        Blueprint::sr8730(image, &CalibrationChoice::Complete).expect("the project's board is sound");
    EmulatedRobot::new(&blueprint, world, settings)
}

/// Lets the robot run; gives what it said.
pub(crate) fn pass_ms(robot: &mut EmulatedRobot, ms: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    for _ in 0..ms {
        robot.tick(&mut bytes);
    }
    bytes
}
