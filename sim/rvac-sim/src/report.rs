//! Figures of a run.

use home::Truth;
use serde::Serialize;

use crate::{Figures, HostCost, Robot};

/// The figures of a run, as one JSON object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunReport {
    /// Name of the home.
    pub home: String,
    /// All floor, square metres.
    pub free_area_m2: f64,
    /// Floor that the swath can reach, square metres.
    pub reachable_area_m2: f64,
    /// Share of the reachable floor that was swept, 0..1.
    pub covered: f64,
    /// Lower bound of the time: reachable area / (swath x cruise speed).
    pub t0_s: f64,
    /// True path length.
    pub path_m: f64,
    /// Times the body came into contact with something.
    pub bumps: u32,
    /// Number of times that the robot tried to drive and did not leave its place for half a minute.
    pub stuck: u32,
    /// Number of contacts of the body with a walker or a pet.
    pub foot_contacts: u32,
    /// Longest time for which the wheels went on against one of them, milliseconds.
    pub foot_pushed_max_ms: u32,
    /// Violations of the safety rules.
    pub monitor_violations: u32,
    /// Root mean square distance between believed and true place, ten samples a second; `null` where no host was
    /// watched.
    pub pose_rmse_m: Option<f64>,
    /// Speed of covering, and how well the robot knew its place, where a host was watched.
    #[serde(flatten)]
    pub figures: Option<Box<Figures>>,
    /// Simulated time.
    pub sim_seconds: f64,
    /// Time on the wall.
    pub wall_seconds: f64,
    /// What the host took of a processor; left out unless requested, since it differs from run to run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub host_cost: Option<HostCost>,
}

impl RunReport {
    /// The figures of `robot` up to now, without those that only others know.
    #[must_use]
    pub fn of(robot: &Robot, stuck: &StuckWatch) -> Self {
        let home = robot.world().home();
        let truth = robot.world().truth();
        Self {
            home: home.name().to_owned(),
            free_area_m2: home.free_area_m2(),
            reachable_area_m2: home.reachable_area_m2(),
            covered: truth.swept_share,
            t0_s: home.t0_s(),
            path_m: truth.path_m,
            bumps: truth.contacts,
            stuck: stuck.count,
            foot_contacts: truth.foot_contacts,
            foot_pushed_max_ms: truth.foot_pushed_max_ms,
            monitor_violations: robot.monitor().count(),
            pose_rmse_m: None,
            figures: None,
            sim_seconds: robot.now_ms() as f64 / 1000.0,
            wall_seconds: 0.0,
            host_cost: None,
        }
    }
}

impl std::fmt::Display for RunReport {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(formatter, "home          {}", self.home)?;
        writeln!(
            formatter,
            "floor         {:.1} m2, reachable {:.1} m2",
            self.free_area_m2, self.reachable_area_m2
        )?;
        writeln!(
            formatter,
            "covered       {:.1} % in {:.1} min",
            self.covered * 100.0,
            self.sim_seconds / 60.0
        )?;
        writeln!(
            formatter,
            "lower bound   {:.1} min for all of it",
            self.t0_s / 60.0
        )?;
        writeln!(
            formatter,
            "way           {:.1} m, {} bumps, stuck {} times",
            self.path_m, self.bumps, self.stuck
        )?;
        if let Some(error_m) = self.pose_rmse_m {
            writeln!(formatter, "pose error    {error_m:.3} m (root mean square)")?;
        }
        if let Some(figures) = &self.figures {
            writeln!(formatter, "field         {}", figures.field)?;
            let spent = figures.time_spent;
            writeln!(
                formatter,
                "job's seconds cruise {:.0}, slow {:.0}, arcs {:.0}, turns on the spot {:.0}, back {:.0}, still {:.0}, \
                 contacts {:.0}; again {:.0}",
                spent.cruise_s,
                spent.slow_s,
                spent.arc_s,
                spent.spot_turn_s,
                spent.back_s,
                spent.still_s,
                spent.contact_s,
                spent.again_s
            )?;
        }
        if let Some(cost) = self.host_cost {
            writeln!(
                formatter,
                "host          {:.1} s of a processor, longest step {:.0} us, {} steps over 2 ms",
                cost.processor_s, cost.step_max_us, cost.long_steps
            )?;
        }
        writeln!(formatter, "violations    {}", self.monitor_violations)?;
        write!(
            formatter,
            "time          {:.2} s on the wall, {:.0} times real time",
            self.wall_seconds,
            self.sim_seconds / self.wall_seconds.max(1e-9)
        )
    }
}

/// Detects a robot that tries to drive and makes no progress.
#[derive(Clone, Debug, Default)]
pub struct StuckWatch {
    anchor: Option<home::Pose>,
    driven_ms: u32,
    reported: bool,
    count: u32,
}

/// A robot that leaves this circle is not stuck.
const STUCK_RADIUS_M: f64 = 0.10;
/// Driven for so long within the circle, it is.
const STUCK_MS: u32 = 30_000;

impl StuckWatch {
    /// Takes `elapsed_ms` of the run into account.
    pub fn watch(&mut self, elapsed_ms: u32, truth: &Truth, driven: Driven) {
        let anchor = *self.anchor.get_or_insert(truth.pose);
        if anchor.distance_m(truth.pose) > STUCK_RADIUS_M {
            *self = Self {
                anchor: Some(truth.pose),
                driven_ms: 0,
                reported: false,
                count: self.count,
            };
        } else if driven == Driven::Yes {
            self.driven_ms += elapsed_ms;
        }
        if self.driven_ms > STUCK_MS && !self.reported {
            self.reported = true;
            self.count += 1;
        }
    }

    /// Times a robot was stuck.
    #[must_use]
    pub const fn count(&self) -> u32 {
        self.count
    }
}

/// Whether the wheels are driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driven {
    /// They are.
    Yes,
    /// They are not.
    No,
}

impl Driven {
    /// Of this robot now.
    #[must_use]
    pub fn of(robot: &Robot) -> Self {
        if robot.wheels_driven() {
            Self::Yes
        } else {
            Self::No
        }
    }
}

/// Root mean square of distances.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RootMeanSquare {
    sum: f64,
    samples: u32,
}

impl RootMeanSquare {
    /// Takes one distance.
    pub(crate) fn add(&mut self, distance: f64) {
        self.sum += distance * distance;
        self.samples += 1;
    }

    /// The figure, if there was a sample.
    pub(crate) fn value(&self) -> Option<f64> {
        (self.samples > 0).then(|| (self.sum / f64::from(self.samples)).sqrt())
    }
}
