//! Signals that wake their readers only when the value changes.

use leptos::prelude::*;

/// Sets the signal unless it holds the same already: the robot repeats itself, and the page is not to be drawn again for that.
pub(crate) fn set_if_changed<T: PartialEq + Send + Sync + 'static>(signal: RwSignal<T>, value: T) {
    if signal.with_untracked(|known| *known != value) {
        signal.set(value);
    }
}
