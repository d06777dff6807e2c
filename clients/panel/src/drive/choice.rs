//! Which mix drives; a browser remembers it.

use leptos::prelude::*;
use mixer::{Name, Profile};

use super::Seat;

use crate::language::words;

/// Under this name the browser keeps it.
const KEY: &str = "mix";

/// What was chosen at an earlier visit.
pub(super) fn remembered() -> Option<Name> {
    let storage = window().local_storage().ok().flatten()?;
    Name::new(&storage.get_item(KEY).ok().flatten()?).ok()
}

/// Keeps the choice for the next visit.
pub(super) fn remember(name: Option<&Name>) {
    let Ok(Some(storage)) = window().local_storage() else {
        return;
    };
    // Without storage the choice lasts as long as the page.
    match name {
        Some(name) => storage.set_item(KEY, name.as_str()).ok(),
        None => storage.remove_item(KEY).ok(),
    };
}

#[component]
pub(super) fn MixChoice(seat: Seat) -> impl IntoView {
    let choose = move |event| seat.choose(Name::new(&event_target_value(&event)).ok());
    let option = move |profile: Profile| {
        let name = profile.name.to_string();
        let is_chosen = seat.chosen.get().as_ref() == Some(&profile.name);
        view! { <option value=name.clone() selected=is_chosen>{name.clone()}</option> }
    };
    view! {
        <label class="field mix-choice">
            {words().drive.mix}
            <select id="mix" on:change=choose>
                <option value="">{words().drive.standard}</option>
                {move || seat.kept.get().into_iter().map(option).collect_view()}
            </select>
        </label>
    }
}
