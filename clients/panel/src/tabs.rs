//! Drive, home, schedules, history, decisions, device and log as tabs, with the keys that tabs have everywhere.

use leptos::ev::KeyboardEvent;
use leptos::prelude::*;

use crate::drive::DriveSheet;
use crate::focus::focus_on;
use crate::home_view::HomePart;
use crate::language::words;
use crate::store::Store;

const TABS: [&str; 7] = ["drive", "home", "schedules", "history", "why", "device", "log"];

/// What the tabs are called, in the same order.
fn titles() -> [&'static str; 7] {
    let texts = &words().frame;
    [
        texts.drive,
        texts.home,
        texts.schedules,
        texts.history,
        texts.why,
        texts.device,
        texts.log,
    ]
}

/// Under this name the browser keeps which tab was open, as long as its own tab is.
const KEY: &str = "tab";

/// The tab that was open before the page was loaded again.
fn kept_tab() -> usize {
    let storage = window().session_storage().ok().flatten();
    let kept = storage.and_then(|storage| storage.get_item(KEY).ok().flatten());
    TABS.iter()
        .position(|tab| kept.as_deref() == Some(*tab))
        .unwrap_or_default()
}

fn keep_tab(open: usize) {
    if let (Ok(Some(storage)), Some(tab)) = (window().session_storage(), TABS.get(open)) {
        storage.set_item(KEY, tab).ok(); // Without storage the first tab opens again.
    }
}

#[component]
pub(crate) fn Tabs(store: Store) -> impl IntoView {
    let open = RwSignal::new(kept_tab());
    let home_part = RwSignal::new(HomePart::Rooms);
    let late = store.late;
    Effect::new(move |_| keep_tab(open.get()));
    let on_key = move |event: KeyboardEvent| {
        let now = open.get_untracked();
        let next = match event.key().as_str() {
            "ArrowRight" => (now + 1) % TABS.len(),
            "ArrowLeft" => (now + TABS.len() - 1) % TABS.len(),
            "Home" => 0,
            "End" => TABS.len() - 1,
            _ => return,
        };
        event.prevent_default();
        open.set(next);
        focus_on(&format!("tab-{}", TABS[next]));
    };
    let tab = move |index: usize| {
        let (id, label) = (TABS[index], titles()[index]);
        view! {
            <button
                type="button"
                role="tab"
                id=format!("tab-{id}")
                aria-controls=format!("sheet-{id}")
                aria-selected=move || if open.get() == index { "true" } else { "false" }
                tabindex=move || if open.get() == index { "0" } else { "-1" }
                on:click=move |_| open.set(index)
            >
                {label}
            </button>
        }
    };
    view! {
        <section class="card tabs" aria-label=words().frame.details>
            <div role="tablist" aria-label=words().frame.details on:keydown=on_key>
                {(0..TABS.len()).map(tab).collect_view()}
            </div>
            <div role="tabpanel" id="sheet-drive" aria-labelledby="tab-drive" hidden=move || open.get() != 0>
                <DriveSheet store />
            </div>
            <div role="tabpanel" id="sheet-home" aria-labelledby="tab-home" hidden=move || open.get() != 1>
                <Show when=move || open.get() == 1>{late.view(move |views| (views.home)(store, home_part))}</Show>
            </div>
            <div role="tabpanel" id="sheet-schedules" aria-labelledby="tab-schedules" hidden=move || open.get() != 2>
                <Show when=move || open.get() == 2>{late.view(move |views| (views.schedules)(store))}</Show>
            </div>
            <div role="tabpanel" id="sheet-history" aria-labelledby="tab-history" hidden=move || open.get() != 3>
                <Show when=move || open.get() == 3>{late.view(move |views| (views.history)(store))}</Show>
            </div>
            <div role="tabpanel" id="sheet-why" aria-labelledby="tab-why" hidden=move || open.get() != 4>
                <Show when=move || open.get() == 4>{late.view(move |views| (views.why)(store))}</Show>
            </div>
            <div role="tabpanel" id="sheet-device" aria-labelledby="tab-device" hidden=move || open.get() != 5>
                <Show when=move || open.get() == 5>{late.view(move |views| (views.device)(store))}</Show>
            </div>
            <div role="tabpanel" id="sheet-log" aria-labelledby="tab-log" hidden=move || open.get() != 6>
                <Show when=move || open.get() == 6>{late.view(move |views| (views.log)(store))}</Show>
            </div>
        </section>
    }
}
