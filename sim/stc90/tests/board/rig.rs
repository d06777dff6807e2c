//! A room, a robot in it, and programs from bytes.

use home::{Home, Noise, Pose, RobotModel, World};
use stc90::board::{EmulatedRelax, RelaxBlueprint, RelaxSettings};
use stc90::image::Image;
use std::sync::Arc;

/// P1.4 and P2.1 low: both wheels forward. P2.7 low: sensor light on.
pub(crate) const AHEAD: [(u8, u8); 2] = [(0x90, 0xEF), (0xA0, 0x7D)];
/// SJMP to itself.
pub(crate) const STAY: [u8; 2] = [0x80, 0xFE];

/// MOV direct, #constant for each pair, then the rest.
pub(crate) fn program(pairs: &[(u8, u8)], rest: &[u8]) -> Vec<u8> {
    let mut code: Vec<u8> = pairs
        .iter()
        .flat_map(|(register, value)| [0x75, *register, *value])
        .collect();
    code.extend(rest);
    code
}

/// A room of 4 m by 3 m with the robot at (x, y) in it, looking along x.
pub(crate) fn world(x_m: f64, y_m: f64) -> World {
    let model = RobotModel::by_name("relax").expect("it comes with the project");
    let text = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n";
    let home = Arc::new(Home::from_floorplan("room", text, &model).expect("a valid home"));
    let pose = home.file_from_plan().inverse().then(Pose::new(x_m, y_m, 0.0));
    World::new(home, &model, &Noise::ideal(), 1, Some(pose))
}

pub(crate) fn robot_with(code: &[u8], world: World, settings: RelaxSettings) -> EmulatedRelax {
    let mut image = Image::erased();
    assert!(image.write(0, code), "the program fits");
    let blueprint = RelaxBlueprint::new(image).expect("the project's board is sound");
    EmulatedRelax::new(&blueprint, world, &settings)
}

/// A robot in the middle of the room.
pub(crate) fn robot(code: &[u8]) -> EmulatedRelax {
    robot_with(code, world(2.0, 1.5), RelaxSettings::default())
}

/// Lets the robot run; gives what it said.
pub(crate) fn pass_ms(robot: &mut EmulatedRelax, ms: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    for _ in 0..ms {
        robot.tick(&mut bytes);
    }
    bytes
}

/// A byte of the chip's internal RAM.
pub(crate) fn ram(robot: &EmulatedRelax, address: u8) -> u8 {
    robot.machine().cpu().ram()[usize::from(address)]
}
