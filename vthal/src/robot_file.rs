//! The places of a robot's sensors, read from its description (`robots/*/robot.toml`). The wire reports only how many there
//! are, and a figure of a robot is written once.

use std::path::{Path, PathBuf};

use brain::{BumperLayout, Point2, ProximityLayout, ProximityResponse, SensorLayout};
use serde::Deserialize;
use vthal_core::{Ability, CalibrationValue};

/// Why the sensors are not known.
#[derive(Debug, thiserror::Error)]
pub enum RobotFileError {
    /// The file cannot be read.
    #[error("cannot read the description of the robot {}: {error}; check robot.description, or leave it out", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        error: std::io::Error,
    },
    /// The file is no description of a robot.
    #[error("{} is no description of a robot: {error}", .path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        error: Box<toml::de::Error>,
    },
}

#[derive(Deserialize)]
struct RobotFile {
    body: Body,
    bumper: Option<Bumper>,
    cliffs: Option<Cliffs>,
    proximity: Option<Proximity>,
    #[serde(default)]
    calibration: Vec<Calibration>,
}

#[derive(Deserialize)]
struct Calibration {
    name: String,
    ability: Option<String>,
}

#[derive(Deserialize)]
struct Figure {
    value: f64,
}

#[derive(Deserialize)]
struct Figures {
    values: Vec<f64>,
}

#[derive(Deserialize)]
struct Body {
    radius: Figure,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Bumper {
    half_arc: Figure,
    overlap: Figure,
}

#[derive(Deserialize)]
struct Cliffs {
    x: Figures,
    y: Figures,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Proximity {
    headings: Figures,
    mount_radius: Figure,
    range: Figure,
    half_angle: Figure,
    half_level: Figure,
    near: Option<Figure>,
}

/// What the daemon takes from a robot's description.
#[derive(Debug, Default)]
pub(crate) struct RobotFacts {
    pub(crate) sensors: SensorLayout,
    /// What a person measures on the robot. An ability that a newer file names and this program does not know is left out.
    pub(crate) calibration: Vec<CalibrationValue>,
}

/// What is to be known of the robot that `path` describes.
///
/// # Errors
/// See [`RobotFileError`].
pub(crate) fn load(path: &Path) -> Result<RobotFacts, RobotFileError> {
    let text = kept_file::read_text(path).map_err(|error| RobotFileError::Unreadable {
        path: path.to_owned(),
        error,
    })?;
    let file: RobotFile = toml::from_str(&text).map_err(|error| RobotFileError::Invalid {
        path: path.to_owned(),
        error: Box::new(error),
    })?;
    Ok(RobotFacts {
        sensors: layout(&file),
        calibration: calibration(&file.calibration),
    })
}

fn calibration(values: &[Calibration]) -> Vec<CalibrationValue> {
    let known = values.iter().filter_map(|value| {
        Some(CalibrationValue {
            name: value.name.clone(),
            ability: Ability::from_name(value.ability.as_deref()?)?,
        })
    });
    known.collect()
}

fn layout(file: &RobotFile) -> SensorLayout {
    let nothing = SensorLayout::default();
    SensorLayout {
        proximity: file
            .proximity
            .as_ref()
            .map_or(nothing.proximity, |part| proximity(part, file.body.radius.value)),
        bumper: file.bumper.as_ref().map_or(nothing.bumper, |part| BumperLayout {
            half_arc_rad: part.half_arc.value.to_radians(),
            overlap_rad: part.overlap.value.to_radians(),
        }),
        cliffs: file.cliffs.as_ref().and_then(cliffs),
    }
}

fn proximity(part: &Proximity, radius_m: f64) -> ProximityLayout {
    let mount_m = part.mount_radius.value;
    let headings_rad: Vec<f64> = part
        .headings
        .values
        .iter()
        .map(|degrees| degrees.to_radians())
        .collect();
    let response = ProximityResponse {
        range_m: part.range.value,
        half_angle_rad: part.half_angle.value.to_radians(),
        half_level_m: part.half_level.value,
        skin_m: radius_m - mount_m,
        near_m: part.near.as_ref().map(|near| near.value),
    };
    ProximityLayout::ring(&headings_rad, mount_m, response)
}

/// Places of three cliff sensors; other numbers are not mapped.
fn cliffs(part: &Cliffs) -> Option<[Point2; 3]> {
    let places = part.x.values.iter().zip(&part.y.values);
    SensorLayout::three_cliffs(places.map(|(&x_m, &y_m)| Point2 { x_m, y_m }))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use vthal_core::Ability;

    use super::{RobotFile, RobotFileError, load};

    fn robots() -> PathBuf {
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots")
    }

    #[test]
    fn the_project_s_own_robot_is_understood() {
        let robot = load(&robots().join("samsung-sr8730/robot.toml")).expect("a description");
        let layout = robot.sensors;
        let sensors = layout.proximity.sensors();
        assert_eq!(sensors.len(), 7);
        assert!(
            sensors[0].y_m < -0.1 && sensors[0].x_m.abs() < 1e-9,
            "the right one"
        );
        assert!(
            sensors[3].x_m > 0.1 && sensors[3].heading_rad == 0.0,
            "the front one"
        );
        assert!(layout.proximity.response.range_m > layout.proximity.response.skin_m);
        assert!(layout.cliffs.is_some_and(|places| places[0].y_m > 0.0));
        for ability in Ability::ALL {
            assert!(
                robot.calibration.iter().any(|value| value.ability == ability),
                "{} needs nothing that is measured",
                ability.name()
            );
        }
    }

    #[test]
    fn every_ability_that_a_description_names_is_known() {
        for entry in std::fs::read_dir(robots()).expect("the folder") {
            let path = entry.expect("an entry").path().join("robot.toml");
            let Ok(text) = std::fs::read_to_string(&path) else {
                continue;
            };
            let file: RobotFile = toml::from_str(&text).expect("a description");
            for name in file
                .calibration
                .iter()
                .filter_map(|value| value.ability.as_deref())
            {
                assert!(Ability::from_name(name).is_some(), "{}: {name}", path.display());
            }
        }
    }

    #[test]
    fn what_is_no_description_is_named() {
        assert!(matches!(
            load(&robots().join("nobody.toml")),
            Err(RobotFileError::Unreadable { .. })
        ));
        assert!(matches!(
            load(&robots().join("samsung-sr8730/pinout.toml")),
            Err(RobotFileError::Invalid { .. })
        ));
    }
}
