//! What the clock on the wall starts.

use rvac_api::RunAsker;

use super::Core;
use crate::Outputs;
use crate::brain_session::BrainSession;
use crate::desk::readiness::Readiness;
use crate::desk::schedules::Decided;
use crate::refusal::Refused;
use crate::schedule::{Entry, Outcome, Verdict, ZoneReading};

impl Core {
    /// The clock on the wall shows this.
    pub(super) fn set_clock(&mut self, now_us: u64, utc_s: i64, outputs: &mut Outputs) {
        let readiness = Readiness::new(self.start_facts(), self.brain_session.as_ref(), &self.floors);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.history.set_clock(utc_s, &mut teller);
        self.schedules.set_clock(utc_s, &readiness, &mut teller);
    }

    /// The system says its time zone.
    pub(super) fn set_system_zone(&mut self, now_us: u64, reading: ZoneReading, outputs: &mut Outputs) {
        let readiness = Readiness::new(self.start_facts(), self.brain_session.as_ref(), &self.floors);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.system_zone
            .take(reading, (&mut self.schedules, &readiness), &mut teller);
    }

    /// The disk is free for the next change of schedules; a decision on the disk may now be given to the robot.
    pub(super) fn go_on_with_schedules(
        &mut self,
        now_us: u64,
        decision: Option<Verdict>,
        outputs: &mut Outputs,
    ) {
        if let Some(verdict) = decision {
            self.carry_out(now_us, &verdict, outputs);
        }
        let readiness = Readiness::new(self.start_facts(), self.brain_session.as_ref(), &self.floors);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.schedules.go_on(&readiness, &mut teller);
    }

    fn carry_out(&mut self, now_us: u64, verdict: &Verdict, outputs: &mut Outputs) {
        let Ok(entry) = self.schedules.entry(verdict.entry).cloned() else {
            return;
        };
        let mut outcome = verdict.outcome.clone();
        if outcome == Outcome::Starting {
            outcome = match self.start_scheduled(now_us, &entry, outputs) {
                Ok(()) => Outcome::Fired,
                Err(reason) => Outcome::Refused(reason.to_owned()),
            };
        }
        let decided = Decided {
            verdict,
            entry: &entry,
            outcome,
        };
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.schedules.note(decided, &mut teller);
    }

    fn start_scheduled(&mut self, now_us: u64, entry: &Entry, outputs: &mut Outputs) -> Result<(), Refused> {
        let command = self.readiness().scheduled_command(entry)?;
        let (number, name) = (entry.number(), entry.plan().name.clone());
        let at_home = self.brain_session.as_ref().map(BrainSession::at_home);
        self.history
            .order(RunAsker::Schedule { number, name }, &command, at_home);
        self.command_brain(now_us, command.into(), outputs);
        Ok(())
    }
}
