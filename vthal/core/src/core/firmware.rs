//! What the device told, and what the core makes of it.

use rvac_api::LogLevel;

use super::{Core, recorder};
use crate::device::{Description, DeviceEvent, Greeting, Report, SlowFacts};
use crate::journal::Part;
use crate::mind::Mind;
use crate::{Outputs, RunEnd, cut_short};

impl Core {
    pub(super) fn device_events(
        &mut self,
        now_us: u64,
        events: &mut Vec<DeviceEvent>,
        outputs: &mut Outputs,
    ) {
        for event in events.drain(..) {
            self.device_event(now_us, event, outputs);
        }
    }

    fn device_event(&mut self, now_us: u64, event: DeviceEvent, outputs: &mut Outputs) {
        let line = match event {
            DeviceEvent::Report(report) => return self.take_report(now_us, report, outputs),
            DeviceEvent::Slow(facts) => return self.take_slow_facts(facts),
            DeviceEvent::Opened(greeting) => self.greeted(&greeting),
            DeviceEvent::Described(description) => self.described(now_us, &description, outputs),
            DeviceEvent::Button { button, pressed } => {
                self.button_turned(now_us, (button, pressed), outputs);
                if !pressed {
                    return;
                }
                let text = format!("button {button} was pressed");
                (LogLevel::Info, Part::Firmware, text)
            }
            DeviceEvent::MotorStopped(motor) => {
                let text = format!("{motor} was switched off for its load");
                (LogLevel::Info, Part::Firmware, text)
            }
            DeviceEvent::Docked(docked) => {
                let text = if docked { "on the dock" } else { "off the dock" };
                (LogLevel::Info, Part::Firmware, text.to_owned())
            }
            DeviceEvent::Log { level, text } => (level, Part::Firmware, text),
            DeviceEvent::Refused { number, reason } => {
                let number = number.map_or_else(String::new, |number| format!(" {number}"));
                let text = format!("the robot refused command{number}: {reason}");
                (LogLevel::Warn, Part::Firmware, text)
            }
            DeviceEvent::Unanswered(number) => (
                LogLevel::Warn,
                Part::Link,
                format!("the robot did not answer command {number}"),
            ),
            DeviceEvent::ControlLost(reason) => {
                let text = format!("the robot took its wheels back: {reason}");
                (LogLevel::Warn, Part::Firmware, text)
            }
            DeviceEvent::EventsLost(count) => {
                self.buttons.forget();
                let text = format!("{count} events of the robot were lost");
                (LogLevel::Warn, Part::Link, text)
            }
            DeviceEvent::Closed => {
                self.buttons.forget();
                let text = "session with the robot ended".to_owned();
                (LogLevel::Warn, Part::Link, text)
            }
            DeviceEvent::Incompatible {
                version_min,
                version_max,
            } => {
                let text = format!(
                    "the robot speaks versions {version_min} to {version_max} of the wire, which this vthal does not; \
                     update one of them"
                );
                (LogLevel::Error, Part::Link, text)
            }
        };
        self.log(now_us, line, outputs);
    }

    fn greeted(&mut self, greeting: &Greeting) -> (LogLevel, Part, String) {
        self.buttons.forget();
        self.facts.greeted(greeting);
        let Greeting { device, firmware, .. } = greeting;
        if !greeting.was_reset {
            let text = format!("session with {device} {firmware}");
            return (LogLevel::Info, Part::Link, text);
        }
        if let Some(mind) = &mut self.mind {
            mind.observer.rebase();
        }
        let cause = greeting.reset_cause.unwrap_or("for no known cause");
        let text = format!("{device} was reset ({cause}); new session");
        (LogLevel::Warn, Part::Link, text)
    }

    fn described(
        &mut self,
        now_us: u64,
        description: &Description,
        outputs: &mut Outputs,
    ) -> (LogLevel, Part, String) {
        let device = &description.identity.device;
        if self.mind.as_ref().is_none_or(|mind| mind.device() != device) {
            let recording = self.config.recording;
            self.keep_learnt(outputs);
            if let Some(mut old) = self.mind.take() {
                let over = self.runs.change_robot(now_us, old.brain());
                old.end_run(now_us, RunEnd::OtherRobot, &mut recorder(recording, outputs));
                self.keep_run(over, outputs);
            }
            self.tell_learnt(now_us, device, outputs);
            let mut mind = Mind::new(description, &self.config, &self.floors);
            let mut resumed = None;
            match self.config.resume.take() {
                Some(checkpoint) if checkpoint.device == *device => resumed = Some(checkpoint),
                Some(others) => self.keep_run(cut_short(others), outputs),
                None => {}
            }
            if let Some(checkpoint) = &resumed {
                let line = match checkpoint.brain.job {
                    Some(_) => "resumed-after-restart: goes on with the interrupted job",
                    None => "takes up pose and map from before the restart",
                };
                let floor = checkpoint.floor.filter(|floor| self.floors.get(*floor).is_some());
                mind.resume(
                    now_us,
                    (checkpoint.brain.clone(), floor),
                    &mut recorder(recording, outputs),
                );
                self.log(now_us, (LogLevel::Info, Part::Vthal, line.to_owned()), outputs);
            }
            self.mind = Some(mind);
            if let Some(checkpoint) = resumed {
                self.resume_run(now_us, checkpoint, outputs);
            }
        }
        (
            LogLevel::Info,
            Part::Link,
            format!("{device} has described itself"),
        )
    }

    fn take_report(&mut self, now_us: u64, report: Report, outputs: &mut Outputs) {
        self.facts.take_report(now_us, report);
        if let Some(gesture) = self.buttons.take_report(now_us, report.buttons) {
            self.held(now_us, (gesture, report.uptime_ms), outputs);
        }
        let description = self.device.as_ref().and_then(|device| device.description());
        if let (Some(mind), Some(description)) = (&mut self.mind, description) {
            mind.observer.take_report(now_us, &report, description);
            self.think(now_us, outputs);
        }
    }

    fn take_slow_facts(&mut self, facts: SlowFacts) {
        if let Some(mind) = &mut self.mind {
            mind.observer.take_battery(facts.battery.as_ref());
        }
        self.facts.slow = Some(facts);
    }
}
