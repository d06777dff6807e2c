//! What all runs come to: one line, and its figures on a press.

use leptos::prelude::*;
use panel_logic::{statistics_headline, statistics_rows};

use super::date_text;
use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn LifetimeView(store: Store) -> impl IntoView {
    let sums = store.history.lifetime;
    let headline = Memo::new(move |_| {
        sums.with(|sums| sums.as_ref().and_then(|sums| statistics_headline(words(), sums)))
    });
    let rows = Memo::new(move |_| {
        sums.with(|sums| sums.as_ref().map(|sums| statistics_rows(words(), sums)))
            .unwrap_or_default()
    });
    let since = move || {
        let since_s = sums.with(|sums| sums.as_ref().and_then(|sums| sums.since_s))?;
        Some(words().history.since_day.fill([&date_text(Some(since_s))]))
    };
    view! {
        <Show when=move || headline.get().is_some()>
            <details class="folded" id="lifetime">
                <summary>{move || headline.get()}</summary>
                <dl class="run-figures">{move || rows.get().into_iter().map(row).collect_view()}</dl>
                <p class="hint">{since}</p>
            </details>
        </Show>
    }
}

fn row((what, said): (String, String)) -> impl IntoView {
    view! {
        <dt>{what}</dt>
        <dd>{said}</dd>
    }
}
