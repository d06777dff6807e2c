//! What the brain must know of the machine it thinks for.

/// Shape of a round robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Radius of the body in metres.
    pub radius_m: f64,
    /// Width that one pass cleans, in metres.
    pub swath_m: f64,
    /// Distance between the wheels' contact points, in metres.
    pub track_m: f64,
}

/// Speeds of the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Speed at which it cleans, m/s.
    pub cruise_m_per_s: f64,
    /// Highest forward speed, m/s; manual driving may use it.
    pub max_m_per_s: f64,
    /// Highest turn rate, rad/s.
    pub turn_max_rad_per_s: f64,
}

/// Geometry, speeds and budgets. Geometry comes from `robots/*/robot.toml` or from the robot's own description.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrainConfig {
    /// Shape.
    pub body: Body,
    /// Speeds.
    pub speeds: Speeds,
    /// Seconds of motion after which a job ends and the robot looks for its dock (S26).
    pub task_budget_s: f64,
    /// Seconds after which the search for the dock is given up.
    pub dock_budget_s: f64,
    /// Battery charge, 0..1, below which a job ends and the robot looks for its dock.
    pub battery_low: f32,
}

impl BrainConfig {
    /// A configuration with the project's budgets: 120 minutes of cleaning (S26), 20 minutes of dock search, low at 15 %.
    #[must_use]
    pub fn new(body: Body, speeds: Speeds) -> Self {
        Self {
            body,
            speeds,
            task_budget_s: 7200.0,
            dock_budget_s: 1200.0,
            battery_low: 0.15,
        }
    }
}
