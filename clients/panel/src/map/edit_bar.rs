//! Edits of the map, taken back and done again: two buttons, and the keys that people know for it.

use leptos::ev;
use leptos::prelude::*;
use panel_logic::{Change, Edit, EditError, EditLog, RoomChoice, Step, Template};
use rvac_api::{Failure, HomeView, Request, RequestBody};
use wasm_bindgen::JsCast;

use crate::access::EDITS_HOME;
use crate::icons::{Icon, icon};
use crate::language::words;
use crate::refusals::NOT_DRAWN;
use crate::store::Store;

/// What was edited on this page; cheap to copy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edits {
    log: RwSignal<EditLog>,
    floor: StoredValue<Option<u16>>,
}

impl Edits {
    pub(crate) fn new() -> Self {
        Self {
            log: RwSignal::new(EditLog::default()),
            floor: StoredValue::new(None),
        }
    }

    /// The robot is on this floor. Edits of another floor's map cannot be taken back on this one.
    pub(crate) fn on_floor(self, here: Option<u16>) {
        if here.is_some() && self.floor.get_value() != here {
            self.floor.set_value(here);
            self.log.update(EditLog::clear);
        }
    }

    pub(crate) fn on_done(self, id: u32, home: &HomeView) {
        self.log.update(|log| log.on_done(id, home.revision));
    }

    /// A refused edit has not happened; the refusal is shown as any other.
    pub(crate) fn on_failed(self, failure: &Failure) {
        if let Some(id) = failure.id {
            self.log.update(|log| log.on_failed(id, &failure.reason));
        }
    }

    /// Nobody will answer any more.
    pub(crate) fn on_lost(self) {
        self.log.update(EditLog::on_lost);
    }

    /// Something else is chosen for a job.
    pub(super) fn on_chosen(self, before: RoomChoice, now: RoomChoice) {
        self.log.update(|log| log.on_chosen(before, now));
    }

    /// What was chosen has become a job.
    pub(super) fn on_sent(self) {
        self.log.update(EditLog::forget_choices);
    }
}

impl Store {
    /// Asks for an edit of the map that can be taken back.
    pub(crate) fn edit(self, edit: Edit) {
        if !self.admits(EDITS_HOME) {
            return;
        }
        let home = self.known_home();
        let asked = self.edits.log.try_update(|log| log.begin(edit, &home));
        self.ask_edit(asked);
    }

    /// Takes a step in the log, or puts it off until the robot has answered.
    fn step(self, step: Step) {
        let is_put_off = self.edits.log.try_update(|log| log.puts_off(step));
        if is_put_off != Some(true) {
            let asked = self.take_step(step);
            self.ask_edit(asked);
        }
    }

    /// Takes what was put off, as far as that can be known now.
    pub(crate) fn take_put_off_steps(self) {
        while let Some(step) = self.edits.log.try_update(EditLog::take_put_off).flatten() {
            let asked = self.take_step(step);
            if matches!(asked, Some(Err(EditError::NotReportedYet))) {
                self.edits.log.update(|log| log.put_off_again(step));
                return;
            }
            self.ask_edit(asked);
        }
    }

    /// A change of the choice is made at once; one of the map is asked for.
    fn take_step(self, step: Step) -> Option<Result<Request, EditError>> {
        let home = self.known_home();
        let choice = match step {
            Step::Undo => EditLog::undo_choice,
            Step::Redo => EditLog::redo_choice,
        };
        if let Some(chosen) = self.edits.log.try_update(choice).flatten() {
            self.bring_back(&chosen, &home);
            return None;
        }
        let asked = self.edits.log.try_update(|log| match step {
            Step::Undo => log.undo(&home),
            Step::Redo => log.redo(&home),
        });
        asked.flatten()
    }

    fn bring_back(self, chosen: &RoomChoice, home: &HomeView) {
        self.orders
            .choice
            .update(|choice| choice.bring_back(chosen, home));
    }

    fn ask_edit(self, asked: Option<Result<Request, EditError>>) {
        match asked {
            None => {}
            Some(Ok(Request { id, body })) => {
                self.refusal.set(None);
                let is_other_map = matches!(body, RequestBody::RestoreMap { .. });
                self.ask_as(id.unwrap_or_default(), body);
                if is_other_map {
                    // Answered after the one before, so with the restored map in it.
                    self.ask_for_maps();
                }
            }
            Some(Err(error)) => self.refusal.set(Some(Failure {
                id: None,
                reason: NOT_DRAWN.to_owned(),
                text: error.text(words()).to_owned(),
            })),
        }
    }

    /// The home as last received from the robot.
    pub(crate) fn known_home(self) -> HomeView {
        self.map
            .with_value(|map| map.with(|scene| scene.home().cloned()))
            .unwrap_or_default()
    }
}

#[component]
pub(crate) fn EditBar(store: Store) -> impl IntoView {
    let log = store.edits.log;
    let label =
        |way: Template<1>, change: Option<&Change>| change.map(|change| way.fill([&change.what(words())]));
    let undo = Memo::new(move |_| log.with(|log| label(words().map.undo, log.last())));
    let redo = Memo::new(move |_| log.with(|log| label(words().map.redo, log.next())));
    let keys = window_event_listener(ev::keydown, move |event| {
        let is_ours = (event.ctrl_key() || event.meta_key()) && !event.alt_key() && !is_typing(&event);
        if is_ours && event.key().eq_ignore_ascii_case("z") {
            event.prevent_default();
            store.step(if event.shift_key() { Step::Redo } else { Step::Undo });
        }
    });
    on_cleanup(move || keys.remove());
    let button = move |(id, shape): (&'static str, Icon), label: Memo<Option<String>>, step: Step| {
        view! {
            <Show when=move || label.get().is_some()>
                <button
                    type="button"
                    class="round"
                    id=id
                    aria-label=move || label.get()
                    title=move || label.get()
                    on:click=move |_| store.step(step)
                >
                    {icon(shape)}
                </button>
            </Show>
        }
    };
    view! {
        {button(("undo", Icon::Undo), undo, Step::Undo)}
        {button(("redo", Icon::Redo), redo, Step::Redo)}
    }
}

/// A field of text has its own keys for what was typed in it.
fn is_typing(event: &web_sys::KeyboardEvent) -> bool {
    let element = event
        .target()
        .and_then(|target| target.dyn_into::<web_sys::Element>().ok());
    element.is_some_and(|element| matches!(element.tag_name().as_str(), "INPUT" | "TEXTAREA" | "SELECT"))
}
