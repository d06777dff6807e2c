//! Library of the `rvac-sim` binary.
//!
//! A [`Robot`] runs the firmware that is built into this program, or an image in an emulated chip ([`Firmware`]). A
//! [`Household`] is a robot and a host that run against each other in memory, on a virtual clock. [`run`] measures how
//! well such a household cleans, [`faults`] injects random faults under the safety monitor, [`line_faults`] those of the
//! line one by one, [`board_faults`] what fails around the Linux board, [`log_pace`] counts the lines of a log, and [`serve`] puts the
//! robot alone behind a pseudoterminal for a real daemon.
#![forbid(unsafe_code)]

pub mod baseline;
pub mod bench;
pub mod board_faults;
mod carpet_quality;
pub mod daily;
pub mod days;
mod explanation;
pub mod faults;
mod figures;
mod firmware;
mod host;
mod host_cost;
mod host_floors;
mod host_wall;
mod household;
mod known_map;
pub mod line_faults;
mod linux_board;
pub mod log_pace;
mod map_alignment;
mod map_obstacles;
mod map_quality;
pub mod page;
mod plan;
pub mod replay;
mod report;
mod robot;
pub mod run;
mod scene;
mod sensors;
pub mod serve;
pub mod trace;

pub use explanation::explain;
pub use figures::{FieldMeasures, Figures, LostStretch, TimeSpent, field_line};
pub use firmware::{Firmware, FirmwareError};
pub use host::{Host, KeptWrite};
pub use host_cost::{HostCost, thread_processor_s};
pub use household::{Household, PoseSource, TICK_US};
pub use map_obstacles::MapObstacles;
pub use pic32::board::{CalibrationChoice, GyroFitted};
pub use report::{RunReport, StuckWatch};
pub use robot::Robot;
pub use rvac_protocol::message::ResetCause;
pub use scene::{Scene, SceneError, SceneSettings};
pub use sensors::sensor_layout;
