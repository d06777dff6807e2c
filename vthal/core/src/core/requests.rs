//! What clients ask.

use brain::{Command, Inhibit, StrategyName};
use rvac_api::{Failure, LogLevel, Request, RequestBody, RunAsker, Topic, Update};

use super::refusal::Refusal;
use super::{Core, manual};
use crate::arbiter::{Denied, Source, Stick};
use crate::device::{CleanerPower, CommandError, DeviceCommand, DeviceIo, Supervisor, Tone};
use crate::journal::Part;
use crate::outputs::{Delivery, Recipients};
use crate::scheduler::Asker;
use crate::{ClientId, ExpertAccess, MixOrder, MixTask, Outputs};

/// Tones of `locate`: pitch in Hz and length in ms.
const LOCATE_TONES: [(u32, u16); 3] = [(1760, 200), (1320, 200), (1760, 400)];
/// Longest name of a client that is kept.
const NAME_MAX: usize = 64;

/// Why a request is refused, by name.
type Refused = &'static str;

impl Core {
    pub(super) fn request(
        &mut self,
        now_us: u64,
        (client, request): (ClientId, Request),
        outputs: &mut Outputs,
    ) {
        let id = request.id;
        // The shell answers these when the disk has; an estimate is its own answer.
        let is_answered_later = matches!(
            request.body,
            RequestBody::Maps { .. }
                | RequestBody::NewFloor { .. }
                | RequestBody::NameFloor { .. }
                | RequestBody::RemoveFloor { .. }
                | RequestBody::RestoreFloor { .. }
                | RequestBody::RestoreMap { .. }
                | RequestBody::ExportFloors { .. }
                | RequestBody::ImportFloors { .. }
                | RequestBody::Mixes
                | RequestBody::SaveMix { .. }
                | RequestBody::RemoveMix { .. }
                | RequestBody::AddNoGo { .. }
                | RequestBody::RemoveNoGo { .. }
                | RequestBody::NameNoGo { .. }
                | RequestBody::ReshapeNoGo { .. }
                | RequestBody::KeepPlace { .. }
                | RequestBody::NamePlace { .. }
                | RequestBody::ReshapePlace { .. }
                | RequestBody::ForgetPlace { .. }
                | RequestBody::NameRoom(_)
                | RequestBody::SetRoom { .. }
                | RequestBody::SplitRoom(_)
                | RequestBody::JoinRooms { .. }
                | RequestBody::UndoRoomChange { .. }
                | RequestBody::MoveDock { .. }
                | RequestBody::Estimate(_)
                | RequestBody::Evidence
                | RequestBody::Health
                | RequestBody::ResetHealth { .. }
                | RequestBody::Learnt
                | RequestBody::ForgetLearnt { .. }
                | RequestBody::AddSchedule(_)
                | RequestBody::ChangeSchedule { .. }
                | RequestBody::RemoveSchedule { .. }
                | RequestBody::EnableSchedule { .. }
                | RequestBody::SkipNext { .. }
                | RequestBody::SetQuiet { .. }
                | RequestBody::SetZone { .. }
                | RequestBody::Runs { .. }
                | RequestBody::Run { .. }
                | RequestBody::RunTrack { .. }
                | RequestBody::RunFile { .. }
        );
        let result = self.obey(now_us, (client, request), outputs);
        let update = match (result, id) {
            (Ok(()), _) if is_answered_later => return,
            (Ok(()), None) => return,
            (Ok(()), Some(id)) => Update::Done { id },
            (Err(refusal), id) => Update::Failed(Failure {
                id,
                reason: refusal.reason.to_owned(),
                text: refusal.text,
            }),
        };
        outputs.deliveries.push(Delivery {
            to: Recipients::One(client),
            update,
        });
    }

    fn obey(
        &mut self,
        now_us: u64,
        (client, request): (ClientId, Request),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let id = request.id;
        match request.body {
            RequestBody::Hello { name } => self.hello(now_us, (client, name), outputs),
            RequestBody::Watch { topics } => self.watch(now_us, (client, &topics), outputs),
            RequestBody::Start { strategy } => self.start(now_us, (client, strategy.as_deref()), outputs),
            RequestBody::Clean(order) => self.clean(now_us, (client, &order), outputs),
            RequestBody::Estimate(order) => self.estimate((client, id), &order, outputs),
            body @ (RequestBody::Health
            | RequestBody::ResetHealth { .. }
            | RequestBody::Learnt
            | RequestBody::ForgetLearnt { .. }) => self.ask_of_parts(now_us, ((client, id), body), outputs),
            RequestBody::Evidence => self.tell_evidence(now_us, (client, id), outputs),
            body @ (RequestBody::AddNoGo { .. }
            | RequestBody::RemoveNoGo { .. }
            | RequestBody::NameNoGo { .. }
            | RequestBody::ReshapeNoGo { .. }
            | RequestBody::NameRoom(_)
            | RequestBody::SetRoom { .. }
            | RequestBody::SplitRoom(_)
            | RequestBody::JoinRooms { .. }
            | RequestBody::UndoRoomChange { .. }
            | RequestBody::MoveDock { .. }) => self.change_home(now_us, ((client, id), body), outputs),
            body @ (RequestBody::KeepPlace { .. }
            | RequestBody::NamePlace { .. }
            | RequestBody::ReshapePlace { .. }
            | RequestBody::ForgetPlace { .. }) => self.change_places(now_us, ((client, id), body), outputs),
            body @ (RequestBody::Spot | RequestBody::Pause | RequestBody::Resume | RequestBody::Dock) => {
                self.obey_word(now_us, (client, &body), outputs)
            }
            body @ (RequestBody::Stop | RequestBody::Release | RequestBody::ClaimButtons { .. }) => {
                self.obey_always(now_us, (client, &body), outputs);
                Ok(())
            }
            RequestBody::SetInputs { values, ttl } => self.set_inputs(now_us, (client, values, ttl), outputs),
            body @ RequestBody::Drive { .. } => self.drive_by_hand(now_us, (client, &body), outputs),
            RequestBody::Locate => Ok(self.locate(now_us, outputs)?),
            RequestBody::Clear { reason } => Ok(self.clear(now_us, &reason, outputs)?),
            RequestBody::Raw { packet } => Ok(self.raw(now_us, (client, &packet), outputs)?),
            body @ (RequestBody::Maps { .. }
            | RequestBody::RestoreMap { .. }
            | RequestBody::ChooseFloor { .. }
            | RequestBody::NewFloor { .. }
            | RequestBody::NameFloor { .. }
            | RequestBody::RemoveFloor { .. }
            | RequestBody::RestoreFloor { .. }
            | RequestBody::ExportFloors { .. }
            | RequestBody::ImportFloors { .. }) => self.ask_floors(now_us, ((client, id), body), outputs),
            RequestBody::Mixes => order_mix((client, id), MixTask::List, outputs),
            RequestBody::SaveMix { profile } => order_mix((client, id), MixTask::Save(profile), outputs),
            RequestBody::RemoveMix { name } => order_mix((client, id), MixTask::Remove(name), outputs),
            body @ (RequestBody::Runs { .. }
            | RequestBody::Run { .. }
            | RequestBody::RunTrack { .. }
            | RequestBody::RunFile { .. }) => self.ask_of_runs((client, id), &body, outputs),
            RequestBody::RunSchedule { number } => self.run_schedule(now_us, (client, number), outputs),
            body @ (RequestBody::AddSchedule(_)
            | RequestBody::ChangeSchedule { .. }
            | RequestBody::RemoveSchedule { .. }
            | RequestBody::EnableSchedule { .. }
            | RequestBody::SkipNext { .. }
            | RequestBody::SetQuiet { .. }
            | RequestBody::SetZone { .. }) => self.change_schedules(now_us, ((client, id), body), outputs),
        }
    }

    /// How the parts are and what was learnt of them; nothing else comes here.
    fn ask_of_parts(
        &mut self,
        now_us: u64,
        (asker, body): (Asker, RequestBody),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        match body {
            RequestBody::ResetHealth { component } => self.reset_health(asker, &component, outputs),
            RequestBody::Learnt => self.show_learnt(asker, outputs),
            RequestBody::ForgetLearnt { device, part } => {
                self.forget_learnt((now_us, asker), (&device, part), outputs)
            }
            _ => self.tell_health(asker, outputs),
        }
    }

    /// A job by a word; nothing else comes here.
    fn obey_word(
        &mut self,
        now_us: u64,
        (client, body): (ClientId, &RequestBody),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let command = match body {
            RequestBody::Spot => Command::Spot,
            RequestBody::Pause => Command::Pause,
            RequestBody::Resume => Command::Resume,
            _ => Command::Dock,
        };
        Ok(self.job(now_us, (client, command), outputs)?)
    }

    /// A person drives; nothing else comes here.
    fn drive_by_hand(
        &mut self,
        now_us: u64,
        (client, body): (ClientId, &RequestBody),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let &RequestBody::Drive {
            v,
            w,
            ttl,
            clean,
            power,
        } = body
        else {
            return Ok(());
        };
        let (stick, power) = (manual::stick((v, w), ttl), manual::power(clean, power)?);
        Ok(self.drive(now_us, (client, stick, power), outputs)?)
    }

    /// What is never refused; nothing else comes here.
    fn obey_always(&mut self, now_us: u64, (client, body): (ClientId, &RequestBody), outputs: &mut Outputs) {
        match body {
            RequestBody::Stop => self.stop(now_us, client, outputs),
            RequestBody::Release => self.release(now_us, client, outputs),
            RequestBody::ClaimButtons { ms } => self.buttons.claim(now_us, client, *ms),
            _ => {}
        }
    }

    fn start(
        &mut self,
        now_us: u64,
        (client, strategy): (ClientId, Option<&str>),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let strategy = self.strategy_named(strategy)?;
        Ok(self.job(now_us, (client, Command::Clean { strategy }), outputs)?)
    }

    pub(super) fn strategy_named(&self, name: Option<&str>) -> Result<StrategyName, Refused> {
        match name {
            None => Ok(self.usual_strategy()),
            Some(name) => StrategyName::from_name(name).ok_or("unknown-strategy"),
        }
    }

    pub(super) fn require_robot(&self) -> Result<(), Refused> {
        if self.ended {
            return Err("ending");
        }
        let attached = self.device.as_ref().is_some_and(Supervisor::is_attached);
        if attached && self.mind.is_some() {
            Ok(())
        } else {
            Err("no-robot")
        }
    }

    pub(super) fn job(
        &mut self,
        now_us: u64,
        (client, command): (ClientId, Command),
        outputs: &mut Outputs,
    ) -> Result<(), Refused> {
        self.require_robot()?;
        self.arbiter
            .admit(now_us, Source::Person(client))
            .map_err(denied)?;
        self.admitted(&command)?;
        let name = self.clients.name(client);
        self.order_run(RunAsker::Client(name), &command);
        self.command_brain(now_us, command, outputs);
        Ok(())
    }

    pub(super) fn admitted(&self, command: &Command) -> Result<(), Refused> {
        let mind = self.mind.as_ref().ok_or("no-robot")?;
        mind.admit(command).map_err(brain::Reason::name)
    }

    /// Anybody may stop at any time; the wheels do not wait for the brain.
    fn stop(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        self.arbiter.preempt();
        let by = RunAsker::Client(self.clients.name(client));
        self.runs.commanded_by(by);
        self.device_command(now_us, DeviceCommand::EmergencyStop, outputs);
        self.command_brain(now_us, Command::Stop, outputs);
        let text = format!("stopped by {}", self.clients.name(client));
        self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
    }

    fn drive(
        &mut self,
        now_us: u64,
        (client, stick, power): (ClientId, Stick, CleanerPower),
        outputs: &mut Outputs,
    ) -> Result<(), Refused> {
        self.require_robot()?;
        self.check_range(&stick)?;
        let command = |valid_until_us| Command::Manual {
            speed_m_per_s: stick.speed_m_per_s,
            turn_rad_per_s: stick.turn_rad_per_s,
            valid_until_us,
            cleaners: power != CleanerPower::NONE,
        };
        self.admitted(&command(now_us + stick.lease_us))?;
        let was_driver = self.arbiter.driver() == Some(client);
        let valid_until_us = self.arbiter.drive(now_us, client, stick).map_err(denied)?;
        if self.is_braking() {
            self.arbiter.release(client);
            return Err("stopped");
        }
        if !was_driver {
            let text = format!("{} drives", self.clients.name(client));
            self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
        }
        self.driver_power = power;
        self.command_brain(now_us, command(valid_until_us), outputs);
        Ok(())
    }

    /// The robot was told to stop and has not said yet that it heard of it: whoever took the wheel now would be stopped by the
    /// word about the driver before.
    fn is_braking(&self) -> bool {
        let knows = self
            .facts
            .report
            .as_ref()
            .is_some_and(|report| report.inhibits.contains(Inhibit::Stopped));
        self.device.as_ref().is_some_and(Supervisor::is_latched) && !knows
    }

    fn check_range(&self, stick: &Stick) -> Result<(), Refused> {
        let description = self
            .device
            .as_ref()
            .and_then(Supervisor::description)
            .ok_or("no-robot")?;
        // Written so that NaN is refused too.
        let in_range = stick.speed_m_per_s.abs() <= description.drive.speed_max_m_per_s
            && stick.turn_rad_per_s.abs() <= description.drive.turn_max_rad_per_s;
        if in_range { Ok(()) } else { Err("range") }
    }

    fn release(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        if self.arbiter.release(client) {
            self.driver_left(now_us, (client, DeviceCommand::Rest), outputs);
        }
    }

    fn driver_left(
        &mut self,
        now_us: u64,
        (client, command): (ClientId, DeviceCommand),
        outputs: &mut Outputs,
    ) {
        self.device_command(now_us, command, outputs);
        self.command_brain(now_us, Command::ManualEnd, outputs);
        let text = format!("driver {} left: wheels stop", self.clients.name(client));
        self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
    }

    /// Nobody can let go of a stick over a connection that takes no more requests.
    pub(super) fn client_silent(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        if self.arbiter.forget(client) {
            // Whoever is lost has not let go: no ramp.
            self.driver_left(now_us, (client, DeviceCommand::EmergencyStop), outputs);
        }
        self.buttons.forget_client(client);
        self.forget_inputs(now_us, client, outputs);
    }

    pub(super) fn client_gone(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        self.client_silent(now_us, client, outputs);
        self.clients.forget(client);
    }

    fn locate(&mut self, now_us: u64, outputs: &mut Outputs) -> Result<(), Refused> {
        self.require_robot()?;
        for (pitch_hz, duration_ms) in LOCATE_TONES {
            self.device_command(
                now_us,
                DeviceCommand::Tone(Tone {
                    pitch_hz,
                    duration_ms,
                }),
                outputs,
            );
        }
        Ok(())
    }

    fn clear(&mut self, now_us: u64, reason: &str, outputs: &mut Outputs) -> Result<(), Refused> {
        self.require_robot()?;
        let latched = Inhibit::from_name(reason).filter(|inhibit| inhibit.is_latched());
        if let Some(inhibit) = latched {
            self.device_command(now_us, DeviceCommand::Clear(inhibit), outputs);
        }
        match self.admitted(&Command::ClearError) {
            Ok(()) => self.command_brain(now_us, Command::ClearError, outputs),
            Err(refused) if latched.is_none() => return Err(refused),
            Err(_) => {}
        }
        Ok(())
    }

    fn raw(
        &mut self,
        now_us: u64,
        (client, packet): (ClientId, &str),
        outputs: &mut Outputs,
    ) -> Result<(), Refused> {
        if self.config.expert == ExpertAccess::Denied {
            return Err("expert-off");
        }
        let device = self.device.as_mut().ok_or("no-robot")?;
        let mut io = DeviceIo {
            now_us,
            link: &mut outputs.link,
            events: &mut self.events,
        };
        let sent = device.raw(packet, &mut io);
        if sent == Err(CommandError::Syntax) {
            return Err("raw-syntax");
        }
        let text = format!("{} sends raw {packet}", self.clients.name(client));
        self.log(now_us, (LogLevel::Warn, Part::Client, text), outputs);
        sent.map_err(|_| "not-sent")
    }

    fn hello(
        &mut self,
        now_us: u64,
        (client, name): (ClientId, String),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let kept: String = name
            .chars()
            .filter(|letter| !letter.is_control())
            .take(NAME_MAX)
            .collect();
        let text = format!("client {} is {kept}", client.0);
        self.clients.rename(client, kept);
        self.log(now_us, (LogLevel::Debug, Part::Client, text), outputs);
        outputs.deliveries.push(Delivery {
            to: Recipients::One(client),
            update: self.greeting(),
        });
        Ok(())
    }

    fn watch(
        &mut self,
        now_us: u64,
        (client, topics): (ClientId, &[Topic]),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        for topic in self.clients.watch(client, topics) {
            self.first_view(now_us, (client, topic), outputs);
        }
        Ok(())
    }
}

/// The shell does it, and answers the client.
fn order_mix(
    (client, id): (ClientId, Option<u32>),
    task: MixTask,
    outputs: &mut Outputs,
) -> Result<(), Refusal> {
    outputs.mix_orders.push(MixOrder { client, id, task });
    Ok(())
}

pub(super) fn denied(denied: Denied) -> Refused {
    match denied {
        Denied::DriverBusy(_) => "driver-busy",
        Denied::ReturnToCentre => "centre-first",
        Denied::LeaseRange => "lease-range",
    }
}
