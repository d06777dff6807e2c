//! Reactions to findings of the reflexes, to motion that ended and to overloaded motors.

use rvac_protocol::message::{Event, Inhibit, LogLevel, Motor, MoveEnd};
use rvac_units::Tick;

use crate::arming::ArmingEvent;
use crate::board::Parts;
use crate::cord::Cord;
use crate::motion::Ending;
use crate::reflex::Findings;
use crate::rules::button::PRESS_MS;

impl<P: Parts> Cord<P> {
    /// Acts on the findings of the contact rules.
    pub(crate) fn react(&mut self, findings: &Findings, now: Tick) {
        if let Some(change) = findings.dock {
            self.reflexes.arming.take(change, now);
            if self.reflexes.arming.is_locked() {
                self.stop_all(MoveEnd::Inhibited);
            }
        }
        let rests = !self.is_in_motion();
        let rested = self.rest.for_at_least(rests, now, PRESS_MS);
        if findings.buttons.any_pressed && !rested {
            self.reflexes.arming.take(ArmingEvent::Button, now);
            self.stop_all(MoveEnd::Inhibited);
        }
        let changed = findings.buttons.pressed | findings.buttons.released;
        for button in (0..8).filter(|number| changed & (1 << number) != 0) {
            let pressed = findings.buttons.pressed & (1 << button) != 0;
            self.session.queue_event(Event::Button { button, pressed }, now);
        }
    }

    /// Stops whatever a permission allowed that has just ended by itself.
    pub(crate) fn react_to_time(&mut self, event: ArmingEvent) {
        if self.reflexes.arming.is_locked() {
            self.stop_all(MoveEnd::Inhibited);
            self.journal
                .note(LogLevel::Warn, "no longer armed:", event.explanation());
        }
    }

    /// Whether anything moves or is about to.
    pub(crate) fn is_in_motion(&self) -> bool {
        let status = self.motion.status();
        self.motion.is_active()
            || self.cleaning.is_running()
            || status.left.is_turning()
            || status.right.is_turning()
    }

    /// Reports motion that ended, and notes a lost link.
    pub(crate) fn end(&mut self, ending: Option<Ending>) {
        match ending {
            Some(Ending::Move(end)) => {
                let now = self.senses.now;
                self.session.queue_event(Event::MoveFinished(end), now);
            }
            Some(Ending::LeaseLost) => self.reflexes.arming.lose_link(),
            None => {}
        }
    }

    /// Reports a wheel that was switched off for its load.
    pub(crate) fn note_stall(&mut self, motor: Motor) {
        let now = self.senses.now;
        self.session.queue_event(Event::Stall(motor), now);
        self.journal.note(LogLevel::Error, "overload of", motor.name());
    }

    /// The main brush stays blocked.
    pub(crate) fn give_up_brush(&mut self) {
        self.reflexes.latch(Inhibit::BrushStall);
        self.note_stall(Motor::BrushMain);
        self.stop_all(MoveEnd::Inhibited);
    }
}
