//! The recorded form of a brain's state.

use brain::geometry::{Point2, Pose2};
use brain::mapping::{Cell, Hazard, HazardKind, PathPoint, SweptRun};
use brain::{
    Checkpoint, CleaningOrder, EnergyModel, GyroLearnt, JobCheckpoint, JobFigures, JobKind, MapDoubt,
    StrategyName, TrackingCheckpoint,
};
use serde::{Deserialize, Serialize};
use vthal_core::stored_map;

use super::order::GivenOrder;

/// [`Checkpoint`]
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct BrainState {
    pose: [f64; 3],
    random_state: u64,
    /// Absent in states of earlier versions.
    #[serde(default)]
    backed_m: f64,
    job: Option<JobState>,
    /// x, y and length of each run.
    swept: Vec<(i32, i32, u32)>,
    path_mm: Vec<(i32, i32)>,
    /// x, y and whether it was a contact.
    marks: Vec<(f64, f64, bool)>,
    /// The bytes of the home's map, in hexadecimal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    home: Option<String>,
    /// Deviations of place and heading, whether lost (not 0), scale and bias of the gyro.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tracking: Option<[f64; 5]>,
    /// Beams until the place counts as confirmed; absent = none.
    #[serde(default, skip_serializing_if = "is_zero")]
    unconfirmed_beams: u32,
    /// Scale of the gyro, its deviation, and bias, as learnt; absent = nothing worth keeping, or in states of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    gyro: Option<[f64; 3]>,
    /// Shares of the charge that a second of cleaning and of driving takes, and the seconds from which that was learnt.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    energy: Option<[f64; 3]>,
    /// Why the map of the home is doubted; absent = it is not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    map_doubt: Option<String>,
}

fn is_zero(value: &u32) -> bool {
    *value == 0
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct JobState {
    kind: JobName,
    /// Absent: the whole home, once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    order: Option<GivenOrder>,
    time_s: f64,
    swept_m2: f64,
    path_m: f64,
    bumps: u32,
    running: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    goes_on: Option<JobName>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum JobName {
    Clean(String),
    Spot,
    GoTo,
    Dock,
}

impl From<&Checkpoint> for BrainState {
    fn from(checkpoint: &Checkpoint) -> Self {
        let Pose2 {
            x_m,
            y_m,
            heading_rad,
        } = checkpoint.pose;
        Self {
            pose: [x_m, y_m, heading_rad],
            random_state: checkpoint.random_state,
            backed_m: checkpoint.backed_m,
            job: checkpoint.job.as_ref().map(JobState::from),
            swept: checkpoint
                .swept
                .iter()
                .map(|run| (run.start.x, run.start.y, run.length))
                .collect(),
            path_mm: checkpoint
                .path
                .iter()
                .map(|point| (point.x_mm, point.y_mm))
                .collect(),
            marks: checkpoint
                .hazards
                .iter()
                .map(|mark| (mark.at.x_m, mark.at.y_m, mark.kind == HazardKind::Contact))
                .collect(),
            home: checkpoint
                .home
                .as_ref()
                .map(|home| to_hex(&stored_map::encode(home))),
            tracking: checkpoint.tracking.map(|tracking| {
                let lost = f64::from(u8::from(tracking.lost));
                let (scale, bias) = (tracking.gyro_scale, tracking.gyro_bias_rad_per_s);
                [tracking.sigma_m, tracking.sigma_rad, lost, scale, bias]
            }),
            unconfirmed_beams: checkpoint
                .tracking
                .map_or(0, |tracking| tracking.unconfirmed_beams),
            gyro: checkpoint
                .gyro
                .map(|gyro| [gyro.scale, gyro.scale_sigma, gyro.bias_rad_per_s]),
            energy: Some(checkpoint.energy)
                .filter(|energy| energy.seen_s > 0.0)
                .map(|energy| [energy.cleaning_per_s, energy.driving_per_s, energy.seen_s]),
            map_doubt: checkpoint.map_doubt.map(|doubt| doubt.name().to_owned()),
        }
    }
}

impl BrainState {
    /// Back to the brain's own type; `None` if it names something that this version does not know.
    #[must_use]
    pub fn to_brain(&self) -> Option<Checkpoint> {
        let [x_m, y_m, heading_rad] = self.pose;
        let job = match &self.job {
            None => None,
            Some(job) => Some(job.to_brain()?),
        };
        let home = match &self.home {
            None => None,
            Some(text) => Some(stored_map::decode(&from_hex(text)?).ok()?),
        };
        Some(Checkpoint {
            map_doubt: to_doubt(self.map_doubt.as_deref())?,
            pose: Pose2 {
                x_m,
                y_m,
                heading_rad,
            },
            random_state: self.random_state,
            backed_m: self.backed_m,
            job,
            swept: self
                .swept
                .iter()
                .map(|&(x, y, length)| SweptRun {
                    start: Cell { x, y },
                    length,
                })
                .collect(),
            path: self
                .path_mm
                .iter()
                .map(|&(x_mm, y_mm)| PathPoint { x_mm, y_mm })
                .collect(),
            hazards: self
                .marks
                .iter()
                .map(|&(x_m, y_m, contact)| to_mark(x_m, y_m, contact))
                .collect(),
            home,
            tracking: self
                .tracking
                .map(|[sigma_m, sigma_rad, lost, scale, bias]| TrackingCheckpoint {
                    sigma_m,
                    sigma_rad,
                    lost: lost != 0.0,
                    gyro_scale: scale,
                    gyro_bias_rad_per_s: bias,
                    unconfirmed_beams: self.unconfirmed_beams,
                }),
            gyro: self.gyro.and_then(|[scale, scale_sigma, bias_rad_per_s]| {
                GyroLearnt {
                    scale,
                    scale_sigma,
                    bias_rad_per_s,
                }
                .checked()
            }),
            energy: self.energy.map_or_else(
                EnergyModel::default,
                |[cleaning_per_s, driving_per_s, seen_s]| {
                    EnergyModel {
                        cleaning_per_s,
                        driving_per_s,
                        seen_s,
                    }
                    .checked()
                },
            ),
        })
    }
}

/// A doubt by its name; `None` if this version does not know it.
fn to_doubt(name: Option<&str>) -> Option<Option<MapDoubt>> {
    name.map_or(Some(None), |name| MapDoubt::from_name(name).map(Some))
}

fn to_hex(bytes: &[u8]) -> String {
    let digit = |value: u8| char::from_digit(value.into(), 16).unwrap_or_default();
    bytes
        .iter()
        .flat_map(|byte| [digit(byte >> 4), digit(byte & 15)])
        .collect()
}

fn from_hex(text: &str) -> Option<Vec<u8>> {
    let value = |digit: u8| char::from(digit).to_digit(16);
    let pairs = text.as_bytes().chunks(2);
    pairs
        .map(|pair| match *pair {
            [high, low] => u8::try_from(16 * value(high)? + value(low)?).ok(),
            _ => None,
        })
        .collect()
}

fn to_mark(x_m: f64, y_m: f64, contact: bool) -> Hazard {
    let kind = if contact {
        HazardKind::Contact
    } else {
        HazardKind::Cliff
    };
    Hazard {
        at: Point2 { x_m, y_m },
        kind,
    }
}

impl From<&JobCheckpoint> for JobState {
    fn from(job: &JobCheckpoint) -> Self {
        Self {
            kind: JobName::from(job.kind),
            order: (job.order != CleaningOrder::default()).then(|| (&job.order).into()),
            time_s: job.figures.time_s,
            swept_m2: job.figures.swept_m2,
            path_m: job.figures.path_m,
            bumps: job.figures.bumps,
            running: job.running,
            goes_on: job.goes_on.map(JobName::from),
        }
    }
}

impl From<JobKind> for JobName {
    fn from(kind: JobKind) -> Self {
        match kind {
            JobKind::Clean(strategy) => Self::Clean(strategy.name().to_owned()),
            JobKind::Spot => Self::Spot,
            JobKind::GoTo => Self::GoTo,
            JobKind::Dock => Self::Dock,
        }
    }
}

impl JobName {
    fn to_brain(&self) -> Option<JobKind> {
        Some(match self {
            Self::Clean(strategy) => JobKind::Clean(StrategyName::from_name(strategy)?),
            Self::Spot => JobKind::Spot,
            Self::GoTo => JobKind::GoTo,
            Self::Dock => JobKind::Dock,
        })
    }
}

impl JobState {
    fn to_brain(&self) -> Option<JobCheckpoint> {
        let kind = self.kind.to_brain()?;
        let goes_on = match &self.goes_on {
            None => None,
            Some(kind) => Some(kind.to_brain()?),
        };
        let figures = JobFigures {
            time_s: self.time_s,
            swept_m2: self.swept_m2,
            path_m: self.path_m,
            bumps: self.bumps,
        };
        let order = match &self.order {
            Some(order) => order.to_brain()?,
            None => CleaningOrder::default(),
        };
        Some(JobCheckpoint {
            kind,
            order,
            figures,
            running: self.running,
            goes_on,
        })
    }
}

#[cfg(test)]
mod tests {
    use brain::{
        Cell, CellKnowledge, Checkpoint, CleaningOrder, EnergyModel, HomePart, JobCheckpoint, JobFigures,
        JobKind, MapDoubt, Pose2, Raster, StoredMap, StrategyName, TrackingCheckpoint,
    };

    use super::{BrainState, from_hex, to_hex};

    #[test]
    fn the_home_comes_back_and_a_broken_one_is_not_taken_up() {
        let mut knowledge = Raster::filled(Cell { x: -3, y: 8 }, 7, 4, CellKnowledge::Free);
        knowledge.values_mut()[5] = CellKnowledge::Occupied;
        let checkpoint = Checkpoint {
            home: Some(StoredMap::from_raster(&knowledge, Some(Pose2::IDENTITY))),
            tracking: Some(TrackingCheckpoint {
                sigma_m: 0.03,
                lost: true,
                gyro_scale: -0.004,
                unconfirmed_beams: 200,
                ..TrackingCheckpoint::default()
            }),
            job: Some(JobCheckpoint {
                kind: JobKind::Dock,
                order: CleaningOrder::new(vec![HomePart::Room(7)], 2).expect("a good order"),
                figures: JobFigures::default(),
                running: true,
                goes_on: Some(JobKind::Clean(StrategyName::Systematic)),
            }),
            energy: EnergyModel {
                cleaning_per_s: 2e-4,
                driving_per_s: 1e-4,
                seen_s: 300.0,
            },
            map_doubt: Some(MapDoubt::MetNotMapped),
            ..Checkpoint::default()
        };
        let text = serde_json::to_string(&BrainState::from(&checkpoint)).expect("plain");
        let back: BrainState = serde_json::from_str(&text).expect("just written");
        assert_eq!(back.to_brain(), Some(checkpoint));
        let mut broken = back;
        broken.home = broken.home.map(|home| home.replacen("52", "53", 1));
        assert_eq!(broken.to_brain(), None);
    }

    #[test]
    fn hexadecimal_is_read_as_it_was_written_or_not_at_all() {
        assert_eq!(
            from_hex(&to_hex(&[0, 9, 0xAB, 0xFF])),
            Some(vec![0, 9, 0xAB, 0xFF])
        );
        assert_eq!(from_hex("abc"), None);
        assert_eq!(from_hex("0x"), None);
    }
}
