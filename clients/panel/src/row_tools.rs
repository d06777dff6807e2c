//! The actions of a row for something drawn: rename, reshape, remove.

use leptos::prelude::*;
use panel_logic::Target;

use crate::access::{EDITS_HOME, Needs};
use crate::language::words;
use crate::row_menu::RowMenu;
use crate::store::Store;

/// What the row shows.
#[derive(Clone, Debug)]
pub(crate) struct DrawnRow {
    /// What reshapes it; its number makes the names of the buttons unique, too.
    pub(crate) target: Target,
    /// First part of the names of its buttons, as in `rename-place-3`.
    pub(crate) kind: &'static str,
    pub(crate) number: u16,
    pub(crate) name: String,
}

#[component]
pub(crate) fn RowTools(
    store: Store,
    row: DrawnRow,
    /// The number of the row whose line for a name is open.
    renamed: RwSignal<Option<u16>>,
    remove: Callback<u16>,
) -> impl IntoView {
    let DrawnRow {
        target,
        kind,
        number,
        name,
    } = row;
    let is_renamed = move || renamed.get() == Some(number);
    view! {
        <Needs store verb=EDITS_HOME>
            <RowMenu of=format!("{kind}-{number}") name=name.clone()>
            <button
                type="button"
                class="small"
                id=format!("rename-{kind}-{number}")
                aria-label=words().home.rename_named.fill([&name])
                aria-expanded=move || if is_renamed() { "true" } else { "false" }
                on:click=move |_| renamed.update(|renamed| *renamed = (*renamed != Some(number)).then_some(number))
            >
                {words().frame.rename}
            </button>
            <button
                type="button"
                class="small"
                id=target.button_id()
                aria-label=words().map.reshape_named.fill([&name])
                on:click=move |_| store.begin_reshape(target)
            >
                {words().map.reshape}
            </button>
            <button
                type="button"
                class="small"
                id=format!("remove-{kind}-{number}")
                aria-label=words().home.remove_named.fill([&name])
                on:click=move |_| remove.run(number)
            >
                {words().frame.remove}
            </button>
            </RowMenu>
        </Needs>
    }
}
