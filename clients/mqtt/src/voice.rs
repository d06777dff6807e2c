//! What the shell needs of a side that speaks over a broker: updates and messages go in, messages and requests come out.

use std::time::Duration;

use rvac_api::{RequestBody, Update};

use crate::wire::{Incoming, Publish};

/// What the shell shall do.
#[derive(Debug, PartialEq)]
pub(crate) enum Output {
    /// Say a state, in place of an older one that waits.
    State(Publish),
    /// Say an event.
    Event(Publish),
    /// Ask the daemon who its robot is.
    Hello,
    /// Ask the daemon.
    Ask(RequestBody),
}

/// A side that speaks over a broker. It has no clock and does no I/O.
pub(crate) trait Voice {
    /// Ends the name by which the broker knows it.
    const NAME: &'static str;

    /// What the broker says when this client is gone without a word.
    fn will(&self) -> Publish;
    /// All topics that are heard.
    fn heard_topics(&self) -> Vec<String>;
    /// The broker has let us in: everything is said anew.
    fn broker_came(&mut self, now: Duration, out: &mut Vec<Output>);
    /// The broker is gone, and with it what it was told.
    fn broker_went(&mut self);
    /// The daemon is there.
    fn daemon_came(&mut self, out: &mut Vec<Output>);
    /// The daemon is gone.
    fn daemon_went(&mut self, now: Duration, out: &mut Vec<Output>);
    /// The daemon says something.
    fn update(&mut self, update: &Update, now: Duration, out: &mut Vec<Output>);
    /// A message came.
    fn message(&mut self, message: &Incoming, now: Duration, out: &mut Vec<Output>);
    /// A second has passed.
    fn wake(&mut self, now: Duration, out: &mut Vec<Output>);
}
