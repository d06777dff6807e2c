//! Edits of the map, taken back and done again: two buttons, and the keys that people know for it.

use leptos::ev;
use leptos::prelude::*;
use panel_logic::{Change, Edit, EditError, EditLog, RoomChoice, Told};
use rvac_api::{Failure, HomeView, Request, RequestBody};
use wasm_bindgen::JsCast;

use crate::access::EDITS_HOME;
use crate::icons::{Icon, icon};
use crate::language::words;
use crate::store::{NOT_DRAWN, Store};

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

    /// A refused edit has not happened; the refusal is told as any other.
    pub(crate) fn on_failed(self, failure: &Failure) {
        if let Some(id) = failure.id {
            self.log.update(|log| log.on_failed(id, &failure.reason));
        }
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

    fn undo(self) {
        let home = self.known_home();
        let earlier = self.edits.log.try_update(EditLog::undo_choice).flatten();
        if let Some(earlier) = earlier {
            return self.bring_back(&earlier, &home);
        }
        let asked = self.edits.log.try_update(|log| log.undo(&home));
        self.ask_edit(asked.flatten());
    }

    fn redo(self) {
        let home = self.known_home();
        let later = self.edits.log.try_update(EditLog::redo_choice).flatten();
        if let Some(later) = later {
            return self.bring_back(&later, &home);
        }
        let asked = self.edits.log.try_update(|log| log.redo(&home));
        self.ask_edit(asked.flatten());
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

    /// The home as the robot told it last.
    pub(crate) fn known_home(self) -> HomeView {
        self.map
            .with_value(|map| map.with(|scene| scene.home().cloned()))
            .unwrap_or_default()
    }
}

#[component]
pub(super) fn EditBar(store: Store) -> impl IntoView {
    let log = store.edits.log;
    let label =
        |way: Told<1>, change: Option<&Change>| change.map(|change| way.fill([&change.what(words())]));
    let undo = Memo::new(move |_| log.with(|log| label(words().map.undo, log.last())));
    let redo = Memo::new(move |_| log.with(|log| label(words().map.redo, log.next())));
    let keys = window_event_listener(ev::keydown, move |event| {
        let is_ours = (event.ctrl_key() || event.meta_key()) && !event.alt_key() && !is_typing(&event);
        if is_ours && event.key().eq_ignore_ascii_case("z") {
            event.prevent_default();
            if event.shift_key() {
                store.redo();
            } else {
                store.undo();
            }
        }
    });
    on_cleanup(move || keys.remove());
    let button = move |(id, shape): (&'static str, Icon), label: Memo<Option<String>>, press: fn(Store)| {
        view! {
            <Show when=move || label.get().is_some()>
                <button
                    type="button"
                    class="round"
                    id=id
                    aria-label=move || label.get()
                    title=move || label.get()
                    on:click=move |_| press(store)
                >
                    {icon(shape)}
                </button>
            </Show>
        }
    };
    view! {
        {button(("undo", Icon::Undo), undo, Store::undo)}
        {button(("redo", Icon::Redo), redo, Store::redo)}
    }
}

/// A field of text has its own keys for what was typed in it.
fn is_typing(event: &web_sys::KeyboardEvent) -> bool {
    let element = event
        .target()
        .and_then(|target| target.dyn_into::<web_sys::Element>().ok());
    element.is_some_and(|element| matches!(element.tag_name().as_str(), "INPUT" | "TEXTAREA" | "SELECT"))
}
