//! Where a serial adapter is now: it may come back under another name.

use std::path::PathBuf;

use robot_link::{LinkAddress, UartAddress};

use crate::serial_identity::SerialIdentity;

/// The address that is tried next.
#[derive(Debug)]
pub(super) struct Moved {
    configured: LinkAddress,
    now: LinkAddress,
    /// Where the system keeps the names of adapters that do not change.
    by_id: PathBuf,
    identity: Option<SerialIdentity>,
}

impl Moved {
    pub(super) fn new(configured: LinkAddress, by_id: PathBuf) -> Self {
        Self {
            now: configured.clone(),
            configured,
            by_id,
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
            .and_then(|path| SerialIdentity::of(path, &self.by_id));
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
            "{} is gone, and the same adapter is {} now: it is used there; set link.serial to its name in {}, which does not change",
            configured.display(),
            path.display(),
            self.by_id.display()
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

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use robot_link::LinkAddress;

    use super::Moved;

    #[test]
    fn an_adapter_is_looked_for_under_its_new_name_and_under_the_old_one_when_it_is_back_there() {
        let root = std::env::temp_dir().join(format!("rvac-moved-{}", std::process::id()));
        let by_id = root.join("by-id");
        fs::create_dir_all(&by_id).unwrap();
        let (before, after) = (root.join("ttyUSB0"), root.join("ttyUSB1"));
        fs::write(&before, "").unwrap();
        let link = by_id.join("usb-FTDI_1234-port0");
        symlink(&before, &link).unwrap();
        let configured = LinkAddress::Usb(before.clone());
        let mut moved = Moved::new(configured.clone(), by_id);
        moved.opened();
        fs::rename(&before, &after).unwrap();
        moved.look();
        assert_eq!(moved.address(), &configured, "it is away");
        fs::remove_file(&link).unwrap();
        symlink(&after, &link).unwrap();
        moved.look();
        assert_eq!(
            moved.address(),
            &LinkAddress::Usb(fs::canonicalize(&after).unwrap())
        );
        fs::rename(&after, &before).unwrap();
        moved.look();
        assert_eq!(moved.address(), &configured);
        fs::remove_dir_all(&root).unwrap();
    }
}
