//! Control mixes: from sticks, keys and buttons to what a robot does, as radio transmitters do it.
//!
//! Words used here. An *input* is one stick axis, button, key or the like, -1..=1. A *line* takes one input, shapes it (curve,
//! weight, delay, slow) and adds it to an *output*, multiplies the output by it, or replaces it. An output is one thing that
//! the robot can be commanded: a speed, a turn, suction, Start. A *switch* is a condition on inputs that lines may depend on; a
//! *flight mode* holds while one is on. A *trim* is added to the centre of an output by buttons. A
//! *profile* is all of these, as a person saved them. *Rest* is what an input gives when nobody touches it. *Failsafe* is
//! what an output gives when an input was lost. A *pilot* is a mixer at work whose orders leave as requests.
//!
//! Nothing here reads a clock or a device: [`Mixer::step`] is given the time and the [`Readings`] of the moment. The same code
//! runs in the browser, in `rvac drive` and, to check what is saved, in the daemon.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod bump_watch;
mod check;
mod client_inputs;
mod command;
mod defaults;
mod flight_mode;
mod helm;
mod input;
mod left_out;
mod line;
mod line_step;
mod mixer;
mod name;
mod output;
mod pad_watch;
mod pilot;
mod place;
mod profile;
mod readings;
mod remark;
mod shape;
mod stop_buttons;
mod switch;
mod trim;

pub use bump_watch::BumpWatch;
pub use check::{LINES_MAX, MODES_MAX, POINTS_MAX, PROFILE_BYTES_MAX, ProfileError, SWITCHES_MAX};
pub use client_inputs::ClientInputs;
pub use command::{Axes, Cleaning, Press, Wish};
pub use defaults::standard_profile;
pub use flight_mode::FlightMode;
pub use helm::{Helm, Order};
pub use input::{Device, KeyCode, Source, SourceError};
pub use line::{Line, Mix};
pub use line_step::response;
pub use mixer::{AwayFromRest, GAP_MAX_US, LineStages, MixState, Mixed, MixedOutput, Mixer};
pub use name::{Name, NameError};
pub use output::{Output, OutputKind, OutputName};
pub use pad_watch::{PAD_SILENT_US, PadWatch};
pub use pilot::{Pilot, STEP_EVERY_US, Steered, TopSpeeds};
pub use profile::{Calibration, Profile, VERSION};
pub use readings::{PadReading, Readings, first_moved};
pub use remark::{Remark, Remarks};
pub use shape::{curved, with_expo};
pub use switch::{Condition, Switch};
pub use trim::{TRIM_MAX, Trim, TrimValue};
