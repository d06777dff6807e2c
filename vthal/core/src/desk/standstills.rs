//! Decisions of the robot, and why it stopped by itself: clients receive them with the sensor evidence and the attempts before.

use brain::{Decision, DecisionCause, DecisionKind, PoseEstimate, Reason};
use rvac_api::{Evidence, LogLevel, Standstill, Topic, Update, remedy};

use super::audience::Teller;
use super::evidence::{Perceived, Sensations};
use super::journal::LogSource;
use crate::diary::{Diary, sentence};
use crate::newest::Newest;
use crate::{refusal, to_api};

/// Standstills that are kept for clients that come later.
const KEPT: usize = 10;
/// Attempts are reported from this long ago on, and at most this many decisions.
const TRIED_S: f64 = 30.0;
const TRIED_MAX: usize = 12;

/// The newest standstills, decisions and sensations.
#[derive(Debug, Default)]
pub(crate) struct StandstillDesk {
    standstills: Newest<Standstill, KEPT>,
    diary: Diary,
    sensations: Sensations,
}

/// Where a robot stopped.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stand {
    pub(crate) estimate: PoseEstimate,
    /// Between its wheels, once it is known.
    pub(crate) track_m: Option<f64>,
}

/// Whether the robot stops with this decision without an order.
pub(crate) fn is_standstill(decision: &Decision) -> bool {
    let waits = matches!(
        decision.kind,
        DecisionKind::StatePaused
            | DecisionKind::StateStuck
            | DecisionKind::StateError
            | DecisionKind::StateDisconnected
    );
    let DecisionCause::Reason(reason) = decision.cause else {
        return false;
    };
    let is_ordered = matches!(
        reason,
        Reason::Command | Reason::StartUp | Reason::Restored | Reason::Stopped
    );
    // Without a job, and not because that is done.
    let gave_up = decision.kind == DecisionKind::StateIdle
        && !matches!(
            reason,
            Reason::Finished | Reason::Released | Reason::LinkRestored | Reason::Docked
        );
    !is_ordered && (waits || gave_up)
}

impl StandstillDesk {
    /// The standstills that are kept, oldest first.
    pub(crate) fn standstills(&self) -> impl Iterator<Item = &Standstill> {
        self.standstills.entries()
    }

    /// The decisions that are kept, oldest first.
    pub(crate) fn decisions(&self) -> impl Iterator<Item = &rvac_api::Decision> {
        self.diary.entries()
    }

    /// What the robot perceives in this step.
    pub(crate) fn feel(&mut self, perceived: &Perceived<'_>, track_m: f64) {
        self.sensations.take(perceived, track_m);
    }

    /// What the sensors of a robot with this track reported and what it tried up to now; empty while its track is not known.
    pub(crate) fn evidence(&self, now_us: u64, track_m: Option<f64>) -> Evidence {
        let Some(track_m) = track_m else {
            return Evidence::default();
        };
        let since_s = to_api::seconds(now_us) - TRIED_S;
        let mut tried: Vec<_> = self
            .decisions()
            .filter(|entry| entry.t >= since_s && !entry.what.starts_with("state-"))
            .cloned()
            .collect();
        tried.drain(..tried.len().saturating_sub(TRIED_MAX));
        Evidence {
            samples: self.sensations.before(now_us, track_m),
            tried,
        }
    }

    /// Takes in a decision of the brain and reports it.
    pub(crate) fn decided(&mut self, decision: &Decision, teller: &mut Teller<'_>) {
        let is_refusal = decision.kind == DecisionKind::Refuse;
        let is_doubt = decision.kind == DecisionKind::DoubtMap;
        let level = if is_doubt {
            LogLevel::Warn
        } else if is_refusal || decision.kind.state_name().is_some() {
            LogLevel::Info
        } else {
            LogLevel::Debug
        };
        let value = if decision.value == 0.0 {
            String::new()
        } else {
            format!(" {:.2}", decision.value)
        };
        let explanation = if is_doubt || is_refusal || is_standstill(decision) {
            format!(": {}", refusal::text(decision.cause.name()))
        } else {
            String::new()
        };
        let text = format!(
            "{} ({}){value}{explanation}",
            decision.kind.name(),
            decision.cause.name()
        );
        teller.log(level, LogSource::Brain, text);
        let entry = self.diary.write(teller.now_us, decision);
        if teller.has_followers(Topic::Decisions) {
            teller.tell(Topic::Decisions, Update::Decision(entry));
        }
    }

    /// Reports a stop that nobody ordered.
    pub(crate) fn stands(
        &mut self,
        decision: &Decision,
        Stand { estimate, track_m }: Stand,
        teller: &mut Teller<'_>,
    ) {
        let now_us = teller.now_us;
        let evidence = self.evidence(now_us, track_m);
        let standstill = self.standstills.keep(|number| Standstill {
            number,
            t: to_api::seconds(now_us),
            state: decision
                .kind
                .state_name()
                .unwrap_or(decision.kind.name())
                .to_owned(),
            reason: decision.cause.name().to_owned(),
            text: sentence(decision),
            remedy: remedy(decision.cause.name()).to_owned(),
            place: to_api::pose(estimate.pose, now_us),
            lost: estimate.lost,
            evidence,
        });
        if teller.has_followers(Topic::Standstills) {
            teller.tell(Topic::Standstills, Update::Standstill(Box::new(standstill)));
        }
    }
}
