//! What a robot can be commanded to do.

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::Line;

/// The closed set of outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutputName {
    /// Straight ahead, as a share of the highest speed; negative is backwards.
    Forward,
    /// Counter-clockwise, as a share of the highest turn rate.
    Turn,
    /// The left wheel alone, as a share of the highest speed.
    LeftWheel,
    /// The right wheel alone, as a share of the highest speed.
    RightWheel,
    /// Suction, 0..=1.
    Suction,
    /// The main brush, 0..=1.
    MainBrush,
    /// The side brushes, 0..=1.
    SideBrushes,
    /// Starts a job.
    Start,
    /// Ends the job.
    Stop,
    /// Cleans a spot.
    Spot,
    /// Goes home.
    Dock,
}

/// How an output behaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// Moves the robot: a share of -1..=1, whose failsafe is to stand.
    Motion,
    /// Cleans: a share of 0..=1.
    Cleaner,
    /// Fires once when it rises above a half.
    Button,
}

impl OutputName {
    /// All of them, in the order in which lists show them.
    pub const ALL: [Self; 11] = [
        Self::Forward,
        Self::Turn,
        Self::LeftWheel,
        Self::RightWheel,
        Self::Suction,
        Self::MainBrush,
        Self::SideBrushes,
        Self::Start,
        Self::Stop,
        Self::Spot,
        Self::Dock,
    ];

    /// The name in profiles.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Turn => "turn",
            Self::LeftWheel => "left-wheel",
            Self::RightWheel => "right-wheel",
            Self::Suction => "suction",
            Self::MainBrush => "main-brush",
            Self::SideBrushes => "side-brushes",
            Self::Start => "start",
            Self::Stop => "stop",
            Self::Spot => "spot",
            Self::Dock => "dock",
        }
    }

    /// How it behaves.
    #[must_use]
    pub const fn kind(self) -> OutputKind {
        match self {
            Self::Forward | Self::Turn | Self::LeftWheel | Self::RightWheel => OutputKind::Motion,
            Self::Suction | Self::MainBrush | Self::SideBrushes => OutputKind::Cleaner,
            Self::Start | Self::Stop | Self::Spot | Self::Dock => OutputKind::Button,
        }
    }

    /// The part of a robot that it needs, as the robot's description names it; none for what every robot has.
    #[must_use]
    pub const fn part(self) -> Option<&'static str> {
        match self {
            Self::Suction => Some("vacuum"),
            Self::MainBrush => Some("brush-main"),
            Self::SideBrushes => Some("brush-sides"),
            Self::Dock => Some("dock"),
            Self::Forward
            | Self::Turn
            | Self::LeftWheel
            | Self::RightWheel
            | Self::Start
            | Self::Stop
            | Self::Spot => None,
        }
    }
}

impl fmt::Display for OutputName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

/// An output with its lines, from the first to the last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Output {
    /// Which.
    pub output: OutputName,
    /// Value at the lower end of the lines.
    pub low: f64,
    /// Value when the lines make 0.
    #[serde(default)]
    pub centre: f64,
    /// Value at the upper end of the lines.
    pub high: f64,
    /// The lines are turned round.
    #[serde(default)]
    pub reverse: bool,
    /// Value after an input was lost.
    #[serde(default)]
    pub failsafe: f64,
    /// The lines.
    pub lines: Vec<Line>,
}

impl Output {
    /// An output over its whole range, without lines.
    #[must_use]
    pub const fn new(output: OutputName) -> Self {
        let low = match output.kind() {
            OutputKind::Motion => -1.0,
            OutputKind::Cleaner | OutputKind::Button => 0.0,
        };
        Self {
            output,
            low,
            centre: 0.0,
            high: 1.0,
            reverse: false,
            failsafe: 0.0,
            lines: Vec::new(),
        }
    }

    /// The value for what the lines have made, with a trim of the centre.
    pub(crate) fn value(&self, total: f64, trim: f64) -> f64 {
        let centre = (self.centre + trim).clamp(self.low, self.high);
        let share = total.clamp(-1.0, 1.0) * if self.reverse { -1.0 } else { 1.0 };
        let reach = if share < 0.0 {
            centre - self.low
        } else {
            self.high - centre
        };
        (centre + share * reach).clamp(self.low, self.high)
    }
}
