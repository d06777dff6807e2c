//! What a person does by hand: drives, stops, and looks after the device itself.

use brain::{Inhibit, JobCommand};
use rvac_api::{LogLevel, RunAsker};

use super::Core;
use super::desk_request::{HandRequest, RobotAnswers, RobotRequest};
use crate::brain_session::BrainSession;
use crate::desk::arbiter::Stick;
use crate::desk::audience::Asking;
use crate::desk::calibration::CalibrationRequest;
use crate::desk::driver::{HandDrive, Pull};
use crate::desk::journal::LogSource;
use crate::desk::reply::Reply;
use crate::device::{CleanerPower, DeviceCommand, Tone};
use crate::refusal::{Refusal, Refused};
use crate::{ClientId, ExpertAccess, Outputs};

/// Tones of `locate`: pitch in Hz and length in ms.
const LOCATE_TONES: [(u32, u16); 3] = [(1760, 200), (1320, 200), (1760, 400)];

impl Core {
    pub(super) fn by_hand(
        &mut self,
        now_us: u64,
        Asking { asker, request }: Asking<HandRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        let client = asker.client;
        match request {
            HandRequest::Stop => self.stop(now_us, client, outputs),
            HandRequest::Drive(drive) => self.drive(now_us, (client, drive), outputs)?,
            HandRequest::Release => {
                if self.driver.arbiter.release(client) {
                    self.driver_left(now_us, (client, DeviceCommand::Rest), outputs);
                }
            }
            HandRequest::Inputs(told) => {
                let mut teller = self.audience.teller(self.now(now_us), outputs);
                return self.inputs.take(client, told, &mut teller);
            }
            HandRequest::ClaimButtons(ms) => self.buttons.claim(now_us, client, ms),
        }
        Ok(Reply::Done)
    }

    /// Anybody may stop at any time; the wheels do not wait for the brain.
    fn stop(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        self.driver.arbiter.preempt();
        outputs.calibration_orders.extend(self.calibration.end());
        let name = self.audience.clients.name(client);
        let text = format!("stopped by {name}");
        self.history.commanded_by(RunAsker::Client(name));
        self.device_command(now_us, DeviceCommand::EmergencyStop, outputs);
        self.command_brain(now_us, JobCommand::Stop.into(), outputs);
        self.teller(now_us, outputs)
            .log(LogLevel::Info, LogSource::Client, text);
    }

    fn drive(
        &mut self,
        now_us: u64,
        (client, drive): (ClientId, HandDrive),
        outputs: &mut Outputs,
    ) -> Result<(), Refused> {
        let (stick, power) = (drive.stick(), drive.cleaner_power()?);
        self.require_robot()?;
        self.check_range(&stick)?;
        let command = |valid_until_us| JobCommand::Manual {
            speed_m_per_s: stick.speed_m_per_s,
            turn_rad_per_s: stick.turn_rad_per_s,
            valid_until_us,
            cleaners: power != CleanerPower::NONE,
        };
        self.readiness().admit(&command(now_us + stick.lease_us))?;
        let brakes = self.link.brakes();
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        let pull = Pull { stick, brakes };
        let valid_until_us = self.driver.drive(client, pull, &mut teller)?;
        self.driver.set_power(power);
        self.command_brain(now_us, command(valid_until_us).into(), outputs);
        Ok(())
    }

    fn check_range(&self, stick: &Stick) -> Result<(), Refused> {
        let description = self.link.description().ok_or("no-robot")?;
        // Written so that NaN is refused too.
        let in_range = stick.speed_m_per_s.abs() <= description.drive.speed_max_m_per_s
            && stick.turn_rad_per_s.abs() <= description.drive.turn_max_rad_per_s;
        if in_range { Ok(()) } else { Err("range") }
    }

    fn driver_left(
        &mut self,
        now_us: u64,
        (client, command): (ClientId, DeviceCommand),
        outputs: &mut Outputs,
    ) {
        self.device_command(now_us, command, outputs);
        self.command_brain(now_us, JobCommand::ManualEnd.into(), outputs);
        let mut teller = self.teller(now_us, outputs);
        let text = format!("driver {} left: wheels stop", teller.name(client));
        teller.log(LogLevel::Info, LogSource::Client, text);
    }

    /// Nobody can let go of a stick over a connection that takes no more requests.
    pub(super) fn client_silent(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        if self.driver.arbiter.release(client) {
            // Whoever is lost has not let go: no ramp.
            self.driver_left(now_us, (client, DeviceCommand::EmergencyStop), outputs);
        }
        self.buttons.forget_client(client);
        if let Some(holder) = self.loan.forget_client(client) {
            outputs.line_holder = Some(holder);
        }
        outputs
            .calibration_orders
            .extend(self.calibration.forget_client(client));
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        self.inputs.forget(client, &mut teller);
    }

    pub(super) fn robot(
        &mut self,
        now_us: u64,
        Asking { asker, request }: Asking<RobotRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        match request {
            RobotRequest::Locate => {
                self.require_robot()?;
                for (pitch_hz, duration_ms) in LOCATE_TONES {
                    let tone = Tone {
                        pitch_hz,
                        duration_ms,
                    };
                    self.device_command(now_us, DeviceCommand::Tone(tone), outputs);
                }
            }
            RobotRequest::Clear(reason) => self.clear(now_us, &reason, outputs)?,
            RobotRequest::Raw(packet) => self.raw(now_us, (asker.client, &packet), outputs)?,
            RobotRequest::Calibration(request) => {
                return self.calibrate(now_us, Asking { asker, request }, outputs);
            }
            RobotRequest::BorrowLink(answers) => self.lend_link(now_us, (asker.client, answers), outputs)?,
        }
        Ok(Reply::Done)
    }

    /// The shell gives the robot to the procedure, and answers the client.
    fn calibrate(
        &mut self,
        now_us: u64,
        Asking { asker, request }: Asking<CalibrationRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        let begins = matches!(request, CalibrationRequest::Begin(_));
        let facts = self.link.loan_facts();
        let device = self.brain_session.as_ref().map(BrainSession::device);
        let order = self
            .calibration
            .order((asker.client, asker.id), request, (facts, device))?;
        outputs.calibration_orders.push(order);
        if begins {
            let text = format!(
                "{} calibrates the robot",
                self.audience.clients.name(asker.client)
            );
            self.teller(now_us, outputs)
                .log(LogLevel::Info, LogSource::Client, text);
        }
        Ok(Reply::ByShell)
    }

    /// The shell closes the device at once, and the robot is disconnected until the client is gone.
    fn lend_link(
        &mut self,
        now_us: u64,
        (client, answers): (ClientId, RobotAnswers),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let facts = self.link.loan_facts();
        outputs.line_holder = Some(self.loan.lend(client, answers, facts)?);
        let text = format!(
            "the serial line is lent to {}",
            self.audience.clients.name(client)
        );
        self.teller(now_us, outputs)
            .log(LogLevel::Warn, LogSource::Client, text);
        Ok(())
    }

    fn clear(&mut self, now_us: u64, reason: &str, outputs: &mut Outputs) -> Result<(), Refused> {
        self.require_robot()?;
        let latched = Inhibit::from_name(reason).filter(|inhibit| inhibit.is_latched());
        if let Some(inhibit) = latched {
            self.device_command(now_us, DeviceCommand::Clear(inhibit), outputs);
        }
        match self.readiness().admit(&JobCommand::ClearError) {
            Ok(()) => self.command_brain(now_us, JobCommand::ClearError.into(), outputs),
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
        let mut teller = self.audience.teller(self.now(now_us), outputs);
        let expert = teller.name(client);
        self.link.send_raw(packet, &expert, &mut teller)
    }
}
