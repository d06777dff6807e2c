//! The log with a filter by level and a search.

use leptos::prelude::*;
use panel_logic::{LogFilter, clock_text};
use rvac_api::{LogEntry, LogLevel};

use crate::store::Store;

/// Entries that are shown at most: more would only make the page slow.
const SHOWN: usize = 200;

#[component]
pub(crate) fn LogView(store: Store) -> impl IntoView {
    let filter = RwSignal::new(LogFilter::default());
    let entries = move || {
        let filter = filter.get();
        store
            .log
            .with(|log| log.find(&filter, SHOWN).into_iter().cloned().collect::<Vec<_>>())
    };
    let choose_level = move |event| {
        let level_min = level_named(&event_target_value(&event));
        filter.update(|filter| filter.level_min = level_min);
    };
    view! {
        <div class="log">
            <div class="log-tools">
                <label class="field">
                    "Level"
                    <select id="log-level" on:change=choose_level>
                        <option value="debug">"Everything"</option>
                        <option value="info" selected>"Information"</option>
                        <option value="warn">"Warnings"</option>
                        <option value="error">"Errors"</option>
                    </select>
                </label>
                <label class="field grow">
                    "Search"
                    <input
                        type="search"
                        id="log-search"
                        autocomplete="off"
                        on:input=move |event| {
                            let search = event_target_value(&event);
                            filter.update(|filter| filter.search = search);
                        }
                    />
                </label>
            </div>
            <ol class="entries" id="log-entries" tabindex="0" aria-label="Log, newest first">
                <For each=entries key=|entry| entry.number let:entry>
                    {line(entry)}
                </For>
            </ol>
            <Show when=move || entries().is_empty()>
                <p class="hint">"No entry fits."</p>
            </Show>
        </div>
    }
}

fn level_named(name: &str) -> LogLevel {
    match name {
        "debug" => LogLevel::Debug,
        "warn" => LogLevel::Warn,
        "error" => LogLevel::Error,
        _ => LogLevel::Info,
    }
}

fn line(entry: LogEntry) -> impl IntoView {
    let (class, level) = match entry.level {
        LogLevel::Debug => ("debug", "Debug"),
        LogLevel::Info => ("info", "Info"),
        LogLevel::Warn => ("warn", "Warning"),
        LogLevel::Error => ("error", "Error"),
    };
    view! {
        <li class=class>
            <span class="when">{clock_text(entry.t)}</span>
            <span class="level">{level}</span>
            <span class="part">{entry.part}</span>
            <span class="what">{entry.text}</span>
        </li>
    }
}
