//! A job: what it is for, who drives for it, what it has done.

use super::gyro_rest::GyroRest;
use super::second_look::SecondLook;
use super::{JobFigures, JobKind};
use crate::coverage;
use crate::coverage::Spot;
use crate::docking::Docking;
use crate::model::geometry::TurnSide;
use crate::model::no_go::NoGo;
use crate::model::order::CleaningOrder;
use crate::model::random::Random;
use crate::navigation::{BackOff, Manoeuvre, ManoeuvreSequence, Task, Turn};
use crate::recovery::{CliffWatch, Pen, ProgressWatch, RecoverySequence, SlipWatch};

/// Way back from the dock before turning away. No more, because contacts may close without a dock: the ground behind is
/// unknown then.
const DEPART_M: f64 = 0.15;

/// A running or waiting job.
#[derive(Debug)]
pub(super) struct Job {
    pub(super) kind: JobKind,
    /// What of the home a cleaning job cleans.
    pub(super) order: CleaningOrder,
    pub(super) task: Box<dyn Task>,
    pub(super) figures: JobFigures,
    pub(super) ladder: RecoverySequence,
    /// Whether it gets anywhere.
    pub(super) pen: Pen,
    pub(super) progress: ProgressWatch,
    pub(super) slip: SlipWatch,
    pub(super) edges: CliffWatch,
    /// Movements that come before the task: an escape, or leaving the dock.
    pub(super) detour: Option<Detour>,
    /// When to stand still next for the gyro's sake.
    pub(super) gyro_rest: GyroRest,
    /// Brushes may run: the bumper was free since the job last started (S29).
    pub(super) brushes: bool,
    /// On its way back to where it was put off: brushes stay off over floor that was swept before.
    pub(super) returns: bool,
    pub(super) second_look: SecondLook,
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
    /// Coming free.
    Escape,
    /// Leaving the dock.
    Departure,
}

impl Job {
    /// For the whole home.
    pub(super) fn new(kind: JobKind, figures: JobFigures) -> Self {
        Self::with_order((kind, CleaningOrder::default()), figures)
    }

    /// For what is ordered.
    pub(super) fn with_order((kind, order): (JobKind, CleaningOrder), figures: JobFigures) -> Self {
        let task: Box<dyn Task> = match kind {
            JobKind::Clean(strategy) => coverage::strategy(strategy, &order),
            JobKind::Spot => Box::new(Spot::default()),
            JobKind::Dock => Box::new(Docking::default()),
        };
        Self {
            kind,
            order,
            task,
            figures,
            ladder: RecoverySequence::default(),
            pen: Pen::default(),
            progress: ProgressWatch::default(),
            slip: SlipWatch::default(),
            edges: CliffWatch::default(),
            detour: None,
            gyro_rest: GyroRest::default(),
            brushes: false,
            returns: false,
            second_look: SecondLook::default(),
        }
    }

    /// Where it does not go.
    pub(super) fn avoided(&self) -> &[NoGo] {
        self.order.avoid()
    }

    /// The robot stood still or was moved by a person: only the purpose of the job is still true, and what was tried to come
    /// free.
    pub(super) fn interrupt(&mut self) {
        self.task.interrupted();
        self.progress = ProgressWatch::default();
        self.slip = SlipWatch::default();
        self.detour = None;
        self.brushes = false;
    }

    /// A person wants it to go on: what was tried to come free counts no more.
    pub(super) fn encourage(&mut self) {
        self.ladder = RecoverySequence::default();
        self.pen = Pen::default();
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
        let turn_rad = side.sign() * random.between(2.2, 3.1);
        let parts = vec![
            Manoeuvre::Back(BackOff::from_dock(DEPART_M)),
            Manoeuvre::Turn(Turn::by(turn_rad)),
        ];
        self.detour = Some(Detour {
            sequence: ManoeuvreSequence::new(parts),
            purpose: Purpose::Departure,
        });
    }
}
