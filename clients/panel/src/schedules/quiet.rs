//! The quiet hours.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;
use panel_logic::time_of_day;
use rvac_api::{QuietHours, RequestBody};

use super::clock_field::ClockField;
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
    let wrong = RwSignal::new(false);
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
        let [from, to] = [from, to].map(|typed| typed.with_untracked(|typed| time_of_day(typed)));
        let quiet = from.zip(to).map(|(from, to)| QuietHours { from, to });
        wrong.set(quiet.is_none());
        if quiet.is_some() {
            store.ask(RequestBody::SetQuiet { quiet });
        }
    };
    view! {
        <h3 id="quiet-title">{words().schedule.quiet}</h3>
        <p class="hint" id="quiet-words">{told}</p>
        <form class="order-tools quiet" aria-labelledby="quiet-title" on:input=move |_| wrong.set(false) on:submit=set>
            <ClockField id="quiet-from" label=words().schedule.from at=from change=Callback::new(move |at| from.set(at)) />
            <ClockField id="quiet-to" label=words().schedule.to at=to change=Callback::new(move |at| to.set(at)) />
            <button type="submit" class="small" id="set-quiet">{words().schedule.set}</button>
            <button
                type="button"
                class="small"
                id="no-quiet"
                on:click=move |_| store.ask(RequestBody::SetQuiet { quiet: None })
            >
                {words().schedule.no_quiet}
            </button>
            <p role="alert" id="quiet-wrong" class="wrong">{move || wrong.get().then_some(words().schedule.need_quiet)}</p>
        </form>
    }
}
