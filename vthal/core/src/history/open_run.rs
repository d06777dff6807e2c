//! The record of a run while it goes on.

use brain::{Brain, Decision, DecisionKind, JobFigures, JobKind, Reason};
use rvac_api::{Evidence, Run, RunAsker, RunJob, RunPicture, RunRecord, RunRecording, RunStop, remedy};

use super::ending::{Ending, LastWords, asker_name};
use super::follower::{Asked, Moment};
use super::picture::{self, BrainAtHome, Painter};
use crate::diary::sentence;
use crate::to_api;

/// Stops that are kept of a run; further ones are only counted.
const STOPS_MAX: usize = 100;
/// Stops that are stored with their sensor readings, some four kilobytes each.
const EVIDENCE_MAX: usize = 20;

/// A run that goes on, or whose end is so young that the robot might still take it back.
#[derive(Debug)]
pub(super) struct OpenRun {
    record: RunRecord,
    /// Host time at which it began; below 0 if that was before the daemon.
    zero_us: i64,
    /// The first point of the map's path that belongs to it.
    path_from: usize,
    /// Why the job became a return to the dock.
    turned_home: Option<&'static str>,
    /// The present stop: state and reason, and whether it is the newest stop of the record.
    standing: Option<OngoingStop>,
    figures: JobFigures,
    /// Share of the floor that the brain says it has swept.
    covered: Option<f64>,
    /// The map was doubted at some moment.
    is_map_doubted: bool,
    /// Since when the brain has no job any more.
    pub(super) over_us: Option<u64>,
    /// What it drew, if an order has come that will wipe the map.
    picture: Option<RunPicture>,
}

#[derive(Clone, Copy, Debug)]
struct OngoingStop {
    state: &'static str,
    reason: &'static str,
    is_recorded: bool,
}

/// Why a run stops, as its record has it.
struct StopCause<'a> {
    state: &'static str,
    reason: &'static str,
    text: String,
    evidence: &'a Evidence,
}

impl<'a> StopCause<'a> {
    fn of(decision: &Decision, evidence: &'a Evidence) -> Self {
        let kind = decision.kind;
        Self {
            state: kind.state_name().unwrap_or(kind.name()),
            reason: decision.cause.name(),
            text: sentence(decision),
            evidence,
        }
    }
}

impl OpenRun {
    pub(super) fn begin(
        number: u64,
        Asked { by, job }: Asked,
        (moment, start_s): (&Moment<'_>, Option<i64>),
    ) -> Self {
        let path_from = match job {
            RunJob::Dock | RunJob::GoTo => moment.brain.map().snapshot().path.len(),
            RunJob::Clean { .. } | RunJob::Spot => 0,
        };
        let Ending { result, reason, text } = Ending::cut_short();
        let run = Run {
            number,
            job,
            by,
            start_s,
            end_s: None,
            clock_set_s: None,
            duration_s: 0.0,
            moving_s: 0.0,
            swept_m2: 0.0,
            share: None,
            path_m: 0.0,
            bumps: 0,
            charge_start: None,
            charge_end: None,
            result,
            reason,
            text,
            stop_count: 0,
            floor: None,
            map: None,
            recordings: Vec::new(),
        };
        let record = RunRecord {
            run,
            stops: Vec::new(),
            picture: None,
        };
        Self::of(record, (moment.now_us.cast_signed(), path_from))
    }

    /// Goes on with what a daemon before this one had begun.
    pub(super) fn resume(record: RunRecord, now_us: u64) -> Self {
        let before_us = (1e6 * record.run.duration_s) as i64;
        Self::of(record, (now_us.cast_signed() - before_us, 0))
    }

    fn of(record: RunRecord, (zero_us, path_from): (i64, usize)) -> Self {
        Self {
            record,
            zero_us,
            path_from,
            turned_home: None,
            standing: None,
            figures: JobFigures::default(),
            covered: None,
            is_map_doubted: false,
            over_us: None,
            picture: None,
        }
    }

    /// The daemon was away.
    pub(super) fn note_restart(&mut self, now_us: u64, brain: &Brain) {
        let cause = StopCause {
            state: "daemon-ended",
            reason: Reason::Restored.name(),
            text: "vthal stopped without notice, and began anew.".to_owned(),
            evidence: &Evidence::default(),
        };
        self.stop((now_us, brain), cause, None);
    }

    /// The clock on the wall is right for the first time since the run began.
    pub(super) fn learn_clock(&mut self, now_us: u64, utc_s: i64) {
        let so_far_s = self.at_s(now_us).round() as i64;
        self.record.run.start_s.get_or_insert(utc_s - so_far_s);
    }

    /// The clock on the wall was set by so much: the beginning is told by the clock as it is now.
    pub(super) fn set_clock_by(&mut self, seconds: i64) {
        let run = &mut self.record.run;
        run.start_s = run.start_s.map(|start_s| start_s + seconds);
        run.clock_set_s = Some(run.clock_set_s.unwrap_or_default() + seconds);
    }

    pub(super) fn add_recording(&mut self, name: &str) {
        let recordings = &mut self.record.run.recordings;
        if recordings.iter().all(|recording| recording.name != name) {
            recordings.push(RunRecording {
                name: name.to_owned(),
                zero_s: self.zero_us as f64 / 1e6,
                bytes: None,
            });
        }
    }

    /// An order has come that may wipe the map: what the run drew is drawn now.
    pub(super) fn draw(&mut self, at_home: BrainAtHome<'_>, painter: &mut Painter) {
        if self.picture.is_none() {
            self.picture = Some(self.drawn(at_home, painter));
        }
    }

    fn drawn(&self, at_home: BrainAtHome<'_>, painter: &mut Painter) -> RunPicture {
        painter.of_run(at_home, (&self.record.run.job, self.path_from))
    }

    /// Takes in a step of the brain in which the run went on.
    pub(super) fn follow(&mut self, moment: &Moment<'_>, hand: Option<&RunAsker>) {
        self.picture = None;
        self.note_charge(moment.charge);
        let kind = moment.brain.job_kind();
        for decision in moment.decisions {
            self.take(moment, (decision, kind), hand);
        }
        match kind {
            Some(JobKind::Dock) => {}
            Some(JobKind::Clean(_) | JobKind::Spot | JobKind::GoTo) => self.turned_home = None,
            None => {
                self.figures = moment.brain.job();
                if self.over_us.is_none() {
                    self.over_us = Some(moment.now_us);
                    self.end(moment, hand);
                }
                return;
            }
        }
        self.figures = moment.brain.job();
        if self.over_us.take().is_some() {
            self.tell(Ending::cut_short());
        }
    }

    fn note_charge(&mut self, charge: Option<f32>) {
        if let Some(charge) = charge.map(f64::from) {
            let run = &mut self.record.run;
            run.charge_start.get_or_insert(charge);
            run.charge_end = Some(charge);
        }
    }

    fn take(
        &mut self,
        moment: &Moment<'_>,
        (decision, kind): (&Decision, Option<JobKind>),
        hand: Option<&RunAsker>,
    ) {
        let is_job_for_dock = self.record.run.job == RunJob::Dock;
        match decision.kind {
            DecisionKind::StatePaused
            | DecisionKind::StateStuck
            | DecisionKind::StateError
            | DecisionKind::StateDisconnected
            | DecisionKind::StateManual => {
                let cause = StopCause::of(decision, moment.evidence);
                self.stop((moment.now_us, moment.brain), cause, hand);
            }
            // It waits for charge.
            DecisionKind::StateDocked if kind.is_some() => {
                let evidence = Evidence::default();
                let cause = StopCause::of(decision, &evidence);
                self.stop((moment.now_us, moment.brain), cause, hand);
            }
            DecisionKind::StateStarting
            | DecisionKind::StateCleaning
            | DecisionKind::StateSpot
            | DecisionKind::StateGoing => {
                self.go_on(moment.now_us);
            }
            DecisionKind::StateDocking => {
                self.go_on(moment.now_us);
                if !is_job_for_dock && kind == Some(JobKind::Dock) {
                    self.turned_home.get_or_insert(decision.cause.name());
                }
            }
            DecisionKind::Covered if decision.value.is_finite() => {
                self.covered = Some(decision.value.clamp(0.0, 1.0))
            }
            DecisionKind::DoubtMap | DecisionKind::CoveredByMap => self.is_map_doubted = true,
            _ => {}
        }
    }

    fn stop(&mut self, (now_us, brain): (u64, &Brain), cause: StopCause<'_>, hand: Option<&RunAsker>) {
        self.go_on(now_us);
        let StopCause {
            state,
            reason,
            text,
            evidence,
        } = cause;
        self.record.run.stop_count += 1;
        let is_recorded = self.record.stops.len() < STOPS_MAX;
        self.standing = Some(OngoingStop {
            state,
            reason,
            is_recorded,
        });
        let stops = self.record.stops.iter();
        let is_felt = stops.filter(|stop| !stop.evidence.is_empty()).count() < EVIDENCE_MAX;
        if is_recorded {
            let asker = hand.filter(|_| reason == Reason::Command.name());
            let stop = RunStop {
                at_s: self.at_s(now_us),
                lasted_s: None,
                state: state.to_owned(),
                reason: reason.to_owned(),
                text,
                remedy: remedy(reason).to_owned(),
                by: asker.map(asker_name),
                asker: asker.cloned(),
                place: to_api::pose(brain.pose(), now_us),
                evidence: if is_felt {
                    evidence.clone()
                } else {
                    Evidence::default()
                },
            };
            self.record.stops.push(stop);
        }
    }

    /// The stop is over.
    fn go_on(&mut self, now_us: u64) {
        let at_s = self.at_s(now_us);
        if let Some(standing) = self.standing.take()
            && standing.is_recorded
            && let Some(stop) = self.record.stops.last_mut()
        {
            stop.lasted_s = Some((at_s - stop.at_s).max(0.0));
        }
    }

    /// The brain has no job any more.
    fn end(&mut self, moment: &Moment<'_>, hand: Option<&RunAsker>) {
        let mut states = moment
            .decisions
            .iter()
            .filter(|decision| decision.kind.state_name().is_some());
        let reason = states
            .find(|decision| matches!(decision.kind, DecisionKind::StateIdle | DecisionKind::StateDocked))
            .map_or(Reason::Command.name(), |decision| decision.cause.name());
        let trouble = self
            .standing
            .filter(|standing| matches!(standing.state, "stuck" | "error"))
            .map(|standing| standing.reason);
        let ending = Ending::of(LastWords {
            job: &self.record.run.job,
            reason,
            turned_home: self.turned_home,
            trouble,
            by: hand,
        });
        self.tell(ending);
    }

    /// Why the job became a return to the dock, if it did.
    pub(super) fn turned_home(&self) -> Option<&'static str> {
        self.turned_home
    }

    /// Ends it from outside, unless it has ended by itself.
    pub(super) fn end_as(&mut self, now_us: u64, ending: Ending) {
        if self.over_us.is_none() {
            self.over_us = Some(now_us);
            self.tell(ending);
        }
    }

    fn tell(&mut self, Ending { result, reason, text }: Ending) {
        let run = &mut self.record.run;
        (run.result, run.reason, run.text) = (result, reason, text);
    }

    fn at_s(&self, now_us: u64) -> f64 {
        (now_us.cast_signed() - self.zero_us) as f64 / 1e6
    }

    /// The record as it is now, without a picture. A run that is over lasted until then.
    pub(super) fn so_far(&self, now_us: u64, brain: Option<&Brain>) -> RunRecord {
        let mut record = self.record.clone();
        let run = &mut record.run;
        run.duration_s = self.at_s(self.over_us.unwrap_or(now_us));
        run.moving_s = self.figures.time_s;
        run.swept_m2 = self.figures.swept_m2;
        run.path_m = self.figures.path_m;
        run.bumps = self.figures.bumps;
        let floor_m2 = brain.and_then(|brain| picture::floor_m2(brain.map(), &run.job));
        let swept_share = floor_m2.map(|floor_m2| (self.figures.swept_m2 / floor_m2).min(1.0));
        // A share of the floor that a wrong map shows says nothing of the home.
        // A run that goes on after a restart learns of the doubt from the brain alone.
        let is_doubted = self.is_map_doubted || brain.is_some_and(|brain| brain.map_doubt().is_some());
        run.share = self.covered.or(swept_share).filter(|_| !is_doubted);
        record
    }

    /// The whole record.
    pub(super) fn close(
        self,
        now_us: u64,
        (at_home, end_s): (BrainAtHome<'_>, Option<i64>),
        painter: &mut Painter,
    ) -> RunRecord {
        let mut record = self.so_far(now_us, Some(at_home.brain));
        let since_s = self
            .over_us
            .map_or(0, |over_us| now_us.saturating_sub(over_us) / 1_000_000);
        record.run.end_s = end_s.map(|end_s| end_s - since_s.cast_signed());
        record.picture = Some(match self.picture {
            Some(picture) => picture,
            None => self.drawn(at_home, painter),
        });
        record
    }
}
