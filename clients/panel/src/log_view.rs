//! The log with a filter by level and a search.

use leptos::prelude::*;
use panel_logic::{LogFilter, clock_text, log_text};
use rvac_api::{LogEntry, LogLevel};

use crate::language::words;
use crate::store::Store;

/// Entries that are shown at most: more would only make the page slow.
const SHOWN: usize = 200;

#[component]
pub(crate) fn LogView(store: Store) -> impl IntoView {
    let filter = RwSignal::new(LogFilter::default());
    let entries = move || {
        let filter = filter.get();
        store.log.with(|log| {
            log.find(words(), &filter, SHOWN)
                .into_iter()
                .cloned()
                .collect::<Vec<_>>()
        })
    };
    let choose_level = move |event| {
        let level_min = level_named(&event_target_value(&event));
        filter.update(|filter| filter.level_min = level_min);
    };
    view! {
        <div class="log">
            <div class="log-tools">
                <label class="field">
                    {words().log.level}
                    <select id="log-level" on:change=choose_level>
                        <option value="debug">{words().log.everything}</option>
                        <option value="info" selected>{words().log.information}</option>
                        <option value="warn">{words().log.warnings}</option>
                        <option value="error">{words().log.errors}</option>
                    </select>
                </label>
                <label class="field grow">
                    {words().log.search}
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
            <ol class="entries" id="log-entries" tabindex="0" aria-label=words().log.entries>
                <For each=entries key=|entry| entry.number let:entry>
                    {line(store, entry)}
                </For>
            </ol>
            <Show when=move || entries().is_empty()>
                <p class="hint">{words().log.none_fits}</p>
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

fn line(store: Store, entry: LogEntry) -> impl IntoView {
    let (class, level) = match entry.level {
        LogLevel::Debug => ("debug", words().log.debug),
        LogLevel::Info => ("info", words().log.info),
        LogLevel::Warn => ("warn", words().log.warn),
        LogLevel::Error => ("error", words().log.error),
    };
    let (text, is_told) = log_text(words(), &entry);
    view! {
        <li class=class>
            <span class="when" title=words().log.since_start.fill([&clock_text(entry.t)])>{store.wall_text(entry.t)}</span>
            <span class="level">{level}</span>
            <span class="part">{entry.part}</span>
            <span class="what" lang=(!is_told).then_some("en")>{text}</span>
        </li>
    }
}
