//! A job: its purpose, its task and its figures.

use super::dock_retry::DockRetry;
use super::gyro_rest::GyroRest;
use super::{JobFigures, JobKind};
use crate::behavior::parameters::DEPARTURE;
use crate::coverage;
use crate::coverage::Spot;
use crate::docking::Docking;
use crate::model::geometry::TurnSide;
use crate::model::no_go::NoGo;
use crate::model::order::CleaningOrder;
use crate::model::random::Random;
use crate::model::reason::Reason;
use crate::navigation::{BackOff, Manoeuvre, ManoeuvreSequence, Task, Turn};
use crate::recovery::{CliffWatch, Pen, ProgressWatch, RecoverySequence, SlipWatch};
use crate::travel::Visit;

/// A running or waiting job.
#[derive(Debug)]
pub(super) struct Job {
    pub(super) kind: JobKind,
    /// What of the home a cleaning job cleans.
    pub(super) order: CleaningOrder,
    pub(super) task: Box<dyn Task>,
    pub(super) figures: JobFigures,
    pub(super) recovery: RecoverySequence,
    /// Watches whether it leaves a small area.
    pub(super) pen: Pen,
    pub(super) progress: ProgressWatch,
    pub(super) slip: SlipWatch,
    pub(super) edges: CliffWatch,
    /// Movements that come before the task: an escape, or leaving the dock.
    pub(super) detour: Option<Detour>,
    /// Since when only the wheels tell the heading of a job that draws a map.
    pub(super) without_heading_us: Option<u64>,
    /// Beacons were in range: the job finds its heading by them, and goes on by statistics where it does not.
    pub(super) has_heard_beacons: bool,
    /// When to rest next so that the gyro's bias can be measured.
    pub(super) gyro_rest: GyroRest,
    /// How far the robot moves before it rests for the gyro's bias, metres: it backs off from what it was put down against.
    pub(super) moves_before_rest_m: f64,
    /// Brushes may run: the bumper was released after the job last started (S29).
    pub(super) brushes: bool,
    /// Returning to where it was postponed: brushes stay off over floor that is swept already.
    pub(super) returns: bool,
    pub(super) dock_retry: DockRetry,
    /// Over floor that nobody asked for, on the way to a part of the order, as far as was known last. A robot that was not sure of its
    /// place since it started does not know that anybody asked for the floor under it.
    pub(super) crosses: bool,
    /// The task has ended for this reason while something was touched: the job ends once the robot has backed off.
    pub(super) ending: Option<Reason>,
    /// The home is so large that the usual budget does not do: seconds of motion after which it is looked at again.
    pub(super) extended_to_s: f64,
}

/// Movements that come before the task.
#[derive(Debug)]
pub(super) struct Detour {
    pub(super) sequence: ManoeuvreSequence,
    pub(super) purpose: Purpose,
}

/// What a detour is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Getting unstuck.
    Escape,
    /// Undocking.
    Departure,
}

/// What a job does to the parts that are ordered.
fn task(kind: JobKind, order: &CleaningOrder) -> Box<dyn Task> {
    match kind {
        JobKind::Clean(strategy) => coverage::strategy(strategy, order),
        JobKind::Spot => Box::new(Spot::default()),
        JobKind::GoTo => Box::new(Visit::of(order)),
        JobKind::Dock => Box::new(Docking::default()),
    }
}

impl Job {
    /// For the whole home.
    pub(super) fn new(kind: JobKind, figures: JobFigures) -> Self {
        Self::with_order(kind, CleaningOrder::default(), figures)
    }

    /// For what is ordered.
    pub(super) fn with_order(kind: JobKind, order: CleaningOrder, figures: JobFigures) -> Self {
        Self {
            kind,
            task: task(kind, &order),
            crosses: !order.is_for_whole_home(),
            order,
            figures,
            recovery: RecoverySequence::default(),
            pen: Pen::default(),
            progress: ProgressWatch::default(),
            slip: SlipWatch::default(),
            edges: CliffWatch::default(),
            detour: None,
            without_heading_us: None,
            has_heard_beacons: false,
            gyro_rest: GyroRest::default(),
            moves_before_rest_m: 0.0,
            brushes: false,
            returns: false,
            dock_retry: DockRetry::default(),
            ending: None,
            extended_to_s: 0.0,
        }
    }

    /// Its task begins anew; what the job has cost so far stays.
    pub(super) fn begin_task_anew(&mut self) {
        self.interrupt();
        self.task = task(self.kind, &self.order);
    }

    /// Floor that it keeps out of.
    pub(super) fn avoided(&self) -> &[NoGo] {
        self.order.avoid()
    }

    /// The robot rested or was moved by a person: only the purpose of the job and the recovery attempts so far stay valid.
    pub(super) fn interrupt(&mut self) {
        self.task.interrupted();
        self.progress = ProgressWatch::default();
        self.slip = SlipWatch::default();
        self.detour = None;
        self.ending = None;
        self.brushes = false;
        self.crosses = !self.order.is_for_whole_home();
    }

    /// Floor is forbidden that paths may lead over.
    pub(super) fn discard_plans(&mut self) {
        self.task.interrupted();
    }

    /// A person resumes it: recovery attempts so far do not count any more.
    pub(super) fn reset_recovery(&mut self) {
        self.recovery = RecoverySequence::default();
        self.pen = Pen::default();
    }

    /// The task ends while something is touched. A bumper that stays pressed while the robot rests would be taken for stuck (S7), so the
    /// robot backs off first.
    pub(super) fn back_off_at_the_end(&mut self, reason: Reason) {
        self.ending = Some(reason);
        self.detour = Some(Detour {
            sequence: ManoeuvreSequence::new(vec![Manoeuvre::Back(BackOff::from_contact(
                DEPARTURE.end_back_m,
            ))]),
            purpose: Purpose::Escape,
        });
    }

    pub(super) fn is_departing(&self) -> bool {
        self.detour
            .as_ref()
            .is_some_and(|detour| detour.purpose == Purpose::Departure)
    }

    /// Plans to leave the dock first.
    pub(super) fn depart(&mut self, random: &mut Random) {
        let side = if random.coin() {
            TurnSide::Left
        } else {
            TurnSide::Right
        };
        let turn_rad = side.sign() * random.within(&DEPARTURE.turn_rad);
        let parts = vec![
            Manoeuvre::Back(BackOff::from_dock(DEPARTURE.back_m)),
            Manoeuvre::Turn(Turn::by(turn_rad)),
        ];
        self.detour = Some(Detour {
            sequence: ManoeuvreSequence::new(parts),
            purpose: Purpose::Departure,
        });
    }
}
