//! The compared modes.

use brain::command::StrategyName;
use rvac_sim::run::RunEnd;
use serde::Serialize;

/// A cleaning pattern, and the robot's knowledge of the home.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum CleaningMode {
    Bounce,
    BeaconBounce,
    KnownMap,
    OldMap,
    FirstRun,
    LearntMap,
    PerfectPose,
}

/// A mode, and the seed of all that is random in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeededMode {
    pub(crate) mode: CleaningMode,
    pub(crate) seed: u64,
}

impl CleaningMode {
    const ALL: [Self; 7] = [
        Self::Bounce,
        Self::BeaconBounce,
        Self::KnownMap,
        Self::OldMap,
        Self::FirstRun,
        Self::LearntMap,
        Self::PerfectPose,
    ];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Bounce => "bounce",
            Self::BeaconBounce => "beacon-bounce",
            Self::KnownMap => "known-map",
            Self::OldMap => "old-map",
            Self::FirstRun => "first-run",
            Self::LearntMap => "learnt-map",
            Self::PerfectPose => "perfect-pose",
        }
    }

    pub(crate) fn list(text: &str) -> anyhow::Result<Vec<Self>> {
        let named = |name: &str| Self::ALL.into_iter().find(|mode| mode.name() == name);
        text.split(',')
            .map(|name| named(name.trim()).ok_or_else(|| anyhow::anyhow!("there is no mode `{name}`")))
            .collect()
    }

    pub(crate) const fn strategy(self) -> StrategyName {
        match self {
            Self::Bounce | Self::BeaconBounce => StrategyName::Bounce,
            Self::KnownMap | Self::OldMap | Self::FirstRun | Self::LearntMap | Self::PerfectPose => {
                StrategyName::Systematic
            }
        }
    }

    /// Whether it hears the radio beacons of the home, if there are any: bounce by wheels alone is what they are measured against.
    pub(crate) const fn listens(self) -> bool {
        !matches!(self, Self::Bounce)
    }

    /// Bounce never ends by itself, so a run is over when 95 % are swept.
    pub(crate) const fn end(self) -> RunEnd {
        match self {
            Self::Bounce | Self::BeaconBounce => RunEnd::Covered,
            Self::KnownMap | Self::OldMap | Self::FirstRun | Self::LearntMap | Self::PerfectPose => {
                RunEnd::JobOver
            }
        }
    }

    /// So many runs follow each other in the same home, each with the map that the run before saved.
    pub(crate) const fn rounds(self) -> u32 {
        match self {
            Self::LearntMap => 3,
            Self::Bounce
            | Self::BeaconBounce
            | Self::KnownMap
            | Self::OldMap
            | Self::FirstRun
            | Self::PerfectPose => 1,
        }
    }
}
