//! Contacts and beam receivers of the dock.

use rvac_protocol::message::DockReceivers;

/// Charging contacts.
pub trait DockContacts {
    /// Whether the dock's supply is on the contacts (or an adapter is plugged in).
    fn closed(&mut self) -> bool;
}

/// Receivers of the dock's beams.
pub trait DockBeams {
    /// Number of receivers, 0..=4.
    const COUNT: u8;

    /// Last symbol of each receiver, 0 = none recently.
    fn symbols(&mut self) -> DockReceivers;
}
