//! What a recording tells of a run in few numbers. The file is read piece by piece: it may be larger than the memory.

use std::collections::BTreeMap;
use std::io::{self, Read};

use mcap::parse_record;
use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use rvac_api::{DeviceTable, RunTrack, TrackPose, TrackReading};
use serde::Deserialize;

use super::{DEVICE, POSE};

/// Poses and readings that are told at most. Of a longer run every second one is left out, again and again.
const POSES_MAX: usize = 10_000;
const READINGS_MAX: usize = 2_000;
/// Times between two of them in a run that is short, seconds.
const POSE_S: f64 = 0.45;
const READING_S: f64 = 0.9;
/// No record of ours is longer.
const RECORD_BYTES_MAX: usize = 64 << 20;

/// Reads a recording of a run that began at `zero_s` of its clock.
///
/// # Errors
/// What the file system says. A file that ends in the middle, or is no recording, gives what was read of it.
pub fn track(file: &mut impl Read, zero_s: f64) -> io::Result<RunTrack> {
    let options = LinearReaderOptions::default().with_record_length_limit(RECORD_BYTES_MAX);
    let mut reader = LinearReader::new_with_options(options);
    let mut collector = Collector::new(zero_s);
    let mut is_whole = true;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = file.read(reader.insert(wanted))?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { data, opcode }) => {
                if let Ok(record) = parse_record(opcode, data) {
                    collector.take(&record);
                }
            }
            Err(_) => {
                is_whole = false;
                break;
            }
        }
    }
    Ok(RunTrack {
        poses: collector.poses.kept,
        readings: collector.readings.kept,
        truncated: !is_whole,
        ..RunTrack::default()
    })
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Topic {
    Pose,
    Device,
}

struct Collector {
    zero_s: f64,
    channels: BTreeMap<u16, Topic>,
    poses: Thinned<TrackPose>,
    readings: Thinned<TrackReading>,
}

impl Collector {
    fn new(zero_s: f64) -> Self {
        Self {
            zero_s,
            channels: BTreeMap::new(),
            poses: Thinned::new(POSE_S, POSES_MAX),
            readings: Thinned::new(READING_S, READINGS_MAX),
        }
    }

    fn take(&mut self, record: &Record<'_>) {
        match record {
            Record::Channel(channel) => {
                let topic = match channel.topic.as_str() {
                    POSE => Topic::Pose,
                    DEVICE => Topic::Device,
                    _ => return,
                };
                self.channels.insert(channel.id, topic);
            }
            Record::Message { header, data } => {
                let t_s = header.log_time as f64 / 1e9 - self.zero_s;
                match self.channels.get(&header.channel_id) {
                    Some(Topic::Pose) => self.poses.take(t_s, || pose(t_s, data)),
                    Some(Topic::Device) => self.readings.take(t_s, || reading(t_s, data)),
                    None => {}
                }
            }
            _ => {}
        }
    }
}

/// Entries with a time between them, which grows when there are too many.
struct Thinned<T> {
    kept: Vec<T>,
    pause_s: f64,
    next_s: f64,
    max: usize,
}

impl<T> Thinned<T> {
    fn new(pause_s: f64, max: usize) -> Self {
        Self {
            kept: Vec::new(),
            pause_s,
            next_s: f64::NEG_INFINITY,
            max,
        }
    }

    fn take(&mut self, t_s: f64, read: impl FnOnce() -> Option<T>) {
        if t_s < self.next_s {
            return;
        }
        let Some(entry) = read() else { return };
        self.next_s = t_s + self.pause_s;
        if self.kept.len() == self.max {
            let mut place = 0_usize;
            self.kept.retain(|_| {
                place += 1;
                place % 2 == 1
            });
            self.pause_s *= 2.0;
        }
        self.kept.push(entry);
    }
}

/// As much of a `foxglove.PoseInFrame` as is wanted.
#[derive(Deserialize)]
struct Posed {
    pose: Place,
}

#[derive(Deserialize)]
struct Place {
    position: Position,
    orientation: Orientation,
}

#[derive(Deserialize)]
struct Position {
    x: f64,
    y: f64,
}

#[derive(Deserialize)]
struct Orientation {
    z: f64,
    w: f64,
}

fn pose(t_s: f64, data: &[u8]) -> Option<TrackPose> {
    let Posed {
        pose: Place {
            position,
            orientation,
        },
    } = serde_json::from_slice(data).ok()?;
    let heading_rad = 2.0 * orientation.z.atan2(orientation.w);
    let rounded = |value: f64| ((1e3 * value).round() / 1e3) as f32;
    Some(TrackPose(
        rounded(t_s),
        rounded(position.x),
        rounded(position.y),
        rounded(heading_rad),
    ))
}

fn reading(t_s: f64, data: &[u8]) -> Option<TrackReading> {
    let table: DeviceTable = serde_json::from_slice(data).ok()?;
    Some(TrackReading {
        t: ((1e3 * t_s).round() / 1e3) as f32,
        charge: table.battery.as_ref().map(|battery| battery.charge as f32),
        battery_a: table.battery.as_ref().map(|battery| battery.current_a as f32),
        motors_a: table.currents_a,
        bad_share: table.link.bad_share as f32,
    })
}

#[cfg(test)]
mod tests {
    use super::{Thinned, track};

    #[test]
    fn what_is_no_recording_gives_nothing() {
        for bytes in [&b""[..], b"hello", &[0; 5_000], mcap::MAGIC] {
            let track = track(&mut &bytes[..], 0.0).expect("reads");
            assert!(track.truncated && track.poses.is_empty(), "{bytes:?}");
        }
    }

    #[test]
    fn of_much_only_so_much_is_kept_and_it_spans_all() {
        let mut thinned = Thinned::new(0.5, 100);
        for tick in 0..100_000 {
            let t_s = 0.05 * f64::from(tick);
            thinned.take(t_s, || Some(t_s));
        }
        assert!(
            thinned.kept.len() <= 100 && thinned.kept.len() > 40,
            "{}",
            thinned.kept.len()
        );
        assert_eq!(thinned.kept.first(), Some(&0.0));
        assert!(thinned.kept.last().is_some_and(|last| *last > 4_800.0));
    }
}
