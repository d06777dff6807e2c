//! Why the robot stands by itself: told to clients with what it felt and what it tried.

use brain::action::Decision;
use rvac_api::{Evidence, Standstill, Topic, Update, remedy};

use super::Core;
use super::refusal::Refusal;
use crate::diary::sentence;
use crate::newest::Newest;
use crate::observe::currents_a;
use crate::outputs::{Delivery, Recipients};
use crate::scheduler::Asker;
use crate::{Outputs, to_api};

/// Standstills that are kept for clients that come later.
const KEPT: usize = 10;
/// What was tried is told from so long ago on, and so many decisions of it.
const TRIED_S: f64 = 30.0;
const TRIED_MAX: usize = 12;

/// The newest standstills.
pub(super) type Standstills = Newest<Standstill, KEPT>;

/// Whether the robot stops with this decision although nobody told it to.
pub(super) fn is_standstill(decision: &Decision) -> bool {
    let waits = matches!(
        decision.what,
        "state-paused" | "state-stuck" | "state-error" | "state-disconnected"
    );
    let is_told = matches!(decision.reason, "command" | "start-up" | "restored" | "stopped");
    // Without a job, and not because that is done.
    let gave_up = decision.what == "state-idle"
        && !matches!(
            decision.reason,
            "finished" | "released" | "link-restored" | "docked"
        );
    !is_told && (waits || gave_up)
}

impl Core {
    /// What the brain saw in this step.
    pub(super) fn feel(&mut self) {
        let (Some(mind), Some(description)) = (&self.mind, self.description()) else {
            return;
        };
        let currents_a = self.facts.report.as_ref().and_then(currents_a);
        let track_m = description.drive.track_m;
        self.felt.take(mind.observer.observation(), currents_a, track_m);
    }

    /// What the robot felt and tried up to now.
    pub(super) fn evidence(&self, now_us: u64) -> Evidence {
        let Some(track_m) = self.track_m() else {
            return Evidence::default();
        };
        let since_s = to_api::seconds(now_us) - TRIED_S;
        let mut tried: Vec<_> = self
            .diary
            .entries()
            .filter(|entry| entry.t >= since_s && !entry.what.starts_with("state-"))
            .cloned()
            .collect();
        tried.drain(..tried.len().saturating_sub(TRIED_MAX));
        Evidence {
            felt: self.felt.before(now_us, track_m),
            tried,
        }
    }

    /// Tells of a stop that nobody wanted.
    pub(super) fn tell_standstill(&mut self, now_us: u64, decision: &Decision, outputs: &mut Outputs) {
        let evidence = self.evidence(now_us);
        let Some(mind) = &self.mind else { return };
        let estimate = mind.brain().estimate();
        let told = self.standstills.keep(|number| Standstill {
            number,
            t: to_api::seconds(now_us),
            state: decision
                .what
                .strip_prefix("state-")
                .unwrap_or(decision.what)
                .to_owned(),
            reason: decision.reason.to_owned(),
            text: sentence(decision),
            remedy: remedy(decision.reason).to_owned(),
            place: to_api::pose(estimate.pose, now_us),
            lost: estimate.lost,
            evidence,
        });
        if self.clients.any(Topic::Standstills) {
            outputs.deliveries.push(Delivery {
                to: Recipients::Followers(Topic::Standstills),
                update: Update::Standstill(Box::new(told)),
            });
        }
    }

    /// A client asks what the robot has felt.
    pub(super) fn tell_evidence(
        &self,
        now_us: u64,
        (client, id): Asker,
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        self.require_robot()?;
        outputs.deliveries.push(Delivery {
            to: Recipients::One(client),
            update: Update::Evidence {
                id,
                evidence: self.evidence(now_us),
            },
        });
        Ok(())
    }

    fn track_m(&self) -> Option<f64> {
        self.description().map(|description| description.drive.track_m)
    }
}
