//! What robots have learnt of themselves, and the word that a part was changed.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{LearntRobot, LearntRow, learnt_robots};
use rvac_api::{LearntPart, RequestBody};

use crate::access::{Needs, OnlyLooks};
use crate::focus::focus_soon_on;
use crate::history::date_text;
use crate::language::words;
use crate::store::Store;

/// A robot learns by the run, and a run ends while the sheet is open.
const RENEW_EVERY: Duration = Duration::from_secs(30);
/// A request that needs the same role as forgetting.
const FORGETS: &str = "forget-learnt";

/// The title takes the focus of a row that is gone.
const TITLE_ID: &str = "learnt-title";

/// What a person is about to delete.
type Asked = RwSignal<Option<(String, LearntPart)>>;

#[component]
pub(crate) fn LearntSection(store: Store) -> impl IntoView {
    store.ask_quietly(RequestBody::Learnt);
    if let Ok(renewal) = set_interval_with_handle(move || store.ask_quietly(RequestBody::Learnt), RENEW_EVERY)
    {
        on_cleanup(move || renewal.clear());
    }
    let robots = Memo::new(move |_| store.learnt.with(|devices| learnt_robots(words(), devices)));
    let asked = Asked::new(None);
    view! {
        <section id="learnt" aria-labelledby=TITLE_ID>
            <h3 id=TITLE_ID tabindex="-1">{words().learnt.title}</h3>
            <p class="hint" hidden=move || robots.with(|robots| !robots.is_empty())>
                {words().learnt.nothing}
            </p>
            <OnlyLooks store verb=FORGETS />
            {move || robots.get().into_iter().map(|known| robot(store, known, asked)).collect_view()}
        </section>
    }
}

fn robot(store: Store, known: LearntRobot, asked: Asked) -> impl IntoView {
    let device = known.device;
    let here = known
        .is_here
        .then(|| view! { <span class="newest">{words().learnt.here}</span> });
    let when = known
        .learnt_s
        .map(|learnt_s| words().learnt.when.fill([&date_text(Some(learnt_s))]));
    let title_id = format!("learnt-{device}");
    let rows = known
        .rows
        .into_iter()
        .map(|row| part(store, device.clone(), row, asked))
        .collect_view();
    view! {
        <h4 id=title_id.clone()>{device.to_uppercase()} " " {here}</h4>
        <ul class="rows learnt" aria-labelledby=title_id>{rows}</ul>
        <p class="hint">{when}</p>
    }
}

fn part(store: Store, device: String, row: LearntRow, asked: Asked) -> impl IntoView {
    let what = (device.clone(), row.part);
    let id = match row.part {
        LearntPart::Gyro => format!("forget-gyro-{device}"),
        LearntPart::Energy => format!("forget-energy-{device}"),
    };
    let of_this = what.clone();
    let is_asked = move || asked.with(|asked| asked.as_ref() == Some(&of_this));
    let is_open = is_asked.clone();
    let press = move |_| {
        asked.update(|asked| *asked = (asked.as_ref() != Some(&what)).then(|| what.clone()));
    };
    let label = words().learnt.forget_named.fill([&row.name, &device]);
    let button_id = id.clone();
    view! {
        <li>
            <span class="name">{row.name}</span>
            <span class="words">{row.words}</span>
            <Needs store verb=FORGETS>
                <button
                    type="button"
                    class="small"
                    id=id
                    aria-label=label
                    aria-expanded=move || if is_open() { "true" } else { "false" }
                    on:click=press
                >
                    {words().learnt.forget}
                </button>
            </Needs>
        </li>
        <Show when=is_asked>
            <Question store question=row.question back=button_id.clone() asked />
        </Show>
    }
}

/// What it means, and the buttons for it; the keys go to the one that keeps all as it is.
#[component]
fn Question(store: Store, question: &'static str, back: String, asked: Asked) -> impl IntoView {
    focus_soon_on("learnt-keep".to_owned());
    let forget = move |_| {
        if let Some((device, part)) = asked.get_untracked() {
            asked.set(None);
            store.forget_learnt(device, part);
            focus_soon_on(TITLE_ID.to_owned());
        }
    };
    let keep = move |_| {
        asked.set(None);
        focus_soon_on(back.clone());
    };
    view! {
        <li class="question">
            <p id="learnt-question">{question}</p>
            <button type="button" class="small strong" id="learnt-forget" aria-describedby="learnt-question" on:click=forget>{words().learnt.yes}</button>
            <button type="button" class="small" id="learnt-keep" aria-describedby="learnt-question" on:click=keep>{words().learnt.no}</button>
        </li>
    }
}
