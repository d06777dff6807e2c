//! The desks of the daemon. Each owns its state, takes the time and the facts of others as plain arguments, and informs
//! clients, log and shell through a [`audience::Teller`]. None can reach the state of another. [`crate::Core`] holds them all
//! and routes inputs and requests between them.

pub(crate) mod arbiter;
pub(crate) mod audience;
mod awaited;
pub(crate) mod button_desk;
mod buttons;
pub(crate) mod calibration;
pub(crate) mod checkpoints;
mod client_inputs;
mod clients;
pub(crate) mod command_failures;
pub(crate) mod driver;
pub(crate) mod estimates;
pub(crate) mod evidence;
pub(crate) mod feed;
pub(crate) mod floors;
pub(crate) mod health;
pub(crate) mod history;
pub(crate) mod home;
pub(crate) mod input_desk;
pub(crate) mod jobs;
pub(crate) mod journal;
mod kept_view;
pub(crate) mod learnt;
pub(crate) mod link;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod link_facts;
pub(crate) mod link_loan;
pub(crate) mod readiness;
mod refusal_log;
pub(crate) mod reply;
pub(crate) mod room_power;
mod scheduler;
pub(crate) mod schedules;
pub(crate) mod sources;
pub(crate) mod standstills;
#[cfg_attr(
    not(test),
    warn(clippy::arithmetic_side_effects, reason = "it counts what comes from outside")
)]
mod strange_line;
pub(crate) mod system_zone;
pub(crate) mod words;
