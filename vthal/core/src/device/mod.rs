//! The device model: one shape for robots of every make. Planner and clients see [`Description`], [`DeviceCommand`],
//! [`DeviceEvent`] and [`CommandError`], never the words of a wire.
//!
//! A make of robot is one folder that implements [`Device`], as `cordlib/` does for robots that run our own firmware: it
//! turns commands into its own bytes and its own reports into events. What must hold for every make lives above the
//! makes, in [`Supervisor`]: a drive command that is not renewed ends, an emergency stop latches, and a robot without
//! reflexes gets them from the host.

mod command;
pub mod cordlib;
mod dead_man;
mod description;
mod event;
mod latches;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod link_judge;
mod make;
mod reflex;
mod report;
mod shape;
mod supervisor;
mod wheel_watch;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod wrapping_total;

pub use command::{
    CleanerDrive, CleanerPower, CommandError, DeviceCommand, LeaveDock, Light, LightPattern, Tone,
};
pub use description::{
    DeadManKind, Description, DriveLimits, Identity, Level, Odometry, Part, ReflexSite, Reflexes,
    SensorCounts, StopSite,
};
pub use event::{DeviceEvent, Greeting};
pub(crate) use link_judge::LinkNews;
pub use make::{Device, DeviceIo, Drive, Make, Opening};
pub use report::{
    Arrivals, Battery, ChargeState, Charger, CleanersRunning, DOCK_RECEIVERS_MAX, LinkQuality, Report,
    SlowFacts, WheelDrops, WheelSpeeds, WheelTravel,
};
pub use shape::Shape;
pub use supervisor::Supervisor;

pub(crate) use wrapping_total::WrappingTotal;
