//! The checkpoint on disk: a header that proves it whole, and the state as JSON.
//!
//! It is replaced as [`kept_file`] describes. Age is measured on the system's uptime, which no clock change moves: a checkpoint of an earlier
//! boot is never young.

use std::fs;
use std::io;
use std::path::Path;

use rvac_api::RunRecord;
use rvac_protocol::crc::{Digest, Direction};
use serde::{Deserialize, Serialize};
use vthal_core::Checkpoint;

use crate::recording::format::BrainState;

/// A checkpoint older than this is not used, because somebody may have moved the robot.
const AGE_MAX_S: f64 = 60.0;
/// First word of the header.
const MAGIC: &str = "vthal-checkpoint-1";

#[derive(Serialize, Deserialize)]
struct Stored {
    boot: String,
    uptime_s: f64,
    device: String,
    #[serde(default)]
    floor: Option<u16>,
    brain: BrainState,
    /// Absent in checkpoints of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    run: Option<Box<RunRecord>>,
}

/// A moment of the running system.
#[derive(Clone, Debug, PartialEq)]
pub struct BootTime {
    /// Identity of this boot.
    pub boot: String,
    /// Seconds since it.
    pub uptime_s: f64,
}

impl BootTime {
    /// Now.
    ///
    /// # Errors
    /// When `/proc` cannot be read.
    pub fn now() -> io::Result<Self> {
        let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id")?
            .trim()
            .to_owned();
        let uptime = fs::read_to_string("/proc/uptime")?;
        let uptime_s = uptime.split(' ').next().and_then(|word| word.parse().ok());
        Ok(Self {
            boot,
            uptime_s: uptime_s.ok_or(io::ErrorKind::InvalidData)?,
        })
    }
}

/// Writes `checkpoint` so that after a crash at any moment either it or its predecessor is there, whole.
///
/// # Errors
/// What the file system says.
pub fn save(path: &Path, checkpoint: &Checkpoint, now: BootTime) -> io::Result<()> {
    let stored = Stored {
        boot: now.boot,
        uptime_s: now.uptime_s,
        device: checkpoint.device.clone(),
        floor: checkpoint.floor,
        brain: BrainState::from(&checkpoint.brain),
        run: checkpoint.run.clone(),
    };
    let body = serde_json::to_vec(&stored)?;
    let mut bytes = format!("{MAGIC} {} {:08X}\n", body.len(), digest(&body)).into_bytes();
    bytes.extend(body);
    kept_file::replace(path, &bytes)
}

/// The newest whole checkpoint that is young enough, if there is one.
#[must_use]
pub fn load(path: &Path, now: &BootTime) -> Option<Checkpoint> {
    newest(path, now)
        .0
        .filter(|found| found.is_young)
        .map(|found| found.checkpoint)
}

/// A checkpoint of a daemon before this one.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// It.
    pub checkpoint: Checkpoint,
    /// It is so young that its job may go on.
    pub is_young: bool,
}

/// The newest whole checkpoint, however old, and what is wrong with a newer one, for people.
#[must_use]
pub fn newest(path: &Path, now: &BootTime) -> (Option<Found>, Option<String>) {
    let [present, before] = kept_file::versions(path);
    if let Some(found) = load_one(&present, now) {
        return (Some(found), None);
    }
    let complaint = present.exists().then(|| {
        format!(
            "the checkpoint {} cannot be read: what the robot did last is taken from the one before it, if that is whole",
            present.display()
        )
    });
    (load_one(&before, now), complaint)
}

fn load_one(path: &Path, now: &BootTime) -> Option<Found> {
    let bytes = kept_file::read(path).ok()?;
    let end = bytes.iter().position(|byte| *byte == b'\n')?;
    let (header, body) = (bytes.get(..end)?, bytes.get(end + 1..)?);
    let expected = format!("{MAGIC} {} {:08X}", body.len(), digest(body));
    if header != expected.as_bytes() {
        return None;
    }
    let stored: Stored = serde_json::from_slice(body).ok()?;
    let age_s = now.uptime_s - stored.uptime_s;
    let brain = stored.brain.to_brain()?;
    Some(Found {
        checkpoint: Checkpoint {
            device: stored.device,
            floor: stored.floor,
            brain,
            run: stored.run,
        },
        is_young: stored.boot == now.boot && (0.0..=AGE_MAX_S).contains(&age_s),
    })
}

fn digest(body: &[u8]) -> u32 {
    let mut digest = Digest::start(Direction::HostToRobot, 0);
    digest.extend(body);
    digest.crc()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use brain::geometry::Pose2;
    use vthal_bench::Scratch;
    use vthal_core::Checkpoint;

    use super::{BootTime, load, save};

    fn at(uptime_s: f64) -> BootTime {
        BootTime {
            boot: "a".to_owned(),
            uptime_s,
        }
    }

    fn checkpoint(x_m: f64) -> Checkpoint {
        let pose = Pose2 {
            x_m,
            y_m: -0.1,
            heading_rad: 1.0 / 3.0,
        };
        Checkpoint {
            device: "sr8730".to_owned(),
            floor: Some(2),
            brain: brain::Checkpoint {
                pose,
                backed_m: 0.07,
                ..brain::Checkpoint::default()
            },
            run: None,
        }
    }

    #[test]
    fn only_young_ones_of_this_boot_count() {
        let folder = Scratch::new().expect("creates");
        let path = folder.join("checkpoint");
        save(&path, &checkpoint(1.5), at(100.0)).expect("saves");
        assert_eq!(load(&path, &at(160.0)), Some(checkpoint(1.5)));
        assert_eq!(load(&path, &at(160.1)), None);
        assert_eq!(load(&path, &at(99.0)), None);
        assert_eq!(
            load(
                &path,
                &BootTime {
                    boot: "b".to_owned(),
                    uptime_s: 101.0
                }
            ),
            None
        );
    }

    #[test]
    fn a_broken_one_gives_way_to_its_predecessor_at_every_byte() {
        let folder = Scratch::new().expect("creates");
        let path = folder.join("checkpoint");
        save(&path, &checkpoint(1.0), at(100.0)).expect("saves");
        save(&path, &checkpoint(2.0), at(101.0)).expect("saves");
        assert_eq!(load(&path, &at(102.0)), Some(checkpoint(2.0)));
        let whole = fs::read(&path).expect("reads");
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).expect("writes");
            assert_eq!(load(&path, &at(102.0)), Some(checkpoint(1.0)), "cut at {length}");
        }
        for index in 0..whole.len() {
            let mut flipped = whole.clone();
            flipped[index] ^= 4;
            fs::write(&path, &flipped).expect("writes");
            assert_eq!(
                load(&path, &at(102.0)),
                Some(checkpoint(1.0)),
                "flipped at {index}"
            );
        }
    }
}
