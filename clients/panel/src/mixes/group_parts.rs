//! What groups of the editor have in common: a head that unfolds them, and buttons that move or remove them.

use leptos::prelude::*;
use panel_logic::Group;

use super::Bench;

use crate::language::words;

/// The head of a group, which unfolds it.
#[component]
pub(super) fn Unfold(
    open: RwSignal<bool>,
    #[prop(optional, into)] id: Option<String>,
    children: Children,
) -> impl IntoView {
    view! {
        <button
            type="button"
            class="unfold"
            id=id
            aria-expanded=move || if open.get() { "true" } else { "false" }
            on:click=move |_| open.update(|open| *open = !*open)
        >
            {children()}
        </button>
    }
}

/// Moves a group before the one above it, or removes it; `remove` is the button's text.
#[component]
pub(super) fn GroupTools(bench: Bench, group: Group, is_first: bool, remove: &'static str) -> impl IntoView {
    view! {
        <div class="mix-tools">
            <button
                type="button"
                class="small"
                aria-disabled=if is_first { "true" } else { "false" }
                on:click=move |_| bench.rearrange(|draft| draft.move_up(group))
            >
                {words().mix.move_up}
            </button>
            <button type="button" class="small" on:click=move |_| bench.remove(group)>{remove}</button>
        </div>
    }
}
