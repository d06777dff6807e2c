//! What groups of the editor have in common: their list, a head that unfolds them, and buttons that move or remove them.

use leptos::prelude::*;
use panel_logic::Group;

use super::Bench;

use crate::language::words;

/// The groups of one kind, of the class `kind`, and a button with the name `add-...` that adds one.
pub(super) fn group_list(
    kind: &'static str,
    (count, group): (
        Memo<usize>,
        impl Fn(usize) -> AnyView + Clone + Send + Sync + 'static,
    ),
    (id, label): (&'static str, &'static str),
    add: impl Fn() + 'static,
) -> impl IntoView {
    view! {
        <ol class=kind>
            <For each=move || 0..count.get() key=|place| *place children=group />
        </ol>
        <button type="button" class="small" id=id on:click=move |_| add()>{label}</button>
    }
}

/// Whether a switch, or the mode that hangs on one, is on.
pub(super) fn switch_state(is_on: Memo<bool>) -> impl IntoView {
    view! {
        <p class="switch-state" class:on=move || is_on.get()>
            {move || if is_on.get() { words().mix.on_now } else { words().mix.off_now }}
        </p>
    }
}

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
