//! The robot while it is calibrated: its bytes go to the procedure instead of the core.

use std::io;

use calibration::RobotEvent;
use calibration_values::ValuesError;
use rvac_api::Update;
use vthal_core::{CalibrationOrder, CalibrationTask, ClientId, Input, LinkLoss};

use super::Daemon;
use super::disk::Asker;
use crate::calibration_thread::{CalibrationEvent, CalibrationHandle, CalibrationJob, measured};
use crate::event::LinkEvent;
use crate::link::LineOrder;

/// A procedure that runs.
#[derive(Debug)]
pub(super) struct CalibrationSession {
    client: ClientId,
    handle: CalibrationHandle,
    /// The link is open, so the core gets it back at the end.
    link_is_open: bool,
}

impl Daemon {
    pub(super) fn order_calibration(&mut self, order: CalibrationOrder) {
        let CalibrationOrder { client, id, task } = order;
        let asker = Asker { client, id };
        match task {
            CalibrationTask::Show(device) => self.show_calibration(asker, device.as_deref()),
            CalibrationTask::Begin(device, names) => self.begin_calibration(asker, device, names),
            CalibrationTask::Answer(page, answer) => {
                let taken = self
                    .calibration
                    .as_ref()
                    .is_some_and(|running| running.handle.answer(page, answer));
                if taken {
                    self.tell_done(asker, None);
                } else {
                    let text = "That page is not shown any more.".to_owned();
                    self.refuse(asker, "calibration-late", text);
                }
            }
            CalibrationTask::Hold(held) => {
                self.tell_procedure(if held { RobotEvent::Held } else { RobotEvent::LetGo });
                self.tell_done(asker, None);
            }
            CalibrationTask::End => {
                self.tell_procedure(RobotEvent::Quit);
                self.tell_done(asker, None);
            }
        }
    }

    fn show_calibration(&mut self, asker: Asker, device: Option<&str>) {
        let device = device.unwrap_or_default();
        // A page asks by itself: that nothing can be measured is an answer, and no refusal.
        let known = match measured(device, &self.wiring.calibration_file) {
            Err(ValuesError::UnknownRobot { .. }) => Ok((Vec::new(), String::new())),
            other => other,
        };
        match known {
            Ok((values, file)) => {
                let device = device.to_owned();
                self.tell_done(asker, Some(Update::Calibration { device, values, file }));
            }
            Err(error) => self.refuse(asker, error.reason(), error.to_string()),
        }
    }

    fn begin_calibration(&mut self, asker: Asker, device: String, names: Vec<String>) {
        let job = CalibrationJob {
            device,
            names,
            file: self.wiring.calibration_file.clone(),
        };
        match CalibrationHandle::start(job, self.wiring.event_sender.clone()) {
            Ok(handle) => {
                self.calibration = Some(CalibrationSession {
                    client: asker.client,
                    handle,
                    link_is_open: true,
                });
                self.handle(Input::LinkClosed {
                    reason: LinkLoss::Lent,
                });
                self.tell_done(asker, None);
            }
            Err(error) => {
                self.handle(Input::CalibrationOver);
                let text = format!("The procedure cannot be started: {error}.");
                self.refuse(asker, "calibration-no-answer", text);
            }
        }
    }

    fn tell_procedure(&self, event: RobotEvent) {
        if let Some(running) = &self.calibration {
            running.handle.tell(event);
        }
    }

    pub(super) fn take_calibration(&mut self, event: CalibrationEvent) {
        match event {
            CalibrationEvent::Bytes(bytes) => {
                // A packet that is lost is sent again or asked for again.
                self.wiring.to_robot.try_send(LineOrder::Send(bytes)).ok();
            }
            CalibrationEvent::Page(page) => {
                if let Some(client) = self.calibration.as_ref().map(|running| running.client) {
                    self.tell(client, &Update::CalibrationPage(page));
                }
            }
            CalibrationEvent::Over(page) => {
                let Some(ended) = self.calibration.take() else {
                    return;
                };
                self.handle(Input::CalibrationOver);
                if ended.link_is_open {
                    self.handle(Input::LinkOpened);
                }
                self.tell(ended.client, &Update::CalibrationPage(page));
            }
        }
    }

    /// What the link says while the robot is calibrated; gives back what is for the core.
    pub(super) fn divert_link(&mut self, event: LinkEvent) -> Option<LinkEvent> {
        let Some(running) = &mut self.calibration else {
            return Some(event);
        };
        match event {
            LinkEvent::Bytes(bytes) => running.handle.tell(RobotEvent::Received(bytes)),
            // The procedure judges packets, whose checksums say the same.
            LinkEvent::FramingErrors(_) => {}
            LinkEvent::Closed(_) => {
                running.link_is_open = false;
                running
                    .handle
                    .tell(RobotEvent::Lost(io::ErrorKind::BrokenPipe.into()));
            }
            LinkEvent::Opened(_) => running.link_is_open = true,
            LinkEvent::Absent(_) => return Some(event),
        }
        None
    }
}
