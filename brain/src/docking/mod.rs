//! Return to the dock: by the map to a place in front of it or to where its beams were received, then by the beams. Where
//! neither helps, search.
//!
//! Terms. *Lobe*: half of the space before the dock, filled by one of its two side beams; where both are received is the
//! *centreline* that leads straight in. *Near field*: a weak beam around the dock. A receiver reports the sum of the beams
//! it receives.
//!
//! The task itself never ends as docked. The firmware reports that the contacts carry the dock's voltage, and the state
//! machine above then ends the job. Every phase begins with a decision that names its reason.

mod approach;
mod beam_goals;
mod centreline;
mod dock_search;
mod parameters;
mod roam;
mod scan;
mod tries;

use crate::model::action::Motion;
use crate::model::decision::DecisionKind;
use crate::model::geometry::{Pose2, normalize_rad};
use crate::model::gradual::Gradual;
use crate::model::reason::Reason;
use crate::navigation::{Situation, Task, TaskContext, TaskStatus};
use crate::travel::{PastFloor, Travel, TravelStep, path_length_m};
use approach::{Approach, ApproachStep};
use beam_goals::{FailedPlace, goals};
use dock_search::DockSearch;
use parameters::DOCKING;
use tries::{FailedTries, FailedTry};

/// The task.
#[derive(Debug, Default)]
pub(crate) struct Docking {
    phase: DockingPhase,
    search: DockSearch,
    failed_places: Vec<FailedPlace>,
    back_to_beams: u32,
    approaches: u32,
    failed_tries: FailedTries,
    /// Tries without contact of a robot that did not know where it was.
    unplaced_tries: u32,
    elapsed_s: f64,
    /// Time since it stood before the dock first; `None` before that.
    at_dock_s: Option<f64>,
    /// Time since the way to the dock was blocked first; `None` before that.
    blocked_s: Option<f64>,
    /// Beams are ignored for this long.
    ignore_s: f64,
    /// The map is ignored for this long.
    search_s: f64,
}

#[derive(Debug, Default)]
enum DockingPhase {
    /// No phase is chosen yet.
    #[default]
    Undecided,
    /// By the map, to the dock.
    Travel(Box<Travel>),
    /// By the map, to where a beam was received.
    Back(Box<Travel>),
    /// By the beams.
    Approach(Approach),
    /// Nowhere, for a while: who stands in the way may leave.
    Wait,
    /// To unvisited floor.
    Search,
}

impl Task for Docking {
    fn step(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let time_s = situation.advance.time_s;
        self.elapsed_s += time_s;
        self.at_dock_s = self.at_dock_s.map(|at_dock_s| at_dock_s + time_s);
        self.blocked_s = self.blocked_s.map(|blocked_s| blocked_s + time_s);
        self.ignore_s = (self.ignore_s - time_s).max(0.0);
        self.search_s = (self.search_s - time_s).max(0.0);
        self.search.note(situation);
        if self.elapsed_s > situation.config.dock_budget_s {
            return TaskStatus::Finished(Reason::DockNotFound);
        }
        if !matches!(self.phase, DockingPhase::Approach(_)) {
            self.failed_tries
                .between_tries(self.at_dock_s.unwrap_or_default());
        }
        // A bumper that stays pressed while the robot rests would be taken for stuck (S7).
        if let Some(reason) = self.failed_tries.verdict()
            && situation.is_free()
        {
            return TaskStatus::Finished(reason);
        }
        self.reconsider(situation, context);
        match &mut self.phase {
            DockingPhase::Travel(travel) => {
                let step = travel.step(situation, context);
                self.after_travel(step, situation, context)
            }
            DockingPhase::Back(travel) => {
                let step = travel.step(situation, context);
                self.after_back(step, context)
            }
            DockingPhase::Approach(approach) => {
                let step = approach.step(situation, context);
                let failed = approach.take_failed_try();
                if failed == Some(FailedTry::NoContact) && self.is_other_dock(situation) {
                    return self.leave_other_dock(situation, context);
                }
                if let Some(failed) = failed {
                    self.count_failed(failed, situation);
                }
                self.after_approach(step, situation, context)
            }
            DockingPhase::Search => self.search.step(situation, context),
            DockingPhase::Undecided | DockingPhase::Wait => TaskStatus::Go(Motion::Halt),
        }
    }

    fn interrupted(&mut self) {
        match &mut self.phase {
            DockingPhase::Travel(travel) | DockingPhase::Back(travel) => travel.interrupted(),
            DockingPhase::Search => self.search.interrupted(),
            DockingPhase::Approach(_) | DockingPhase::Undecided | DockingPhase::Wait => {
                self.phase = DockingPhase::Undecided;
            }
        }
    }
}

impl Docking {
    /// Changes the phase when a better one is possible.
    fn reconsider(&mut self, situation: &Situation<'_>, context: &mut TaskContext) {
        let known = known_dock(situation);
        match &self.phase {
            DockingPhase::Approach(_) => {}
            DockingPhase::Wait if self.search_s > 0.0 && situation.is_free() => {}
            DockingPhase::Travel(travel) => {
                if let Err(reason) = known {
                    // What is shut since the map was made lets the robot doubt its place as well.
                    if travel.is_obstructed() {
                        self.count_blocked();
                    }
                    self.begin_search(reason, context);
                }
            }
            DockingPhase::Search if self.search.is_evading() || !situation.is_free() => {}
            DockingPhase::Back(travel) if travel.is_evading() || !situation.is_free() => {}
            DockingPhase::Back(_) | DockingPhase::Search | DockingPhase::Undecided | DockingPhase::Wait => {
                self.choose(known, situation, context)
            }
        }
    }

    fn choose(&mut self, known: Result<Pose2, Reason>, situation: &Situation<'_>, context: &mut TaskContext) {
        let may_travel = self.search_s <= 0.0;
        match known {
            Ok(dock) if may_travel => {
                context.decide(DecisionKind::DockTravel, Reason::DockKnown, 0.0);
                let past = match situation.map.knows_home() && self.failed_tries.was_blocked() {
                    true => PastFloor::Spare,
                    false => PastFloor::Superseded,
                };
                self.phase = DockingPhase::Travel(Box::new(Travel::to_dock(dock, past)));
            }
            _ if situation.beams.current().is_any() && self.ignore_s <= 0.0 => {
                self.begin_approach(Reason::DockBeam, context);
            }
            _ if matches!(self.phase, DockingPhase::Back(_)) => {}
            Err(_) if may_travel && self.begin_back(situation, context) => {}
            _ => {
                if !matches!(self.phase, DockingPhase::Search) {
                    self.begin_search(known.err().unwrap_or(Reason::NoBeam), context);
                }
            }
        }
    }

    /// Drives back to where a beam was received, if there is such a place.
    fn begin_back(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> bool {
        let heard_at = goals(situation.beams, &self.failed_places);
        if heard_at.is_empty() || self.back_to_beams >= DOCKING.back_to_beams_max {
            return false;
        }
        self.back_to_beams += 1;
        context.decide(DecisionKind::DockTravel, Reason::DockHeard, heard_at.len() as f64);
        self.search.interrupted();
        self.phase = DockingPhase::Back(Box::new(Travel::to_beam(heard_at)));
        true
    }

    fn begin_approach(&mut self, reason: Reason, context: &mut TaskContext) {
        context.decide(DecisionKind::Approach, reason, f64::from(self.approaches));
        self.phase = DockingPhase::Approach(Approach::by_beams(self.approaches));
        self.approaches += 1;
    }

    fn begin_search(&mut self, reason: Reason, context: &mut TaskContext) {
        context.decide(DecisionKind::DockSearch, reason, 0.0);
        self.search.interrupted();
        self.phase = DockingPhase::Search;
    }

    fn after_travel(
        &mut self,
        step: TravelStep,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> TaskStatus {
        match step {
            TravelStep::Going(motion) => return TaskStatus::Go(motion),
            TravelStep::Held(reason) => return TaskStatus::Trouble(reason),
            // A person marked the dock on the map: its direction is too rough to drive in by.
            TravelStep::Arrived if situation.map.dock_location().is_reported() => {
                self.begin_approach(Reason::DockKnown, context);
            }
            TravelStep::Arrived => {
                self.at_dock_s.get_or_insert_default();
                let dock_rad = situation.map.dock().map_or(0.0, |dock| dock.heading_rad);
                let bearing_rad = normalize_rad(dock_rad - situation.pose.heading_rad);
                context.decide(DecisionKind::Approach, Reason::DockKnown, bearing_rad);
                self.phase = DockingPhase::Approach(Approach::from_map(bearing_rad));
            }
            TravelStep::Blocked => {
                self.count_blocked();
                self.search_s = DOCKING.search_s;
                // People leave by themselves. A map of a first run that shuts the robot in is not mended by waiting.
                if situation.map.knows_home() && situation.is_free() && !self.failed_tries.is_blocked_evenly()
                {
                    context.decide(DecisionKind::Wait, Reason::WayBlocked, DOCKING.search_s);
                    self.phase = DockingPhase::Wait;
                } else {
                    self.begin_search(Reason::WayBlocked, context);
                }
            }
        }
        TaskStatus::Go(Motion::Halt)
    }

    fn after_back(&mut self, step: TravelStep, context: &mut TaskContext) -> TaskStatus {
        match step {
            TravelStep::Going(motion) => return TaskStatus::Go(motion),
            TravelStep::Held(reason) => return TaskStatus::Trouble(reason),
            TravelStep::Arrived => {
                self.begin_approach(Reason::DockHeard, context);
            }
            TravelStep::Blocked => {
                self.search_s = DOCKING.search_s;
                self.begin_search(Reason::WayBlocked, context);
            }
        }
        TaskStatus::Go(Motion::Halt)
    }

    /// Whether the dock that was touched in vain is left as one of another robot: it stands elsewhere than the dock of the map, or the robot
    /// does not know where it is and has touched it a few times.
    fn is_other_dock(&mut self, situation: &Situation<'_>) -> bool {
        match known_dock(situation) {
            Ok(dock) => dock.position().distance_m(situation.pose.position()) > DOCKING.other_dock_m,
            Err(Reason::PlaceUnknown) => {
                self.unplaced_tries += 1;
                self.unplaced_tries == DOCKING.unplaced_tries_max
            }
            Err(_) => false,
        }
    }

    /// Goes to the dock of the map, or on along the walls until the robot knows where it is.
    fn leave_other_dock(&mut self, situation: &Situation<'_>, context: &mut TaskContext) -> TaskStatus {
        let status = self.after_approach(ApproachStep::Spent, situation, context);
        self.ignore_s = DOCKING.ignore_other_dock_s;
        self.search_s = 0.0;
        status
    }

    fn count_blocked(&mut self) {
        let since_first_s = *self.blocked_s.get_or_insert_default();
        self.failed_tries.count_blocked(since_first_s);
    }

    /// What stands in the way of a robot that searches for a dock of unknown place need not stand before the dock, and the dock that it
    /// touches first without knowing where it is need not be its own.
    fn count_failed(&mut self, failed: FailedTry, situation: &Situation<'_>) {
        let counts = match known_dock(situation) {
            Ok(_) => true,
            Err(Reason::PlaceUnknown) if self.unplaced_tries <= DOCKING.unplaced_tries_max => false,
            Err(_) => failed == FailedTry::NoContact,
        };
        if counts {
            self.failed_tries.count(failed);
            self.failed_tries
                .between_tries(self.at_dock_s.unwrap_or_default());
        }
    }

    fn after_approach(
        &mut self,
        step: ApproachStep,
        situation: &Situation<'_>,
        context: &mut TaskContext,
    ) -> TaskStatus {
        let reason = match step {
            ApproachStep::Going(motion) => return TaskStatus::Go(motion),
            ApproachStep::Held(reason) => {
                self.phase = DockingPhase::Undecided;
                return TaskStatus::Trouble(reason);
            }
            ApproachStep::Silent => Reason::NoBeam,
            ApproachStep::Spent => Reason::DockMissed,
        };
        self.failed_places.push(FailedPlace {
            at: situation.pose.position(),
            within_m: if reason == Reason::NoBeam {
                DOCKING.silent_radius_m
            } else {
                DOCKING.missed_radius_m
            },
            time_us: situation.observation.time_us,
        });
        let known = known_dock(situation);
        if reason == Reason::NoBeam && known.is_ok() {
            self.failed_tries.count_silent(self.blocked_s);
        }
        self.ignore_s = DOCKING.ignore_beams_s;
        self.search_s = match (reason, known) {
            (Reason::NoBeam, Ok(_)) => DOCKING.search_s,
            (Reason::NoBeam, Err(_)) => 0.0,
            _ => DOCKING.ignore_beams_s,
        };
        self.begin_search(reason, context);
        TaskStatus::Go(Motion::Halt)
    }
}

/// Starts the computation of the length of the path to the dock by the map, metres; `None` when the dock's place is not
/// known.
pub(crate) fn path_home_m(situation: &Situation<'_>) -> Option<Gradual<Option<f64>>> {
    let dock = known_dock(situation).ok()?;
    Some(path_length_m(dock, situation))
}

/// Pose of a docked robot, if the robot is localized and the dock is on the map.
fn known_dock(situation: &Situation<'_>) -> Result<Pose2, Reason> {
    let estimate = situation.estimate;
    let dock = situation.map.dock().ok_or(Reason::DockUnknown)?;
    if !estimate.is_sure() {
        return Err(Reason::PlaceUnknown);
    }
    Ok(dock)
}
