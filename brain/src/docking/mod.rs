//! Home to the dock: by the map to a place in front of it, then in by its beams; where neither helps, search.
//!
//! Terms. *Lobe*: half of the space before the dock, filled by one of its two side beams; where both are heard is the
//! line that leads straight in. *Near field*: a weak beam around the dock. A receiver reports the sum of what it hears.
//!
//! The task never ends docked by its own word: that the contacts carry the dock's voltage is the firmware's to say, and the
//! state machine above ends the job then. Every phase begins with a decision that names why.

mod approach;
mod hearing;
mod scan;
mod search;
mod travel;

use crate::action::Motion;
use crate::behavior::Reason;
use crate::geometry::{Pose2, normalize_rad};
use crate::task::{Mind, Plan, Situation, Task};
use approach::{Approach, ApproachStep};
use hearing::Hearing;
use search::Search;
use travel::{Travel, TravelStep};

/// A pose that is no surer than this leads nowhere, metres.
const SURE_M: f64 = 0.8;
/// How long beams are left alone after an approach that failed: elsewhere the next one may be better.
const IGNORE_S: f64 = 15.0;
/// How long a robot that knows the way searches by chance after the way was blocked or led to silence.
const SEARCH_S: f64 = 40.0;

/// The task.
#[derive(Debug, Default)]
pub(crate) struct Docking {
    hearing: Hearing,
    phase: Phase,
    search: Search,
    elapsed_s: f64,
    /// Beams are left alone for so long.
    ignore_s: f64,
    /// The map is left alone for so long.
    search_s: f64,
}

#[derive(Debug, Default)]
enum Phase {
    /// About to decide.
    #[default]
    Undecided,
    /// By the map.
    Travel(Box<Travel>),
    /// By the beams.
    Approach(Approach),
    /// To where it has not been yet.
    Search,
}

impl Task for Docking {
    fn step(&mut self, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        let time_s = situation.advance.time_s;
        self.elapsed_s += time_s;
        self.ignore_s = (self.ignore_s - time_s).max(0.0);
        self.search_s = (self.search_s - time_s).max(0.0);
        self.hearing.take(&situation.observation.dock_beams);
        self.search.note(situation);
        if self.elapsed_s > situation.config.dock_budget_s {
            return Plan::Finished(Reason::DockNotFound);
        }
        self.reconsider(situation, mind);
        match &mut self.phase {
            Phase::Travel(travel) => {
                let step = travel.step(situation, mind);
                self.after_travel(step, situation, mind)
            }
            Phase::Approach(approach) => {
                let step = approach.step(&self.hearing, (situation, &mut *mind));
                self.after_approach(step, mind)
            }
            Phase::Search => self.search.step(situation, mind),
            Phase::Undecided => Plan::Go(Motion::Halt),
        }
    }

    fn interrupted(&mut self) {
        match &mut self.phase {
            Phase::Travel(travel) => travel.interrupted(),
            Phase::Search => self.search.interrupted(),
            Phase::Approach(_) | Phase::Undecided => self.phase = Phase::Undecided,
        }
    }
}

impl Docking {
    /// Changes the phase where something better has come up.
    fn reconsider(&mut self, situation: &Situation<'_>, mind: &mut Mind) {
        let known = known_dock(situation);
        match &self.phase {
            Phase::Approach(_) => {}
            Phase::Travel(_) => {
                if let Err(reason) = known {
                    self.begin_search(reason, mind);
                }
            }
            Phase::Search if self.search.is_evading() || !situation.is_free() => {}
            Phase::Search | Phase::Undecided => self.choose(known, mind),
        }
    }

    fn choose(&mut self, known: Result<Pose2, Reason>, mind: &mut Mind) {
        let may_travel = self.search_s <= 0.0;
        match known {
            Ok(dock) if may_travel => {
                mind.decide("dock-travel", Reason::DockKnown, 0.0);
                self.phase = Phase::Travel(Box::new(Travel::to(dock)));
            }
            _ if self.hearing.is_any() && self.ignore_s <= 0.0 => {
                mind.decide("approach", Reason::DockBeam, 0.0);
                self.phase = Phase::Approach(Approach::by_beams());
            }
            _ => {
                if !matches!(self.phase, Phase::Search) {
                    self.begin_search(known.err().unwrap_or(Reason::NoBeam), mind);
                }
            }
        }
    }

    fn begin_search(&mut self, reason: Reason, mind: &mut Mind) {
        mind.decide("dock-search", reason, 0.0);
        self.search.interrupted();
        self.phase = Phase::Search;
    }

    fn after_travel(&mut self, step: TravelStep, situation: &Situation<'_>, mind: &mut Mind) -> Plan {
        match step {
            TravelStep::Going(motion) => return Plan::Go(motion),
            TravelStep::Held(reason) => return Plan::Trouble(reason),
            TravelStep::Arrived => {
                let dock_rad = situation.map.dock().map_or(0.0, |dock| dock.heading_rad);
                let bearing_rad = normalize_rad(dock_rad - situation.pose.heading_rad);
                mind.decide("approach", Reason::DockKnown, bearing_rad);
                self.phase = Phase::Approach(Approach::from_map(bearing_rad));
            }
            TravelStep::Blocked => {
                self.search_s = SEARCH_S;
                self.begin_search(Reason::WayBlocked, mind);
            }
        }
        Plan::Go(Motion::Halt)
    }

    fn after_approach(&mut self, step: ApproachStep, mind: &mut Mind) -> Plan {
        let reason = match step {
            ApproachStep::Going(motion) => return Plan::Go(motion),
            ApproachStep::Held(reason) => {
                self.phase = Phase::Undecided;
                return Plan::Trouble(reason);
            }
            ApproachStep::Silent => Reason::NoBeam,
            ApproachStep::Spent => Reason::DockMissed,
        };
        self.ignore_s = IGNORE_S;
        self.search_s = if reason == Reason::NoBeam {
            SEARCH_S
        } else {
            IGNORE_S
        };
        self.begin_search(reason, mind);
        Plan::Go(Motion::Halt)
    }
}

/// Length of the way to the dock by the map in metres; `None` when it is not known.
pub(crate) fn way_home_m(situation: &Situation<'_>) -> Option<f64> {
    let dock = known_dock(situation).ok()?;
    travel::way_m(dock, situation)
}

/// Pose of a robot on the dock, for one that knows its own place too.
fn known_dock(situation: &Situation<'_>) -> Result<Pose2, Reason> {
    let estimate = situation.estimate;
    let dock = situation.map.dock().ok_or(Reason::DockUnknown)?;
    if estimate.lost || estimate.sigma_m > SURE_M {
        return Err(Reason::PlaceUnknown);
    }
    Ok(dock)
}
