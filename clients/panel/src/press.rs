//! Presses of the job buttons: shown as pending at once, then as done, or as without an answer.

use leptos::prelude::*;
use panel_logic::{Currency, Template};
use rvac_api::{Failure, RequestBody};

use crate::language::words;
use crate::news::now_ms;
use crate::store::Store;

/// The reason code of a press that got no answer. No robot gives it.
pub(crate) const NO_ANSWER: &str = "no-answer";

impl Store {
    /// Sends what a person pressed; until the answer comes its button says that it waits.
    pub(crate) fn press(self, verb: &'static str, label: &'static str, body: RequestBody) {
        if !self.admits_request(&body) {
            return;
        }
        self.refusal.set(None);
        self.note.set(None);
        if self.currency.get_untracked() == Currency::Away {
            self.say_missing(words().action.not_sent, label);
            return;
        }
        let id = self
            .presses
            .try_update(|presses| presses.begin(verb, now_ms()))
            .unwrap_or_default();
        self.ask_as(id, body);
    }

    /// Whether a press of this kind waits for its answer; a view that asks follows it.
    pub(crate) fn is_pending(self, verb: &str) -> bool {
        self.presses.with(|presses| presses.is_pending(verb))
    }

    /// An answer to a press came.
    pub(crate) fn end_press(self, id: u32, is_done: bool) {
        if self.presses.with_untracked(panel_logic::Presses::is_empty) {
            return;
        }
        let ended = self.presses.try_update(|presses| presses.end(id)).flatten();
        match ended.as_deref() {
            Some("locate") if is_done => self.note.set(Some(words().action.found)),
            Some("clean") if is_done => self.on_choice_sent(),
            _ => {}
        }
    }

    /// Says which press waits in vain.
    pub(crate) fn give_up_presses(self) {
        if self.presses.with_untracked(panel_logic::Presses::is_empty) {
            return;
        }
        let given_up = self
            .presses
            .try_update(|presses| presses.expire(now_ms()))
            .flatten();
        if let Some(verb) = given_up {
            self.say_missing(words().action.no_answer, label_of(&verb));
        }
    }

    fn say_missing(self, what: Template<1>, label: &str) {
        self.refusal.set(Some(Failure {
            id: None,
            reason: NO_ANSWER.to_owned(),
            text: what.fill([&label]),
        }));
    }
}

/// What stands on the button of a request.
fn label_of(verb: &str) -> &'static str {
    let texts = &words().action;
    match verb {
        "stop" => texts.stop,
        "pause" => texts.pause,
        "resume" => texts.resume,
        "spot" => texts.spot,
        "dock" => texts.dock,
        "locate" => texts.find,
        "clear" => texts.clear,
        "clean" => words().map.clean_selected,
        _ => texts.start,
    }
}
