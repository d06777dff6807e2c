//! Change notice: 22 pins that ask for one common interrupt when they change, each with a weak pull-up (section 9).
//!
//! Pins are enabled with [`crate::gpio::Pin::enable_notice`]. The chip compares each with its level at the last reading of its
//! port. So the handler reads every port that has enabled pins ([`crate::gpio::Port::read`]), then calls
//! [`crate::interrupt::Source::clear`], then acts: in this order a change that comes meanwhile asks again.

use crate::register::map::{CNCON, CNEN, CNPUE};

const ON: u32 = 1 << 15;

/// The change-notice unit.
#[derive(Debug)]
pub struct ChangeNotice(());

impl ChangeNotice {
    pub(crate) const fn new() -> Self {
        Self(())
    }

    /// Turns it on. Read the ports of all enabled pins and clear the source before enabling the interrupt.
    pub fn start(&mut self) {
        CNCON.set(ON);
    }

    /// Turns it off. Pull-ups stay.
    pub fn stop(&mut self) {
        CNCON.clear(ON);
    }
}

pub(crate) fn enable(notice: u8) {
    CNEN.set(1 << notice);
}

pub(crate) fn disable(notice: u8) {
    CNEN.clear(1 << notice);
}

pub(crate) fn enable_pull_up(notice: u8) {
    CNPUE.set(1 << notice);
}

pub(crate) fn disable_pull_up(notice: u8) {
    CNPUE.clear(1 << notice);
}
