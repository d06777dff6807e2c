//! From where the map is seen is kept for the next visit.

use leptos::prelude::window;
use panel_logic::Orbit;

const KEY: &str = "map-view";

/// What was kept; straight above when nothing was.
pub(super) fn kept_view() -> Option<Orbit> {
    let storage = window().local_storage().ok().flatten()?;
    Orbit::from_text(&storage.get_item(KEY).ok().flatten()?)
}

/// Keeps it, if it is not what is kept.
pub(super) fn keep_view(orbit: Option<Orbit>) {
    let Ok(Some(storage)) = window().local_storage() else {
        return; // Without storage the view lasts as long as the page.
    };
    let text = orbit.map(Orbit::to_text).unwrap_or_default();
    let kept = storage.get_item(KEY).ok().flatten().unwrap_or_default();
    if kept != text {
        storage.set_item(KEY, &text).ok(); // The same.
    }
}
