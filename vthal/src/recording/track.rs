//! A summary of the recordings of a run.

use std::collections::BTreeMap;
use std::io::{self, Read};

use mcap::records::Record;
use rvac_api::{DeviceTable, RunTrack, TrackPose, TrackReading};
use serde::Deserialize;

use super::records::{AfterDamage, Records};
use super::{DEVICE, POSE, Part};

/// Most poses and readings in a summary. Of a longer run every second one is left out, repeatedly.
const POSES_MAX: usize = 10_000;
const READINGS_MAX: usize = 2_000;
/// Times between two of them in a run that is short, seconds.
const POSE_S: f64 = 0.45;
const READING_S: f64 = 0.9;
/// Reads the recordings of a run, each with the time of its clock at which the run began. What one contains of the time of the next
/// one is left out: the daemon went on from before that.
///
/// # Errors
/// What the file system says. A file that ends in the middle, or is no recording, gives what was read of it.
pub fn track<R: Read>(parts: impl IntoIterator<Item = Part<R>>) -> io::Result<RunTrack> {
    let mut collector = Collector::default();
    let mut is_whole = true;
    for part in parts {
        let mut records = Records::new(part.file, AfterDamage::GoOn);
        collector.begin(part.zero_s);
        while records.next(|record| collector.take(record))?.is_some() {}
        is_whole &= records.is_whole();
    }
    Ok(RunTrack {
        begins_s: collector.begins_s,
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
    /// No message of this recording has come yet.
    is_new: bool,
    begins_s: Vec<f32>,
    channels: BTreeMap<u16, Topic>,
    poses: Thinned<TrackPose>,
    readings: Thinned<TrackReading>,
}

impl Default for Collector {
    fn default() -> Self {
        Self {
            zero_s: 0.0,
            is_new: true,
            begins_s: Vec::new(),
            channels: BTreeMap::new(),
            poses: Thinned::new(POSE_S, POSES_MAX),
            readings: Thinned::new(READING_S, READINGS_MAX),
        }
    }
}

impl Collector {
    /// What comes is of another recording.
    fn begin(&mut self, zero_s: f64) {
        self.channels.clear();
        (self.zero_s, self.is_new) = (zero_s, true);
    }

    fn begin_at(&mut self, t_s: f64) {
        self.is_new = false;
        let begin_s = rounded(t_s);
        self.begins_s.push(begin_s);
        self.poses.cut(t_s, |pose| pose.0 < begin_s);
        self.readings.cut(t_s, |reading| reading.t < begin_s);
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
                if self.is_new {
                    self.begin_at(t_s);
                }
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

    /// Leaves out entries from `t_s` on; the next entry is that of `t_s`.
    fn cut(&mut self, t_s: f64, is_before: impl Fn(&T) -> bool) {
        self.kept.retain(is_before);
        self.next_s = t_s;
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

/// The needed part of a `foxglove.PoseInFrame`.
#[derive(Deserialize)]
struct Posed {
    pose: LoggedPose,
}

#[derive(Deserialize)]
struct LoggedPose {
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

/// Milliseconds and millimetres are enough for an eye.
fn rounded(value: f64) -> f32 {
    ((1e3 * value).round() / 1e3) as f32
}

fn pose(t_s: f64, data: &[u8]) -> Option<TrackPose> {
    let Posed {
        pose: LoggedPose {
            position,
            orientation,
        },
    } = serde_json::from_slice(data).ok()?;
    let heading_rad = 2.0 * orientation.z.atan2(orientation.w);
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
        t: rounded(t_s),
        charge: table.battery.as_ref().map(|battery| battery.charge as f32),
        battery_a: table.battery.as_ref().map(|battery| battery.current_a as f32),
        motors_a: table.currents_a,
        bad_share: table.link.bad_share as f32,
    })
}

#[cfg(test)]
mod tests {
    use super::{Part, Thinned, track};

    #[test]
    fn what_is_no_recording_gives_nothing() {
        for bytes in [&b""[..], b"hello", &[0; 5_000], mcap::MAGIC] {
            let part = Part {
                name: String::new(),
                zero_s: 0.0,
                file: bytes,
            };
            let track = track([part]).expect("reads");
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
