//! The quiet hours.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;
use rvac_api::{QuietHours, RequestBody};

use crate::language::words;
use crate::store::Store;

#[component]
pub(super) fn QuietView(store: Store) -> impl IntoView {
    let desk = store.schedules;
    let known = Memo::new(move |_| desk.with(|known| known.quiet.clone()));
    let (from, to) = (
        RwSignal::new("22:00".to_owned()),
        RwSignal::new("07:00".to_owned()),
    );
    Effect::new(move |_| {
        if let Some(quiet) = known.get() {
            from.set(quiet.from);
            to.set(quiet.to);
        }
    });
    let told = move || match known.get() {
        Some(QuietHours { from, to }) => words().schedule.quiet_are.fill([&from, &to]),
        None => words().schedule.quiet_none.to_owned(),
    };
    let set = move |event: SubmitEvent| {
        event.prevent_default();
        let quiet = Some(QuietHours {
            from: from.get_untracked().chars().take(5).collect(),
            to: to.get_untracked().chars().take(5).collect(),
        });
        store.ask(RequestBody::SetQuiet { quiet });
    };
    let time = move |id: &'static str, label: &'static str, text: RwSignal<String>| {
        view! {
            <label class="field">
                {label}
                <input
                    id=id
                    type="time"
                    prop:value=move || text.get()
                    on:input=move |event| text.set(event_target_value(&event))
                />
            </label>
        }
    };
    view! {
        <h3 id="quiet-title">{words().schedule.quiet}</h3>
        <p class="hint" id="quiet-words">{told}</p>
        <form class="order-tools quiet" aria-labelledby="quiet-title" on:submit=set>
            {time("quiet-from", words().schedule.from, from)}
            {time("quiet-to", words().schedule.to, to)}
            <button type="submit" class="small" id="set-quiet">{words().schedule.set}</button>
            <button
                type="button"
                class="small"
                id="no-quiet"
                on:click=move |_| store.ask(RequestBody::SetQuiet { quiet: None })
            >
                {words().schedule.no_quiet}
            </button>
        </form>
    }
}
