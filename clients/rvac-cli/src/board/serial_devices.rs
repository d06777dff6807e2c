//! Serial devices on which a robot may be.

use std::path::PathBuf;

use super::Board;

/// Kinds of devices, by the beginning of their names in `/dev`: pins of boards, then USB adapters.
const KINDS: [&str; 7] = [
    "serial0", "ttyAMA", "ttyS", "ttymxc", "ttySAC", "ttyUSB", "ttyACM",
];

/// A serial device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SerialDevice {
    /// The name to configure: one that stays, where there is one.
    pub(crate) path: PathBuf,
    /// The kernel's name, without `/dev/`.
    pub(crate) kernel_name: String,
}

/// All devices, the likely ones first, each once.
pub(crate) fn candidates(board: &Board) -> Vec<SerialDevice> {
    let mut found: Vec<SerialDevice> = Vec::new();
    for kind in KINDS {
        for name in board.names("dev").into_iter().filter(|name| fits(kind, name)) {
            let kernel_name = kernel_name(board, &name);
            if found.iter().any(|known| known.kernel_name == kernel_name) || !is_real(board, &kernel_name) {
                continue;
            }
            let path = lasting_name(board, &kernel_name).unwrap_or_else(|| PathBuf::from("/dev").join(&name));
            found.push(SerialDevice { path, kernel_name });
        }
    }
    found
}

fn fits(kind: &str, name: &str) -> bool {
    name.strip_prefix(kind)
        .is_some_and(|number| number.chars().all(|digit| digit.is_ascii_digit()))
}

/// The device behind a link such as `/dev/serial0`.
pub(super) fn kernel_name(board: &Board, name: &str) -> String {
    board
        .link(&format!("dev/{name}"))
        .ok()
        .and_then(|target| Some(target.file_name()?.to_string_lossy().into_owned()))
        .unwrap_or_else(|| name.to_owned())
}

/// PCs list dozens of `ttyS` behind which nothing is: the kernel gives them no type.
fn is_real(board: &Board, kernel_name: &str) -> bool {
    !kernel_name.starts_with("ttyS")
        || kernel_name.starts_with("ttySAC")
        || board
            .text(&format!("sys/class/tty/{kernel_name}/type"))
            .is_none_or(|kind| kind != "0")
}

/// A name of a USB adapter that it keeps when another is plugged in before it.
fn lasting_name(board: &Board, kernel_name: &str) -> Option<PathBuf> {
    let folder = "dev/serial/by-id";
    let name = board.names(folder).into_iter().find(|name| {
        board
            .link(&format!("{folder}/{name}"))
            .is_ok_and(|target| target.file_name().is_some_and(|last| last == kernel_name))
    })?;
    Some(PathBuf::from("/dev/serial/by-id").join(name))
}
