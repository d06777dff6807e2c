//! What the role of this device permits: shown beforehand, not learned by a refusal.

use leptos::prelude::*;
use panel_logic::Wait;
use rvac_api::RequestBody;

use crate::language::words;
use crate::store::Store;

/// A request that changes the home, as all of its kind need the same role.
pub(crate) const EDITS_HOME: &str = "add-no-go";
/// The same of schedules.
pub(crate) const EDITS_SCHEDULES: &str = "add-schedule";
/// The same of control mixes.
pub(crate) const EDITS_MIXES: &str = "save-mix";

impl Store {
    /// Whether this device may make a request, by its word; a view that asks follows it.
    pub(crate) fn may(self, verb: &str) -> bool {
        self.entrance.access.with(|access| access.may(verb))
    }

    /// Whether it may; if not, a message says so.
    pub(crate) fn admits(self, verb: &str) -> bool {
        let may = self.entrance.access.with_untracked(|access| access.may(verb));
        if !may {
            self.tell_why_not(Wait::NotAllowed);
        }
        may
    }

    /// The same of a whole request.
    pub(crate) fn admits_request(self, body: &RequestBody) -> bool {
        let value = serde_json::to_value(body).unwrap_or_default();
        let verb = value.get("c").and_then(|verb| verb.as_str());
        self.admits(verb.unwrap_or_default())
    }
}

/// Controls that need a role: on a device with a lower one they are shown disabled, and say why.
#[component]
pub(crate) fn Needs(store: Store, verb: &'static str, children: Children) -> impl IntoView {
    let may = Memo::new(move |_| store.may(verb));
    view! {
        <fieldset
            class="needs"
            disabled=move || !may.get()
            title=move || (!may.get()).then(|| Wait::NotAllowed.text(words()))
        >
            {children()}
        </fieldset>
    }
}

/// Over a sheet that is read-only for this device.
#[component]
pub(crate) fn OnlyLooks(store: Store, verb: &'static str) -> impl IntoView {
    view! {
        <Show when=move || !store.may(verb)>
            <p class="hint only-looks" role="note">{words().offer.only_looks}</p>
        </Show>
    }
}
