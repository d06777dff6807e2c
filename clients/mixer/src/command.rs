//! From outputs to what a client asks of the robot.

use crate::{MixState, Mixed, OutputKind, OutputName};

/// How the robot should move, each a share of -1..=1 of what it can.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Axes {
    /// Straight ahead.
    pub forward: f64,
    /// Counter-clockwise.
    pub turn: f64,
}

/// How hard it should clean, each a share of 0..=1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cleaning {
    /// Suction.
    pub suction: f64,
    /// The main brush.
    pub main_brush: f64,
    /// The side brushes.
    pub side_brushes: f64,
}

impl Cleaning {
    /// Everything at full power.
    pub const FULL: Self = Self {
        suction: 1.0,
        main_brush: 1.0,
        side_brushes: 1.0,
    };

    fn is_off(self) -> bool {
        self == Self::default()
    }
}

/// A button that was pressed just now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Press {
    /// Start a job.
    Start,
    /// End it.
    Stop,
    /// Clean a spot.
    Spot,
    /// Go home.
    Dock,
}

/// What a person commands at this moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wish {
    /// The person drives the robot by hand now. Otherwise only presses may be sent.
    pub drives: bool,
    /// How it should move.
    pub axes: Axes,
    /// How hard it should clean.
    pub cleaning: Cleaning,
    /// Buttons that were pressed just now.
    pub presses: Vec<Press>,
}

impl Mixed {
    /// What these outputs ask of a robot.
    #[must_use]
    pub fn wish(&self) -> Wish {
        let value = |name| {
            let output = self.outputs.iter().find(|output| output.name == name);
            output.map_or(0.0, |output| output.value)
        };
        let (left, right) = (value(OutputName::LeftWheel), value(OutputName::RightWheel));
        let axes = Axes {
            forward: (value(OutputName::Forward) + (left + right) / 2.0).clamp(-1.0, 1.0),
            turn: (value(OutputName::Turn) + (right - left) / 2.0).clamp(-1.0, 1.0),
        };
        let cleaning = Cleaning {
            suction: value(OutputName::Suction),
            main_brush: value(OutputName::MainBrush),
            side_brushes: value(OutputName::SideBrushes),
        };
        let drives = match self.state {
            MixState::Live => self.held,
            // Only what is to go on cleaning after a loss; motion is 0 there.
            MixState::Failsafe => !cleaning.is_off(),
        };
        Wish {
            drives,
            axes: if drives { axes } else { Axes::default() },
            cleaning: if drives { cleaning } else { Cleaning::default() },
            presses: self.fired.iter().filter_map(|name| press(*name)).collect(),
        }
    }
}

fn press(name: OutputName) -> Option<Press> {
    match name {
        OutputName::Start => Some(Press::Start),
        OutputName::Stop => Some(Press::Stop),
        OutputName::Spot => Some(Press::Spot),
        OutputName::Dock => Some(Press::Dock),
        other => {
            debug_assert!(
                other.kind() != OutputKind::Button,
                "{other} is a button without a press"
            );
            None
        }
    }
}
