//! Where the dock is, and how to report that it was moved.

use leptos::prelude::*;
use panel_logic::Tool;

use crate::access::{EDITS_HOME, Needs};
use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn DockPlace(store: Store) -> impl IntoView {
    let known = store.orders.dock;
    view! {
        <Show when=move || known.with(Option::is_some)>
            <h3 id="dock-title">{words().home.dock}</h3>
            <p class="hint" id="dock-place">{move || known.get()}</p>
            <div class="draw-tools">
                <Needs store verb=EDITS_HOME>
                    <button type="button" class="small" id="draw-dock" on:click=move |_| store.take_tool(Tool::Dock)>
                        {words().home.draw_dock}
                    </button>
                </Needs>
            </div>
        </Show>
    }
}
