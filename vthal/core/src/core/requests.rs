//! What clients ask, routed to the desks that do it.

use brain::JobCommand;
use rvac_api::{LogLevel, Request, RunAsker, Topic, Update};

use super::Core;
use super::desk_request::{DeskRequest, JobRequest, SessionRequest};
use crate::brain_session::{BrainSession, Recorder};
use crate::desk::arbiter::Source;
use crate::desk::audience::{Asker, Asking};
use crate::desk::history;
use crate::desk::home::HomeEdit;
use crate::desk::jobs::{clean_command, estimable};
use crate::desk::journal::LogSource;
use crate::desk::learnt::{Forgetting, LearntRequest};
use crate::desk::readiness::Readiness;
use crate::desk::reply::Reply;
use crate::desk::schedules::ScheduleRequest;
use crate::desk::sources::Sources;
use crate::refusal::{Refusal, Refused};
use crate::{ClientId, MixOrder, Outputs, RunEnd};

/// Longest name of a client that is kept.
const NAME_MAX: usize = 64;

impl Core {
    pub(super) fn request(
        &mut self,
        now_us: u64,
        (client, request): (ClientId, Request),
        outputs: &mut Outputs,
    ) {
        let id = request.id;
        let asker = Asker { client, id };
        let answer = DeskRequest::of(request.body)
            .and_then(|request| self.serve(now_us, Asking { asker, request }, outputs));
        self.teller(now_us, outputs).answer(asker, answer);
    }

    fn serve(
        &mut self,
        now_us: u64,
        Asking { asker, request }: Asking<DeskRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        match request {
            DeskRequest::Session(request) => self.session(now_us, Asking { asker, request }, outputs),
            DeskRequest::Job(request) => self.job(now_us, Asking { asker, request }, outputs),
            DeskRequest::Hand(request) => self.by_hand(now_us, Asking { asker, request }, outputs),
            DeskRequest::Robot(request) => self.robot(now_us, Asking { asker, request }, outputs),
            DeskRequest::Home(request) => self.edit_home(now_us, Asking { asker, request }, outputs),
            DeskRequest::Learnt(LearntRequest::Show) => {
                let here = self.brain_session.as_ref().map(BrainSession::device);
                Ok(Reply::from(self.learnt.show(asker, here)))
            }
            DeskRequest::Learnt(LearntRequest::Forget(request)) => {
                self.forget_learnt(now_us, Asking { asker, request }, outputs)
            }
            DeskRequest::Health(request) => {
                let fitted = self.link.description().map(|known| known.parts.as_slice());
                let facts = (self.schedules.clock_s(), fitted);
                self.health.serve(&Asking { asker, request }, facts, outputs)
            }
            DeskRequest::Evidence => {
                self.require_robot()?;
                Ok(Reply::from(Update::Evidence {
                    id: asker.id,
                    evidence: self.standstills.evidence(now_us, self.track_m()),
                }))
            }
            DeskRequest::Floors(request) => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                let asking = Asking { asker, request };
                self.floors
                    .serve(asking, self.brain_session.as_mut(), &mut teller)
            }
            DeskRequest::Schedules(request) => {
                self.change_schedules(now_us, Asking { asker, request }, outputs)
            }
            DeskRequest::Runs(task) => Ok(history::ask(asker, task, outputs)),
            DeskRequest::Mixes(task) => {
                let Asker { client, id } = asker;
                outputs.mix_orders.push(MixOrder { client, id, task });
                Ok(Reply::ByShell)
            }
        }
    }

    fn session(
        &mut self,
        now_us: u64,
        Asking { asker, request }: Asking<SessionRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        let client = asker.client;
        match request {
            SessionRequest::Hello(name) => self.hello(now_us, (client, &name), outputs),
            SessionRequest::Watch(topics) => {
                for topic in self.audience.clients.watch(client, &topics) {
                    self.first_view(now_us, (client, topic), outputs);
                }
            }
        }
        Ok(Reply::Done)
    }

    fn hello(&mut self, now_us: u64, (client, name): (ClientId, &str), outputs: &mut Outputs) {
        let letters = name.chars().filter(|letter| !letter.is_control());
        let kept: String = letters.take(NAME_MAX).collect();
        let text = format!("client {} is {kept}", client.0);
        self.audience.clients.rename(client, kept);
        let greeting = self.sources().greeting();
        let mut teller = self.teller(now_us, outputs);
        teller.log(LogLevel::Debug, LogSource::Client, text);
        teller.tell_one(client, greeting);
    }

    /// What a new follower of a topic gets at once.
    fn first_view(&mut self, now_us: u64, (client, topic): (ClientId, Topic), outputs: &mut Outputs) {
        let updates: Vec<Update> = match topic {
            Topic::Log => self.audience.log_lines().cloned().map(Update::Log).collect(),
            Topic::Decisions => {
                let decisions = self.standstills.decisions().cloned();
                decisions.map(Update::Decision).collect()
            }
            Topic::Standstills => {
                let all = self.standstills.standstills().cloned();
                all.map(|told| Update::Standstill(Box::new(told))).collect()
            }
            Topic::Schedules => vec![Update::Schedules(self.schedules())],
            Topic::Inputs => vec![self.inputs.view(now_us)],
            Topic::Map => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                let map = self.feed.first_map(self.brain_session.as_ref(), &mut teller);
                map.into_iter().collect()
            }
            Topic::Home => self.first_home(now_us).into_iter().collect(),
            Topic::Status
            | Topic::Pose
            | Topic::Device
            | Topic::Estimate
            | Topic::PlannedPath
            | Topic::Floors
            | Topic::Packets
            | Topic::Runs
            | Topic::Buttons => self.sources().first(topic, now_us).into_iter().collect(),
        };
        let mut teller = self.teller(now_us, outputs);
        for update in updates {
            teller.tell_one(client, update);
        }
    }

    fn first_home(&mut self, now_us: u64) -> Option<Update> {
        let sources = Sources {
            brain_session: self.brain_session.as_ref(),
            link: &self.link,
            floors: &self.floors,
            driver: None,
            config: &self.config,
            load: self.load,
        };
        self.feed.first_home(&sources, now_us)
    }

    fn job(
        &mut self,
        now_us: u64,
        Asking { asker, request }: Asking<JobRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        // Each request sees what the one before it did, also within one telemetry report.
        if self.brain_session.as_ref().is_some_and(BrainSession::owes_a_step) {
            self.think(now_us, outputs);
        }
        let command = match request {
            JobRequest::Start(name) => {
                let strategy = self.readiness().strategy_named(name.as_deref())?;
                self.admitted(now_us, asker.client, JobCommand::Clean { strategy })?
            }
            JobRequest::Clean(order) => {
                self.require_robot()?;
                let command = clean_command(&order, self.brain_session.as_ref())?;
                self.driver.admit(now_us, Source::Person(asker.client))?;
                command
            }
            JobRequest::Estimate(order) => {
                self.require_robot()?;
                estimable(&order, self.brain_session.as_ref())?;
                self.estimates.ask(asker, order)?;
                return Ok(Reply::InTurn);
            }
            JobRequest::OfSchedule(number) => {
                let command = self.readiness().command_now(self.schedules.entry(number)?)?;
                self.driver.admit(now_us, Source::Person(asker.client))?;
                command
            }
            JobRequest::Spot => self.admitted(now_us, asker.client, JobCommand::Spot)?,
            JobRequest::GoTo(place) => self.admitted(now_us, asker.client, JobCommand::GoTo { place })?,
            JobRequest::Pause => self.admitted(now_us, asker.client, JobCommand::Pause)?,
            JobRequest::Resume => self.admitted(now_us, asker.client, JobCommand::Resume)?,
            JobRequest::Dock => self.admitted(now_us, asker.client, JobCommand::Dock)?,
        };
        let by = RunAsker::Client(self.audience.clients.name(asker.client));
        let at_home = self.brain_session.as_ref().map(BrainSession::at_home);
        self.history.order(by, &command, at_home);
        self.command_brain(now_us, command.into(), outputs);
        Ok(Reply::Done)
    }

    /// A command of a client, if the client may command now and the brain would obey.
    fn admitted(
        &mut self,
        now_us: u64,
        client: ClientId,
        command: JobCommand,
    ) -> Result<JobCommand, Refused> {
        self.require_robot()?;
        self.driver.admit(now_us, Source::Person(client))?;
        self.readiness().admit(&command)?;
        Ok(command)
    }

    fn edit_home(
        &mut self,
        now_us: u64,
        asking: Asking<HomeEdit>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        let (edit, reply) = self
            .home
            .serve(asking, self.brain_session.as_ref(), &mut teller)?;
        self.command_brain(now_us, edit.into(), outputs);
        Ok(reply)
    }

    fn forget_learnt(
        &mut self,
        now_us: u64,
        asking: Asking<Forgetting>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        let here = self.brain_session.as_ref().map(BrainSession::device);
        let is_here = here == Some(&asking.request.device);
        let is_free = |brain_session: &BrainSession| brain_session.rests() && !brain_session.holds_commands();
        if is_here && !self.brain_session.as_ref().is_some_and(is_free) {
            return Err("job-runs".into());
        }
        self.learnt.forget(&asking, here, outputs)?;
        if let Some(brain_session) = self.brain_session.as_mut().filter(|_| is_here) {
            // A recording that is about to end ends before, because a replay would know nothing of this.
            if brain_session.is_recorded() {
                outputs.home = brain_session.home_left();
                let mut recorder = Recorder::new(self.config.recording, outputs);
                brain_session.end_run(now_us, RunEnd::Finished, &mut recorder);
            }
            brain_session.forget(asking.request.parts());
        }
        Ok(Reply::WhenKept)
    }

    fn change_schedules(
        &mut self,
        now_us: u64,
        asking: Asking<ScheduleRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        let readiness = Readiness::new(self.start_facts(), self.brain_session.as_ref(), &self.floors);
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.schedules.serve(asking, &readiness, &mut teller)
    }
}
