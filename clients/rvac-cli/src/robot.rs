//! A robot on the serial line, while a person reads and types at the terminal.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::channel;

use anyhow::{Context as _, bail};
use calibration::{Hold, Robot, RobotEvent};
use serial2::SerialPort;

use crate::board::Board;
use crate::lines;
use crate::listen::listen;

/// Opens the line and a session on it.
pub(crate) fn open(port: &Path, baud: u32) -> anyhow::Result<Robot> {
    leave_to_daemon(port)?;
    let serial = SerialPort::open(port, baud)
        .with_context(|| format!("cannot open {} at {baud} baud", port.display()))?;
    let serial = Arc::new(serial);
    let (events, inbox) = channel();
    listen(
        Arc::clone(&serial),
        events.clone(),
        RobotEvent::Received,
        RobotEvent::Lost,
    );
    lines::read_input(events, RobotEvent::Typed, || RobotEvent::InputEnded);
    Ok(Robot::open(
        Box::new(SerialWriter(serial)),
        inbox,
        Hold::NotAsked,
    )?)
}

/// Refuses a line on which the daemon is: two programs would take each other's bytes. The kernel keeps a second program off a terminal that is
/// in use, but not one of root's.
pub(crate) fn leave_to_daemon(port: &Path) -> anyhow::Result<()> {
    match daemon_on(&Board::below(Path::new("/")), port) {
        Some(process) => bail!(
            "vthal (process {process}) is on {}: stop it first with sudo systemctl stop vthal, and start it afterwards",
            port.display()
        ),
        None => Ok(()),
    }
}

/// The daemon's process, if it has this device open and we may see that.
fn daemon_on(board: &Board, port: &Path) -> Option<String> {
    let device = fs::canonicalize(port).ok()?;
    board.names("proc").into_iter().find(|process| {
        let files = format!("proc/{process}/fd");
        let has_device = |file: &String| {
            board
                .link(&format!("{files}/{file}"))
                .is_ok_and(|target| target == device)
        };
        board.text(&format!("proc/{process}/comm")).as_deref() == Some("vthal")
            && board.names(&files).iter().any(has_device)
    })
}

/// The end of the line that is written, while a thread reads the other.
struct SerialWriter(Arc<SerialPort>);

impl Write for SerialWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;
    use std::path::Path;

    use super::daemon_on;
    use crate::board::Board;
    use crate::folder::Folder;

    fn process(processes: &Path, (number, name): (&str, &str), device: &Path) {
        let files = processes.join(number).join("fd");
        fs::create_dir_all(&files).expect("a folder");
        fs::write(processes.join(number).join("comm"), format!("{name}\n")).expect("a file");
        symlink(device, files.join("7")).expect("a link");
    }

    #[test]
    fn only_a_daemon_on_the_same_device_keeps_us_off() {
        let folder = Folder::new();
        let (device, other) = (folder.join("tty1"), folder.join("tty2"));
        for path in [&device, &other] {
            fs::write(path, "").expect("a file");
        }
        let serial = folder.join("serial0");
        symlink(&device, &serial).expect("a link");
        let (processes, board) = (folder.join("proc"), Board::below(&folder));
        process(&processes, ("11", "rvac-sim"), &device);
        process(&processes, ("12", "vthal"), &other);
        assert_eq!(daemon_on(&board, &serial), None);
        process(&processes, ("13", "vthal"), &device);
        assert_eq!(daemon_on(&board, &serial).as_deref(), Some("13"));
    }
}
