//! A serial adapter by the name that does not change: `/dev/serial/by-id`.
//!
//! An adapter that is pulled and put back while its old name is still in use becomes `/dev/ttyUSB1`. The folder links the adapter's
//! own name to whatever it is called now.

use std::fs;
use std::path::{Path, PathBuf};

/// Where the system keeps such links.
pub(crate) const BY_ID: &str = "/dev/serial/by-id";

/// The link of an adapter that was open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SerialIdentity {
    link: PathBuf,
}

impl SerialIdentity {
    /// The link that leads to the device at `path`, if there is one.
    pub(crate) fn of(path: &Path, by_id: &Path) -> Option<Self> {
        let device = fs::canonicalize(path).ok()?;
        links(by_id)
            .into_iter()
            .find(|link| fs::canonicalize(link).is_ok_and(|target| target == device))
            .map(|link| Self { link })
    }

    /// What the adapter is called now, if it is there under another name than `path`.
    pub(crate) fn elsewhere(&self, path: &Path) -> Option<PathBuf> {
        let now = fs::canonicalize(&self.link).ok()?;
        (fs::canonicalize(path).ok().as_ref() != Some(&now)).then_some(now)
    }
}

/// The adapters that there are, in the order of their names.
pub(crate) fn links(by_id: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(by_id).into_iter().flatten().flatten();
    let mut links: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    links.sort();
    links
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::SerialIdentity;

    #[test]
    fn an_adapter_is_found_under_its_new_name() {
        let root = std::env::temp_dir().join(format!("rvac-serial-identity-{}", std::process::id()));
        let by_id = root.join("by-id");
        fs::create_dir_all(&by_id).unwrap();
        let (before, after) = (root.join("ttyUSB0"), root.join("ttyUSB1"));
        fs::write(&before, "").unwrap();
        let link = by_id.join("usb-FTDI_1234-port0");
        symlink("../ttyUSB0", &link).unwrap();
        let identity = SerialIdentity::of(&before, &by_id).unwrap();
        assert_eq!(identity.elsewhere(&before), None);
        fs::rename(&before, &after).unwrap();
        fs::remove_file(&link).unwrap();
        assert_eq!(identity.elsewhere(&before), None, "it is away");
        symlink("../ttyUSB1", &link).unwrap();
        assert_eq!(
            identity.elsewhere(&before),
            Some(fs::canonicalize(&after).unwrap())
        );
        assert_eq!(SerialIdentity::of(&root.join("ttyUSB7"), &by_id), None);
        fs::remove_dir_all(&root).unwrap();
    }
}
