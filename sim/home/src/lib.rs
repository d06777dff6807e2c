//! Simulated homes: floor plans, furniture, dirt, and a robot's physics, sensors, dock and battery in them.
//!
//! A [`RobotModel`] comes from `robots/<name>/robot.toml`, a [`Home`] from a map file, and a [`World`] is one robot in
//! one home. [`World::step`] advances one millisecond: it takes the firmware's outputs ([`Actuation`]) and provides the
//! firmware's inputs ([`Sensors`]) and the ground truth ([`Truth`]). There is no clock, no global state and no
//! randomness except the seed: the same calls give the same bits.
//!
//! [`generate`] draws homes from numbers, [`traps`] the places in which robots get stuck.
//!
//! Not simulated: three dimensions, pushed furniture, sound.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod digest;
pub mod generate;
mod home;
mod linux_board;
mod load;
mod model;
mod noise;
mod pcg;
mod plan;
mod point;
mod pose;
mod thermistor;
pub mod traps;
mod world;

pub use digest::Fnv1a;
pub use home::Home;
pub use linux_board::{Beacons, BoardGyro, LongRanges, Measured};
pub use load::{HomeError, HomeNotice};
pub use model::{
    BatteryModel, BodyModel, BumperModel, Cleaners, CliffMount, Confidence, DriveModel, GyroModel,
    LidarModel, ModelError, ProximityModel, ReceiverMount, RobotModel, WheelMotor, robot_names,
};
pub use noise::{Noise, NoiseError};
pub use pcg::Pcg;
pub use plan::{Cell, Grid};
pub use pose::{Pose, wrap_angle};
pub use thermistor::Thermistor;
pub use world::{
    Actuation, BeamStrengths, Bridge, DOCK_LEFT, DOCK_NEAR, DOCK_RIGHT, DockContacts, GyroReading, LidarScan,
    OddCell, Pack, PackMake, SensorFault, SensorId, Sensors, Supply, Truth, World, WorldSeeds,
};
