//! The calibration that each robot has learned, as it is stored: JSON of the file `learnt.json`.

use brain::{EnergyModel, GyroLearnt, Learnt, LearntPart};
use serde::{Deserialize, Serialize};

use crate::stored_version::OtherVersion;

const VERSION: u32 = 1;
/// Robots of which something is kept: a board is moved from one to another now and then.
const DEVICES_MAX: usize = 8;

/// What is kept of one robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RobotRecord {
    /// The robot's name.
    pub device: String,
    /// What it has learnt.
    pub learnt: Learnt,
    /// When it learnt that, seconds since 1970; `None` = by a board without a clock.
    pub learnt_s: Option<i64>,
}

/// What robots have learnt, the newest last.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Learnings {
    devices: Vec<RobotRecord>,
}

impl Learnings {
    /// What this robot has learnt.
    #[must_use]
    pub fn of(&self, device: &str) -> Learnt {
        let known = self.devices.iter().find(|kept| kept.device == device);
        known.map(|kept| kept.learnt).unwrap_or_default()
    }

    /// The robots of which something is kept, the newest last.
    pub fn iter(&self) -> impl Iterator<Item = &RobotRecord> {
        self.devices.iter()
    }

    /// Deletes these parts of a robot's record. Returns the stored record; `None` = there was none.
    pub fn forget(&mut self, device: &str, parts: &[LearntPart]) -> Option<RobotRecord> {
        let known = self.devices.iter_mut().find(|kept| kept.device == device)?;
        let before = known.clone();
        for part in parts {
            match part {
                LearntPart::Gyro => known.learnt.gyro = None,
                LearntPart::Energy => known.learnt.energy = EnergyModel::default(),
            }
        }
        self.devices.retain(|kept| kept.learnt != Learnt::default());
        Some(before)
    }

    /// Stores the learned values of a robot. `true` when that changes something. A gyro that the values lack keeps its old value.
    pub fn take(&mut self, mut kept: RobotRecord) -> bool {
        let before = self.of(&kept.device);
        kept.learnt.gyro = kept.learnt.gyro.or(before.gyro);
        if before == kept.learnt {
            return false;
        }
        self.devices.retain(|known| known.device != kept.device);
        if self.devices.len() >= DEVICES_MAX {
            self.devices.remove(0);
        }
        self.devices.push(kept);
        true
    }
}

/// For people; `None` when nothing was learnt.
pub(crate) fn summary(learnt: &Learnt) -> Option<String> {
    let gyro = learnt.gyro.map(|gyro| {
        format!(
            "the gyro counts {:+.2} % too little (sure to {:.2} %)",
            100.0 * gyro.scale,
            100.0 * gyro.scale_sigma
        )
    });
    let energy = (learnt.energy.seen_s > 0.0).then(|| {
        format!(
            "an hour of cleaning takes {:.0} % of the charge, one of driving {:.0} %",
            360_000.0 * learnt.energy.cleaning_per_s,
            360_000.0 * learnt.energy.driving_per_s
        )
    });
    let parts: Vec<String> = gyro.into_iter().chain(energy).collect();
    (!parts.is_empty()).then(|| format!("begins with what was learnt before: {}", parts.join("; ")))
}

/// Version and robots.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredLearnings {
    version: u32,
    devices: Vec<StoredDevice>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct StoredDevice {
    device: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gyro: Option<StoredGyro>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    energy: Option<StoredEnergy>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    learnt_s: Option<i64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct StoredGyro {
    scale: f64,
    scale_sigma: f64,
    bias_rad_per_s: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct StoredEnergy {
    cleaning_per_s: f64,
    driving_per_s: f64,
    seen_s: f64,
}

/// Why what was kept cannot be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LearntError {
    /// Of another daemon.
    #[error(transparent)]
    Version(#[from] OtherVersion),
    /// More than this daemon keeps.
    #[error("it names {0} robots, and at most {DEVICES_MAX} are kept")]
    Devices(usize),
    /// No gyro is so wrong.
    #[error("what it says of the gyro of {0} cannot be")]
    Gyro(String),
    /// No pack empties at such a rate.
    #[error("what it says of the pack of {0} cannot be")]
    Energy(String),
}

impl From<&Learnings> for StoredLearnings {
    fn from(learnings: &Learnings) -> Self {
        Self {
            version: VERSION,
            devices: learnings.devices.iter().map(StoredDevice::from).collect(),
        }
    }
}

impl From<&RobotRecord> for StoredDevice {
    fn from(kept: &RobotRecord) -> Self {
        let Learnt { gyro, energy } = kept.learnt;
        Self {
            device: kept.device.clone(),
            gyro: gyro.map(|gyro| StoredGyro {
                scale: gyro.scale,
                scale_sigma: gyro.scale_sigma,
                bias_rad_per_s: gyro.bias_rad_per_s,
            }),
            energy: (energy.seen_s > 0.0).then_some(StoredEnergy {
                cleaning_per_s: energy.cleaning_per_s,
                driving_per_s: energy.driving_per_s,
                seen_s: energy.seen_s,
            }),
            learnt_s: kept.learnt_s,
        }
    }
}

impl TryFrom<StoredLearnings> for Learnings {
    type Error = LearntError;

    fn try_from(stored: StoredLearnings) -> Result<Self, LearntError> {
        OtherVersion::expect(stored.version, VERSION)?;
        if stored.devices.len() > DEVICES_MAX {
            return Err(LearntError::Devices(stored.devices.len()));
        }
        let mut learnings = Self::default();
        for stored in stored.devices {
            let learnt = Learnt {
                gyro: stored.gyro()?,
                energy: stored.energy()?,
            };
            learnings.take(RobotRecord {
                device: stored.device,
                learnt,
                learnt_s: stored.learnt_s,
            });
        }
        Ok(learnings)
    }
}

impl StoredDevice {
    fn gyro(&self) -> Result<Option<GyroLearnt>, LearntError> {
        let Some(gyro) = self.gyro else { return Ok(None) };
        let learnt = GyroLearnt {
            scale: gyro.scale,
            scale_sigma: gyro.scale_sigma,
            bias_rad_per_s: gyro.bias_rad_per_s,
        };
        let checked = learnt.checked();
        checked
            .map(Some)
            .ok_or_else(|| LearntError::Gyro(self.device.clone()))
    }

    fn energy(&self) -> Result<EnergyModel, LearntError> {
        let Some(energy) = self.energy else {
            return Ok(EnergyModel::default());
        };
        let model = EnergyModel {
            cleaning_per_s: energy.cleaning_per_s,
            driving_per_s: energy.driving_per_s,
            seen_s: energy.seen_s,
        };
        if model.checked() == model {
            Ok(model)
        } else {
            Err(LearntError::Energy(self.device.clone()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DEVICES_MAX, Learnings, LearntError, OtherVersion, RobotRecord, StoredLearnings, summary};
    use brain::{EnergyModel, GyroLearnt, Learnt, LearntPart};

    fn learnt(scale: f64) -> Learnt {
        Learnt {
            gyro: Some(GyroLearnt {
                scale,
                scale_sigma: 0.001,
                bias_rad_per_s: -0.002,
            }),
            energy: EnergyModel {
                seen_s: 1_200.0,
                ..EnergyModel::default()
            },
        }
    }

    fn kept(device: &str, learnt: Learnt) -> RobotRecord {
        RobotRecord {
            device: device.to_owned(),
            learnt,
            learnt_s: Some(1_800_000_000),
        }
    }

    #[test]
    fn each_robot_has_its_own_and_only_news_are_news() {
        let mut learnings = Learnings::default();
        assert_eq!(learnings.of("sr8730"), Learnt::default());
        assert!(learnings.take(kept("sr8730", learnt(0.01))));
        assert!(!learnings.take(kept("sr8730", learnt(0.01))));
        assert!(learnings.take(kept("relax", learnt(-0.02))));
        assert_eq!(learnings.of("sr8730"), learnt(0.01));
        assert!(
            !learnings.take(kept("other", Learnt::default())),
            "nothing was learnt"
        );
        let of_pack = Learnt {
            gyro: None,
            ..learnt(0.01)
        };
        assert!(!learnings.take(kept("sr8730", of_pack)), "the gyro is as it was");
        let stored = StoredLearnings::from(&learnings);
        assert_eq!(Learnings::try_from(stored), Ok(learnings));
    }

    #[test]
    fn a_part_is_forgotten_and_a_robot_of_which_nothing_is_left() {
        let mut learnings = Learnings::default();
        learnings.take(kept("a", learnt(0.01)));
        assert_eq!(learnings.forget("b", &[LearntPart::Gyro]), None);
        assert_eq!(
            learnings.forget("a", &[LearntPart::Gyro]),
            Some(kept("a", learnt(0.01)))
        );
        let of_pack = Learnt {
            gyro: None,
            ..learnt(0.01)
        };
        assert_eq!(learnings.iter().collect::<Vec<_>>(), [&kept("a", of_pack)]);
        assert_eq!(
            learnings.forget("a", &[LearntPart::Energy]),
            Some(kept("a", of_pack))
        );
        assert_eq!(learnings, Learnings::default());
        assert!(learnings.take(kept("a", learnt(0.02))), "it can be learnt anew");
    }

    #[test]
    fn the_robots_that_were_seen_longest_ago_are_forgotten() {
        let mut learnings = Learnings::default();
        for number in 0..=DEVICES_MAX {
            learnings.take(kept(&number.to_string(), learnt(0.01)));
        }
        assert_eq!(learnings.of("0"), Learnt::default());
        assert_eq!(learnings.of("1"), learnt(0.01));
        assert!(Learnings::try_from(StoredLearnings::from(&learnings)).is_ok());
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let mut learnings = Learnings::default();
        learnings.take(kept("a", learnt(0.01)));
        let stored = StoredLearnings::from(&learnings);
        let mut wrong = stored.clone();
        wrong.version = 2;
        let other = OtherVersion::expect(2, 1).expect_err("is another");
        assert_eq!(Learnings::try_from(wrong), Err(LearntError::Version(other)));
        let mut wrong = stored.clone();
        wrong.devices[0].gyro.as_mut().expect("is kept").scale = 0.5;
        assert_eq!(Learnings::try_from(wrong), Err(LearntError::Gyro("a".to_owned())));
        let mut wrong = stored.clone();
        wrong.devices[0].energy.as_mut().expect("is kept").driving_per_s = -1.0;
        assert_eq!(
            Learnings::try_from(wrong),
            Err(LearntError::Energy("a".to_owned()))
        );
        let mut wrong = stored;
        wrong.devices = vec![wrong.devices[0].clone(); DEVICES_MAX + 1];
        assert_eq!(
            Learnings::try_from(wrong),
            Err(LearntError::Devices(DEVICES_MAX + 1))
        );
    }

    #[test]
    fn people_are_told_what_it_begins_with() {
        assert_eq!(summary(&Learnt::default()), None);
        let text = summary(&learnt(0.012)).expect("something was learnt");
        assert!(text.contains("+1.20 %") && text.contains("100 %"), "{text}");
    }
}
