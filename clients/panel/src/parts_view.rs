//! How worn or dirty parts are, for how long they have worked, and the word that one was cleaned or replaced.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{HoursRow, PartRow, part_rows};
use rvac_api::RequestBody;

use crate::access::{Needs, OnlyLooks};
use crate::history::date_text;
use crate::icons::{Icon, icon};
use crate::language::words;
use crate::store::Store;

/// Loads are measured by the minute.
const RENEW_EVERY: Duration = Duration::from_secs(30);

#[component]
pub(crate) fn PartsView(store: Store) -> impl IntoView {
    store.ask_quietly(RequestBody::Health);
    if let Ok(renewal) = set_interval_with_handle(move || store.ask_quietly(RequestBody::Health), RENEW_EVERY)
    {
        on_cleanup(move || renewal.clear());
    }
    let measures = Memo::new(move |_| {
        store.robot.with(|robot| {
            robot
                .as_ref()
                .is_some_and(|robot| robot.parts.iter().any(|part| part == "currents"))
        })
    });
    let rows = Memo::new(move |_| {
        store
            .health
            .with(|parts| part_rows(words(), parts, measures.get()))
    });
    let has_hours = move || rows.with(|rows| rows.iter().any(|row| row.hours.is_some()));
    view! {
        <Show when=move || rows.with(|rows| !rows.is_empty())>
            <section aria-labelledby="parts-title">
                <h3 id="parts-title">{words().health.title}</h3>
                <OnlyLooks store verb="reset-health" />
                <ul id="parts" class="rows parts">
                    {move || rows.get().into_iter().map(|part| row(store, part)).collect_view()}
                </ul>
                <Show when=move || measures.get()><p class="hint">{words().health.share_of}</p></Show>
                <Show when=has_hours><p class="hint">{words().health.counted}</p></Show>
            </section>
        </Show>
    }
}

fn row(store: Store, part: PartRow) -> impl IntoView {
    let component = part.component;
    let loaded = part.load.map(|load| {
        let label = words().health.cleaned_named.fill([&part.name]);
        let (id, component) = (format!("cleaned-{component}"), component.clone());
        let cleaned = move |_| {
            store.ask(RequestBody::ResetHealth {
                component: component.clone(),
            });
        };
        view! {
            <div class="part-line">
                <span class="words">{load}</span>
                <Needs store verb="reset-health">
                    <button type="button" class="small" id=id.clone() aria-label=label.clone() on:click=cleaned.clone()>
                        {words().health.cleaned}
                    </button>
                </Needs>
            </div>
        }
    });
    let hours = part.hours.map(|hours| hours_row(store, component, hours));
    let remedy = (!part.remedy.is_empty())
        .then(|| view! { <p class="remark">{icon(Icon::Warning)} {part.remedy}</p> });
    view! {
        <li>
            <span class="name">{part.name}</span>
            {loaded}
            {hours}
            {remedy}
        </li>
    }
}

fn hours_row(store: Store, component: String, hours: HoursRow) -> impl IntoView {
    let id = format!("renewed-{component}");
    let said = hours.was_done;
    let done = move |_| store.renew_part(component.clone(), said.clone());
    let since = hours
        .since_s
        .map(|since_s| words().health.since.fill([&date_text(Some(since_s))]));
    let width = format!("{:.0}%", hours.share * 100.0);
    view! {
        <div class="part-line">
            <span class="words">
                {hours.words} " " {since}
                <span class="worked" class:alarming=hours.is_due aria-hidden="true">
                    <span style:width=width></span>
                </span>
            </span>
            <Needs store verb="renew-part">
                <button type="button" class="small" id=id.clone() aria-label=hours.done_named.clone() on:click=done.clone()>
                    {hours.done}
                </button>
            </Needs>
        </div>
    }
}
