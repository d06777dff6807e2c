//! The make: everything that vthal must know of robots called pebble. They speak lines of text, answer only when they are
//! asked, keep their last command for ever, react to nothing, and count millimetres without a sign.

use brain::observation::{Cliffs, Contacts};
use vthal_core::Direction;
use vthal_core::device::{
    Arrivals, CleanerDrive, CommandError, DeadManKind, Description, Device, DeviceEvent, DeviceIo, Drive,
    DriveLimits, Greeting, Identity, Level, LinkQuality, Make, Odometry, Opening, ReflexSite, Reflexes,
    Report, SensorCounts, Shape, StopSite, WheelDrops, WheelTravel,
};

/// Pause between two questions.
const ASK_US: u64 = 100_000;
/// A robot that has not answered for so long is gone.
const SILENT_US: u64 = 1_000_000;
/// From a contact to the answer of the wheels: a question and two lines.
const LATENCY_S: f64 = 0.12;
pub(crate) const TRACK_M: f64 = 0.24;

pub(crate) const MAKE: Make = Make {
    name: "pebble",
    opening: Opening {
        rates_baud: &[19_200, 9_600],
        answer_within_ms: 500,
        wake_pulse_ms: 100,
        settle_ms: 20,
    },
    connect: || Box::new(Pebble::default()),
};

#[derive(Debug, Default)]
struct Pebble {
    line: Vec<u8>,
    tapped: [Vec<u8>; 2],
    description: Option<Description>,
    is_open: bool,
    has_control: bool,
    asked_us: Option<u64>,
    heard_us: u64,
    /// Lines that were understood, and others.
    lines: [u32; 2],
    drive: Drive,
}

impl Pebble {
    fn say(text: &str, io: &mut DeviceIo<'_>) {
        io.link.extend_from_slice(text.as_bytes());
        io.link.push(b'\n');
    }

    fn take(&mut self, line: &str, io: &mut DeviceIo<'_>) {
        let words: Vec<&str> = line.split(' ').collect();
        let understood = match words.as_slice() {
            ["pebble", version] => {
                self.greet(version, io);
                true
            }
            ["mode", mode] => {
                let has_control = *mode == "drive";
                if self.has_control && !has_control {
                    io.events.push(DeviceEvent::ControlLost("its mode"));
                }
                self.has_control = has_control;
                true
            }
            ["sense", fields @ ..] => match self.report(fields) {
                Some(report) => {
                    io.events.push(DeviceEvent::Report(report));
                    true
                }
                None => false,
            },
            _ => false,
        };
        self.lines[usize::from(!understood)] += 1;
        if understood {
            self.heard_us = io.now_us;
        }
    }

    fn greet(&mut self, version: &str, io: &mut DeviceIo<'_>) {
        self.is_open = true;
        io.events.push(DeviceEvent::Opened(Greeting {
            device: "pebble".to_owned(),
            firmware: version.to_owned(),
            reset_cause: None,
            was_reset: false,
        }));
        let description = describe(version);
        self.description = Some(description.clone());
        io.events.push(DeviceEvent::Described(Box::new(description)));
    }

    /// Totals of both wheels in millimetres, then bits: bumper, cliffs, wheel drops.
    fn report(&self, fields: &[&str]) -> Option<Report> {
        let [left, right, bumper, cliffs, drops] = fields else {
            return None;
        };
        let metres = |field: &str| Some(f64::from(field.parse::<u32>().ok()?) * 0.001);
        let bits = |field: &str| field.parse::<u8>().ok();
        let (bumper, cliffs, drops) = (bits(bumper)?, bits(cliffs)?, bits(drops)?);
        Some(Report {
            travel: WheelTravel {
                left_m: metres(left)?,
                right_m: metres(right)?,
                speeds: None,
            },
            is_driven: self.drive != Drive::STAND,
            contacts: Contacts {
                left: bumper & 1 != 0,
                right: bumper & 2 != 0,
            },
            cliffs: Cliffs {
                middle: cliffs != 0,
                ..Cliffs::default()
            },
            wheel_drops: WheelDrops {
                left: drops & 1 != 0,
                right: drops & 2 != 0,
            },
            ..Report::default()
        })
    }
}

fn describe(version: &str) -> Description {
    let host = ReflexSite::Host { latency_s: LATENCY_S };
    Description {
        identity: Identity {
            device: "pebble".to_owned(),
            firmware: version.to_owned(),
            protocol: 1,
        },
        // The first version waits for measured wheels.
        levels: if version == "1.0" { &[] } else { &[Level::Motion] },
        shape: Shape::D {
            radius_m: 0.16,
            front_m: 0.12,
        },
        swath_m: 0.3,
        drive: DriveLimits {
            track_m: TRACK_M,
            speed_max_m_per_s: 0.4,
            turn_max_rad_per_s: 1.5,
            dead_man: DeadManKind::None,
        },
        odometry: Odometry {
            resolution_m: 0.001,
            sign_reliable: false,
        },
        reflexes: Reflexes {
            bump: host,
            cliff: host,
            lift: host,
        },
        stop: StopSite::Host,
        sensors: SensorCounts {
            bumpers: 2,
            cliffs: 1,
            wheel_drops: 2,
            ..SensorCounts::default()
        },
        parts: Vec::new(),
        unguarded: Vec::new(),
        unmeasured: Vec::new(),
    }
}

impl Device for Pebble {
    fn open(&mut self, io: &mut DeviceIo<'_>) {
        *self = Self {
            asked_us: Some(io.now_us),
            ..Self::default()
        };
        Self::say("who", io);
    }

    fn description(&self) -> Option<&Description> {
        self.description.as_ref()
    }

    fn is_attached(&self) -> bool {
        self.description.is_some() && self.is_open
    }

    fn link_quality(&self) -> LinkQuality {
        let [good, bad] = self.lines;
        let bad_share = f64::from(bad) / f64::from((good + bad).max(1));
        LinkQuality {
            arrivals: Arrivals {
                reports: good,
                garbled: bad,
                ..Arrivals::default()
            },
            bad_share,
            ..LinkQuality::default()
        }
    }

    fn receive(&mut self, bytes: &[u8], io: &mut DeviceIo<'_>) {
        for byte in bytes {
            if *byte == b'\n' {
                let line = std::mem::take(&mut self.line);
                self.take(&String::from_utf8_lossy(&line), io);
            } else if self.line.len() < 80 {
                self.line.push(*byte);
            }
        }
    }

    fn poll(&mut self, io: &mut DeviceIo<'_>) {
        if self.is_open && io.now_us > self.heard_us + SILENT_US {
            self.is_open = false;
            io.events.push(DeviceEvent::Closed);
        }
        if self
            .asked_us
            .is_none_or(|asked_us| io.now_us >= asked_us + ASK_US)
        {
            self.asked_us = Some(io.now_us);
            Self::say(if self.is_open { "sense" } else { "who" }, io);
        }
    }

    fn next_wake_us(&self, now_us: u64) -> u64 {
        self.asked_us.map_or(now_us, |asked_us| asked_us + ASK_US)
    }

    fn acquire(&mut self, _level: Level, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        if self.has_control {
            return Ok(());
        }
        Self::say("mode drive", io);
        Err(CommandError::Busy)
    }

    fn release(&mut self, io: &mut DeviceIo<'_>) {
        self.drive = Drive::STAND;
        self.has_control = false;
        Self::say("wheels 0 0", io);
        Self::say("mode idle", io);
    }

    fn drive(&mut self, drive: Drive, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        self.drive = drive;
        let [left, right] = drive
            .rims_m_per_s(TRACK_M)
            .map(|rim_m_per_s| (rim_m_per_s * 1000.0).round());
        Self::say(&format!("wheels {left} {right}"), io);
        Ok(())
    }

    fn stop(&mut self, io: &mut DeviceIo<'_>) {
        self.drive = Drive::STAND;
        Self::say("wheels 0 0", io);
    }

    fn cleaners(&mut self, _drive: CleanerDrive, _io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        Ok(())
    }

    fn raw(&mut self, text: &str, io: &mut DeviceIo<'_>) -> Result<(), CommandError> {
        let is_command = ["who", "sense", "mode ", "wheels "]
            .iter()
            .any(|word| text.starts_with(word));
        if !is_command || text.contains('\n') {
            return Err(CommandError::Syntax);
        }
        Self::say(text, io);
        Ok(())
    }

    fn tap(&mut self, direction: Direction, bytes: &[u8], packets: &mut Vec<(Direction, String)>) {
        let line = &mut self.tapped[usize::from(direction == Direction::ToRobot)];
        for byte in bytes {
            if *byte == b'\n' {
                packets.push((direction, String::from_utf8_lossy(line).into_owned()));
                line.clear();
            } else {
                line.push(*byte);
            }
        }
    }
}
