//! What the session gives, as events of the device model.

use rvac_protocol::message::{Event, NumberedEvent, Report, RobotHello, State};
use rvac_protocol::session::HostEvent;
use rvac_units::Tick;

use super::super::{DeviceEvent, Greeting};
use super::momentary::MomentaryLevels;
use super::{Cordlib, to_model};

/// The last start of which the robot has told, on whatever line.
#[derive(Clone, Copy, Debug)]
pub(super) struct LastStart {
    boot_count: u32,
    /// Its clock in the newest report since.
    tick: Option<Tick>,
}

impl Cordlib {
    /// Takes an event of the session.
    pub(super) fn take(&mut self, event: HostEvent, events: &mut Vec<DeviceEvent>) {
        let told = match event {
            HostEvent::Opened(hello) => DeviceEvent::Opened(self.greeted(hello)),
            HostEvent::Described(table) => {
                self.capabilities = table.capabilities;
                self.unmeasured = table.motors.unmeasured;
                let description = to_model::description(self.hello.as_ref(), &table);
                self.encoders
                    .described(&description.identity.device, description.odometry.resolution_m);
                self.description = Some(description.clone());
                DeviceEvent::Described(Box::new(description))
            }
            HostEvent::Report(report) => match self.report(report) {
                Some(told) => told,
                None => return,
            },
            HostEvent::Answered { refusal: None, .. } => return,
            HostEvent::Answered {
                sequence,
                refusal: Some(refusal),
            } => DeviceEvent::Refused {
                number: sequence.map(|sequence| sequence.0.into()),
                reason: refusal.name(),
            },
            HostEvent::Unanswered(sequence) => DeviceEvent::Unanswered(sequence.0.into()),
            HostEvent::EventsLost { count } => {
                self.momentary = MomentaryLevels::default();
                DeviceEvent::EventsLost(count.into())
            }
            HostEvent::Closed(_) | HostEvent::Silent => DeviceEvent::Closed,
            HostEvent::Incompatible {
                version_min,
                version_max,
            } => DeviceEvent::Incompatible {
                version_min: version_min.0,
                version_max: version_max.0,
            },
        };
        events.push(told);
    }

    fn greeted(&mut self, hello: RobotHello) -> Greeting {
        let was_reset = self.last_start.is_some_and(|last| {
            let went_back = |tick| !hello.tick.reached(tick);
            last.boot_count != hello.boot_count || last.tick.is_some_and(went_back)
        });
        self.last_start = Some(LastStart {
            boot_count: hello.boot_count,
            tick: None,
        });
        self.encoders.forget_newest();
        self.momentary = MomentaryLevels::default();
        if was_reset {
            self.encoders.rebase();
        }
        let greeting = Greeting {
            device: hello.device.as_str().to_owned(),
            firmware: hello.firmware.as_str().to_owned(),
            reset_cause: Some(hello.reset_cause.name()),
            was_reset,
        };
        self.hello = Some(hello);
        greeting
    }

    fn report(&mut self, report: Report) -> Option<DeviceEvent> {
        match report {
            Report::State(mut state) => {
                self.follow_clock();
                self.momentary.complete(&mut state);
                Some(DeviceEvent::Report(self.state(&state)))
            }
            Report::Info(info) => Some(DeviceEvent::Slow(to_model::slow_facts(&info))),
            Report::Event(event) => {
                self.momentary.take(&event);
                of_event(&event)
            }
            Report::Log { level, text } => Some(DeviceEvent::Log {
                level: to_model::log_level(level),
                text: text.as_str().to_owned(),
            }),
            // The session keeps these to itself.
            Report::Hello(_) | Report::Describe(_) | Report::Acknowledgement(_) => None,
            // Raw readings are for tools that speak to a robot directly.
            Report::Probed(_) => None,
        }
    }

    /// Over a jump of the robot's clock no speed is told, and no event is compared with a report.
    fn follow_clock(&mut self) {
        let clock_jumps = self.session.arrivals().clock_jumps;
        if core::mem::replace(&mut self.clock_jumps, clock_jumps) != clock_jumps {
            self.encoders.forget_newest();
            self.momentary = MomentaryLevels::default();
        }
    }

    fn state(&mut self, state: &State) -> super::super::Report {
        if let Some(last) = &mut self.last_start {
            last.tick = Some(state.tick);
        }
        let travel = match &self.description {
            Some(_) => self.encoders.take(state),
            None => self.encoders.take_unknown(state),
        };
        to_model::report(state, self.capabilities, self.unmeasured, travel)
    }
}

/// The others change levels of reports; [`MomentaryLevels`] adds to a report what it has missed of them.
fn of_event(event: &NumberedEvent) -> Option<DeviceEvent> {
    match event.kind {
        Event::Button { button, pressed } => Some(DeviceEvent::Button { button, pressed }),
        Event::Stall(motor) => Some(DeviceEvent::MotorStopped(motor.name())),
        Event::Docked(docked) => Some(DeviceEvent::Docked(docked)),
        Event::Bump(_) | Event::Cliff(_) | Event::Lift(_) | Event::MoveFinished(_) | Event::Inhibits(_) => {
            None
        }
    }
}
