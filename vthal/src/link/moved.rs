//! Where a serial adapter is now: it may come back under another name.

use std::path::{Path, PathBuf};

use robot_link::{LinkAddress, UartAddress};

use crate::serial_identity::{BY_ID, SerialIdentity};

/// The address that is tried next.
#[derive(Debug)]
pub(super) struct Moved {
    configured: LinkAddress,
    now: LinkAddress,
    identity: Option<SerialIdentity>,
}

impl Moved {
    pub(super) fn new(configured: LinkAddress) -> Self {
        Self {
            now: configured.clone(),
            configured,
            identity: None,
        }
    }

    pub(super) fn address(&self) -> &LinkAddress {
        &self.now
    }

    /// It is open there: its own name is remembered.
    pub(super) fn opened(&mut self) {
        // Only serial adapters have such a name.
        let here = self
            .now
            .device()
            .and_then(|path| SerialIdentity::of(path, Path::new(BY_ID)));
        self.identity = here.or(self.identity.take());
    }

    /// It cannot be opened: it is tried where it was configured, or under the name that it has now.
    pub(super) fn look(&mut self) {
        self.now = self.configured.clone();
        let Some(configured) = self.configured.device().filter(|path| !path.exists()) else {
            return;
        };
        let elsewhere = self
            .identity
            .as_ref()
            .and_then(|identity| identity.elsewhere(configured));
        let Some(path) = elsewhere else { return };
        tracing::warn!(
            part = "link",
            "{} is gone, and the same adapter is {} now: it is used there; set link.serial to its name in {BY_ID}, which does not change",
            configured.display(),
            path.display()
        );
        self.now = at(&self.configured, path);
    }
}

/// The same link at another device.
fn at(address: &LinkAddress, path: PathBuf) -> LinkAddress {
    match address {
        LinkAddress::Uart(uart) => LinkAddress::Uart(UartAddress { path, ..uart.clone() }),
        LinkAddress::Usb(_) => LinkAddress::Usb(path),
        other => other.clone(),
    }
}
