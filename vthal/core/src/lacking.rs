//! What a robot cannot do because values of its own were never measured.
//!
//! The firmware reports a part that needs an unknown value as absent. What the robot's description lists and the firmware does not
//! have is therefore not measured yet.

use brain::SensorLayout;

use crate::device::{Description, Level, Part};

/// Something that a robot can do once the values for it are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ability {
    /// Turning the wheels at a commanded speed.
    Drive,
    /// Seeing where there is no floor.
    Cliffs,
    /// Seeing obstacles before it touches them.
    Proximity,
    /// A heading from the robot's own gyro.
    Gyro,
    /// Measuring what the wheels draw.
    WheelCurrents,
    /// Charging its pack, and knowing how full it is.
    Charging,
    /// Finding its dock by the dock's beams.
    DockBeams,
}

impl Ability {
    /// All of them, those first that the robot may not move without.
    pub const ALL: [Self; 7] = [
        Self::Drive,
        Self::Cliffs,
        Self::Proximity,
        Self::Gyro,
        Self::WheelCurrents,
        Self::Charging,
        Self::DockBeams,
    ];

    /// The name in robots' descriptions and for clients.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::Cliffs => "cliffs",
            Self::Proximity => "proximity",
            Self::Gyro => "gyro",
            Self::WheelCurrents => "wheel-currents",
            Self::Charging => "charging",
            Self::DockBeams => "dock-beams",
        }
    }

    /// The ability of exactly this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|ability| ability.name() == name)
    }

    /// Whether the robot may not be moved without it. A robot that should see stairs and does not is not sent off.
    #[must_use]
    pub const fn is_needed_to_move(self) -> bool {
        matches!(self, Self::Drive | Self::Cliffs)
    }

    fn is_reported(self, description: &Description) -> bool {
        match self {
            Self::Drive => description.offers(Level::Motion),
            Self::Cliffs => description.sensors.cliffs > 0,
            Self::Proximity => description.sensors.proximity > 0,
            Self::Gyro => description.has(Part::Gyro),
            Self::WheelCurrents => description.has(Part::Currents),
            Self::Charging => description.has(Part::Charger),
            Self::DockBeams => description.sensors.dock_receivers > 0,
        }
    }
}

/// A value that a person measures, and what needs it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CalibrationValue {
    /// What `rvac calibrate` calls it.
    pub name: String,
    /// What is absent without it.
    pub ability: Ability,
}

/// An ability that a robot lacks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lacking {
    /// Which.
    pub ability: Ability,
    /// Names of the values that it needs. At least one of them is not measured.
    pub values: Vec<String>,
}

/// Everything that a robot of this description lacks, whose sensors and values are these as far as they are known.
pub(crate) fn lacking(
    description: &Description,
    sensors: &SensorLayout,
    values: &[CalibrationValue],
) -> Vec<Lacking> {
    let should_have = |ability: Ability| match ability {
        // Nothing on wheels is of use without it.
        Ability::Drive => true,
        Ability::Cliffs if sensors.cliffs.is_some() => true,
        _ => values.iter().any(|value| value.ability == ability),
    };
    Ability::ALL
        .into_iter()
        .filter(|ability| should_have(*ability) && !ability.is_reported(description))
        .map(|ability| Lacking {
            ability,
            values: values
                .iter()
                .filter(|value| value.ability == ability)
                .map(|value| value.name.clone())
                .collect(),
        })
        .collect()
}

/// A line for the log: what is lacking and how to mend it.
pub(crate) fn in_words(lacking: &[Lacking]) -> String {
    if lacking.is_empty() {
        return "the robot is calibrated: it lacks nothing any more".to_owned();
    }
    let named: Vec<String> = lacking
        .iter()
        .map(|one| match one.values.as_slice() {
            [] => one.ability.name().to_owned(),
            values => format!("{} ({})", one.ability.name(), values.join(", ")),
        })
        .collect();
    format!(
        "the robot is not calibrated, so it lacks: {}; measure the values with rvac calibrate",
        named.join("; ")
    )
}
