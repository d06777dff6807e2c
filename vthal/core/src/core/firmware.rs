//! What the firmware told, and what the core makes of it.

use rvac_api::LogLevel;
use rvac_protocol::message::{Event, Info, NumberedEvent, RobotHello, State};

use super::link_facts::Greeting;
use super::{Core, recorder};
use crate::device::{Description, FirmwareEvent};
use crate::journal::Part;
use crate::mind::Mind;
use crate::{Outputs, RunEnd, cut_short, to_api};

impl Core {
    pub(super) fn firmware_events(
        &mut self,
        now_us: u64,
        events: &mut Vec<FirmwareEvent>,
        outputs: &mut Outputs,
    ) {
        for event in events.drain(..) {
            self.firmware_event(now_us, event, outputs);
        }
    }

    fn firmware_event(&mut self, now_us: u64, event: FirmwareEvent, outputs: &mut Outputs) {
        let line = match event {
            FirmwareEvent::State(state) => return self.take_state(now_us, &state, outputs),
            FirmwareEvent::Info(info) => return self.take_info(info),
            FirmwareEvent::Opened(hello) => self.greeted(&hello),
            FirmwareEvent::Described(description) => self.described(now_us, &description, outputs),
            FirmwareEvent::Edge(edge) => match self.take_edge(now_us, &edge, outputs) {
                Some(text) => (LogLevel::Info, Part::Firmware, text),
                None => return,
            },
            FirmwareEvent::Log { level, text } => {
                (to_api::log_level(level), Part::Firmware, text.as_str().to_owned())
            }
            FirmwareEvent::Refused { sequence, refusal } => {
                let number = sequence.map_or_else(String::new, |sequence| format!(" {}", sequence.0));
                let text = format!("the robot refused command{number}: {}", refusal.name());
                (LogLevel::Warn, Part::Firmware, text)
            }
            FirmwareEvent::Unanswered(sequence) => (
                LogLevel::Warn,
                Part::Link,
                format!("the robot did not answer command {}", sequence.0),
            ),
            FirmwareEvent::EdgesLost(count) => {
                self.buttons.forget();
                let text = format!("{count} events of the robot were lost");
                (LogLevel::Warn, Part::Link, text)
            }
            FirmwareEvent::Closed => {
                self.buttons.forget();
                let text = "session with the robot ended".to_owned();
                (LogLevel::Warn, Part::Link, text)
            }
            FirmwareEvent::Incompatible {
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

    fn greeted(&mut self, hello: &RobotHello) -> (LogLevel, Part, String) {
        self.buttons.forget();
        match self.facts.greeted(hello) {
            Greeting::Continues => {
                let text = format!("session with {} {}", hello.device, hello.firmware);
                (LogLevel::Info, Part::Link, text)
            }
            Greeting::Reset(cause) => {
                if let Some(mind) = &mut self.mind {
                    mind.observer.rebase();
                }
                let text = format!("{} was reset ({}); new session", hello.device, cause.name());
                (LogLevel::Warn, Part::Link, text)
            }
        }
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

    fn take_state(&mut self, now_us: u64, state: &State, outputs: &mut Outputs) {
        self.facts.take_state(now_us, state);
        if let Some(gesture) = self.buttons.take_report(now_us, state.buttons) {
            self.held(now_us, (gesture, state.tick), outputs);
        }
        let description = self.device.as_ref().and_then(|device| device.description());
        if let (Some(mind), Some(description)) = (&mut self.mind, description) {
            mind.observer.take_state(now_us, state, description);
            self.think(now_us, outputs);
        }
    }

    fn take_info(&mut self, info: Info) {
        if let Some(mind) = &mut self.mind {
            mind.observer.take_battery(info.battery.as_ref());
        }
        self.facts.info = Some(info);
    }

    fn take_edge(&mut self, now_us: u64, edge: &NumberedEvent, outputs: &mut Outputs) -> Option<String> {
        match edge.kind {
            Event::Button { button, pressed } => {
                self.button_turned(now_us, (button, pressed), outputs);
                pressed.then(|| format!("button {button} was pressed"))
            }
            Event::Stall(motor) => Some(format!("{} was switched off for its load", motor.name())),
            Event::Docked(true) => Some("on the dock".to_owned()),
            Event::Docked(false) => Some("off the dock".to_owned()),
            // Levels of these come with each report, and the brain decides upon levels.
            Event::Bump(_)
            | Event::Cliff(_)
            | Event::Lift(_)
            | Event::MoveFinished(_)
            | Event::Inhibits(_) => None,
        }
    }
}
