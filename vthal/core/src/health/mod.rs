//! How worn or dirty parts are: by the loads of their motors, and by hours where nothing can be measured.
//!
//! A person who has cleaned a part says so; the load of the next ten minutes of work is its usual one. From then on the load of the last
//! ten minutes is compared with it.

mod consumable;
mod gauge;
mod stored;

pub use consumable::{AtWork, Before, Consumable, Consumables, PartWork};
pub use gauge::{Gauge, LoadVerdict};
pub use stored::{HealthError, StoredHealth};

/// Pause between two samples, microseconds.
const SAMPLE_US: u64 = 200_000;

/// A part whose motor's current is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// The brush below the robot.
    BrushMain,
    /// The left wheel.
    WheelLeft,
    /// The right wheel.
    WheelRight,
}

impl Component {
    /// All of them, in the order in which they are reported.
    pub const ALL: [Self; 3] = [Self::BrushMain, Self::WheelLeft, Self::WheelRight];

    /// As clients name it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::BrushMain => "brush-main",
            Self::WheelLeft => "wheel-left",
            Self::WheelRight => "wheel-right",
        }
    }

    /// The part of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|component| component.name() == name)
    }

    /// What to do about a part with this verdict, for people.
    #[must_use]
    pub const fn remedy(self, verdict: LoadVerdict) -> Option<&'static str> {
        Some(match (self, verdict) {
            (_, LoadVerdict::Learning | LoadVerdict::Fine) => return None,
            (Self::BrushMain, LoadVerdict::Hard) => {
                "The main brush runs hard: take hair and threads off it and off its bearings."
            }
            (Self::BrushMain, LoadVerdict::Light) => {
                "The main brush runs light: look whether it sits in its place, its belt is whole, and its bristles still reach the floor."
            }
            (Self::WheelLeft, LoadVerdict::Hard) => {
                "The left wheel runs hard: take hair and threads off its axle, and look whether its gears are clean."
            }
            (Self::WheelRight, LoadVerdict::Hard) => {
                "The right wheel runs hard: take hair and threads off its axle, and look whether its gears are clean."
            }
            (Self::WheelLeft, LoadVerdict::Light) => {
                "The left wheel runs light: look whether its tyre is worn or lost, and whether it presses on the floor."
            }
            (Self::WheelRight, LoadVerdict::Light) => {
                "The right wheel runs light: look whether its tyre is worn or lost, and whether it presses on the floor."
            }
        })
    }
}

/// Currents of a moment, as far as they can be compared with others: while the robot cleans, at full power and straight ahead.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Of a monotonic clock.
    pub time_us: u64,
    /// Of the wheels, left and right, amperes.
    pub wheels_a: Option<[f32; 2]>,
    /// Of the main brush, amperes.
    pub brush_a: Option<f32>,
}

/// A part whose verdict has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VerdictChange {
    /// Which.
    pub component: Component,
    /// What its load says now.
    pub verdict: LoadVerdict,
}

/// What came of a sample.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// There is something new to keep.
    pub marked: bool,
    /// What has become hard or light, or fine again.
    pub changes: Vec<VerdictChange>,
}

/// The loads and the hours of all parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Health {
    brush_main: Gauge,
    wheel_left: Gauge,
    wheel_right: Gauge,
    sampled_us: Option<u64>,
    consumables: Consumables,
}

impl Health {
    /// The gauge of a part.
    #[must_use]
    pub const fn gauge(&self, component: Component) -> &Gauge {
        match component {
            Component::BrushMain => &self.brush_main,
            Component::WheelLeft => &self.wheel_left,
            Component::WheelRight => &self.wheel_right,
        }
    }

    const fn gauge_mut(&mut self, component: Component) -> &mut Gauge {
        match component {
            Component::BrushMain => &mut self.brush_main,
            Component::WheelLeft => &mut self.wheel_left,
            Component::WheelRight => &mut self.wheel_right,
        }
    }

    /// Takes in a moment, at most five a second.
    pub fn take(&mut self, load: &Load) -> Taken {
        let mut taken = Taken::default();
        let is_due = |last_us: u64| load.time_us >= last_us.saturating_add(SAMPLE_US);
        if !self.sampled_us.is_none_or(is_due) {
            return taken;
        }
        self.sampled_us = Some(load.time_us);
        let [left_a, right_a] = load.wheels_a.map_or([None; 2], |wheels_a| wheels_a.map(Some));
        for (component, load_a) in Component::ALL.into_iter().zip([load.brush_a, left_a, right_a]) {
            let Some(load_a) = load_a else { continue };
            let gauge = self.gauge_mut(component);
            let before = gauge.verdict;
            taken.marked |= gauge.take(load_a);
            let verdict = gauge.verdict;
            if verdict != before && before != LoadVerdict::Learning {
                taken.changes.push(VerdictChange { component, verdict });
            }
        }
        taken
    }

    /// The hours of work of parts.
    #[must_use]
    pub const fn consumables(&self) -> &Consumables {
        &self.consumables
    }

    /// The same, to count on.
    pub const fn consumables_mut(&mut self) -> &mut Consumables {
        &mut self.consumables
    }

    /// What its load says of a part.
    #[must_use]
    pub const fn verdict(&self, component: Component) -> LoadVerdict {
        self.gauge(component).verdict
    }

    /// Somebody has cleaned or changed the part; gives what was known of it.
    pub fn reset(&mut self, component: Component) -> Gauge {
        core::mem::take(self.gauge_mut(component))
    }

    /// Takes a reset back.
    pub fn put_back(&mut self, component: Component, gauge: Gauge) {
        *self.gauge_mut(component) = gauge;
    }
}
