//! A DWM1001 module on the Linux board, behind a terminal of its own: answers and output of its stock firmware, with
//! the distances of simulated beacons.
//!
//! Words and output are those of the DWM1001 Firmware API Guide 2.2, as far as a tag needs them. The module begins with
//! its binary interface, of which only the refusal is here; two returns within a second open the shell. A return alone
//! repeats the last command, which is what makes `lec` a switch that is easily pressed twice.

use std::io;
use std::path::Path;

use home::{Beacons, Measured};

use super::pty::{Peer, Pty, PtyError};
use crate::Robot;

/// Two returns that are apart for longer do not open the shell, milliseconds.
const TOGETHER_MS: u64 = 1_000;
/// Milliseconds between two lines: the fastest rate of the stock firmware, ten a second.
const LINE_MS: u64 = 100;
/// Anchors that the module measures for a line.
const ANCHORS: usize = 4;
/// Answer of the binary interface to an invalid request.
const REFUSAL: &[u8] = &[0x40, 0x01, 0x01];
/// Longest command; the rest of a longer one is dropped.
const COMMAND_MAX: usize = 64;

/// The module and its terminal.
#[derive(Debug)]
pub(super) struct Radio {
    pty: Pty,
    beacons: Beacons,
    module: Module,
}

impl Radio {
    pub(super) fn open(link: &Path, beacons: Beacons) -> Result<Self, PtyError> {
        Ok(Self {
            pty: Pty::open(link)?,
            beacons,
            module: Module::default(),
        })
    }

    /// Reads bytes from the daemon and writes the module's output.
    pub(super) fn carry(&mut self, now_ms: u64) -> io::Result<()> {
        let mut buffer = [0; 256];
        match self.pty.read(&mut buffer)? {
            Peer::Present(count) => {
                self.module.take(now_ms, buffer.get(..count).unwrap_or_default());
                let said = std::mem::take(&mut self.module.said);
                if !said.is_empty() {
                    // What does not fit is lost, as on a serial line.
                    self.pty.write(&said)?;
                }
            }
            Peer::Absent => self.module.said.clear(),
        }
        Ok(())
    }

    /// One millisecond later.
    pub(super) fn pass_ms(&mut self, robot: &Robot) {
        let world = robot.world();
        if let Some((beacon, Measured::Range(range_m))) = self.beacons.step(world.home(), world.truth().pose)
        {
            self.module.measure(beacon, range_m);
        }
        if robot.now_ms().is_multiple_of(LINE_MS) {
            self.module.print();
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum RadioMode {
    #[default]
    Binary,
    Shell,
}

/// What the module's firmware does with bytes and distances.
#[derive(Debug, Default)]
struct Module {
    mode: RadioMode,
    returned_ms: Option<u64>,
    command: Vec<u8>,
    last: Vec<u8>,
    prints: bool,
    /// Number and distance of each anchor that answered since the last line.
    measured: Vec<(u16, f64)>,
    said: Vec<u8>,
}

impl Module {
    fn take(&mut self, now_ms: u64, bytes: &[u8]) {
        for &byte in bytes {
            match self.mode {
                RadioMode::Binary => self.take_binary(now_ms, byte),
                RadioMode::Shell => self.take_letter(byte),
            }
        }
    }

    fn take_binary(&mut self, now_ms: u64, byte: u8) {
        if byte != b'\r' {
            self.returned_ms = None;
            self.said.extend_from_slice(REFUSAL);
            return;
        }
        let before_ms = self.returned_ms.replace(now_ms);
        if before_ms.is_some_and(|before_ms| now_ms <= before_ms + TOGETHER_MS) {
            self.returned_ms = None;
            self.mode = RadioMode::Shell;
            self.say("\r\n DWM1001 TWR Real Time Location System\r\n\r\ndwm> ");
        }
    }

    fn take_letter(&mut self, byte: u8) {
        self.said.push(byte);
        if byte != b'\r' {
            if self.command.len() < COMMAND_MAX {
                self.command.push(byte);
            }
            return;
        }
        self.say("\n");
        let command = std::mem::take(&mut self.command);
        if !command.is_empty() {
            self.last = command;
        }
        match self.last.as_slice() {
            b"lec" => self.prints = !self.prints,
            b"quit" => {
                self.mode = RadioMode::Binary;
                self.last.clear();
            }
            b"" => {}
            _ => self.say("unknown command\r\n"),
        }
        if self.mode == RadioMode::Shell {
            self.say("dwm> ");
        }
    }

    fn measure(&mut self, beacon: u16, range_m: f64) {
        self.measured.retain(|(known, _)| *known != beacon);
        self.measured.push((beacon, range_m));
    }

    /// Prints what was measured since the last line. Positions of the anchors are those of a network without
    /// configuration.
    fn print(&mut self) {
        let measured = std::mem::take(&mut self.measured);
        if !self.prints || measured.is_empty() {
            return;
        }
        let reported = measured.len().min(ANCHORS);
        let mut line = format!("DIST,{reported}");
        for (number, (beacon, range_m)) in measured.iter().take(ANCHORS).enumerate() {
            let address = 0xDEC0 + beacon;
            line.push_str(&format!(",AN{number},{address:04X},0.00,0.00,0.00,{range_m:.2}"));
        }
        line.push_str("\r\n");
        self.say(&line);
    }

    fn say(&mut self, text: &str) {
        self.said.extend_from_slice(text.as_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::{Module, REFUSAL, RadioMode};

    fn said(module: &mut Module) -> String {
        String::from_utf8(std::mem::take(&mut module.said)).unwrap()
    }

    #[test]
    fn two_returns_open_the_shell_and_a_further_one_repeats_the_command() {
        let mut module = Module::default();
        module.take(0, b"lec\r");
        assert_eq!(module.said, REFUSAL.repeat(3));
        module.take(1_500, b"\r");
        assert_eq!(module.mode, RadioMode::Binary, "too late");
        module.take(1_600, b"\r");
        assert!(said(&mut module).ends_with("dwm> "));
        module.take(1_700, b"lec\r");
        assert_eq!(said(&mut module), "lec\r\ndwm> ");
        module.measure(1, 3.214);
        module.measure(1, 3.25);
        module.print();
        assert_eq!(said(&mut module), "DIST,1,AN0,DEC1,0.00,0.00,0.00,3.25\r\n");
        module.print();
        assert_eq!(said(&mut module), "", "nothing new was measured");
        module.take(1_800, b"\r");
        said(&mut module);
        module.measure(1, 3.25);
        module.print();
        assert_eq!(said(&mut module), "", "switched off again");
        module.take(1_900, b"quit\r");
        assert_eq!(module.mode, RadioMode::Binary);
    }
}
