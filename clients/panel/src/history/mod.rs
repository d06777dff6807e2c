//! Runs that are over: a list, and one of them with its picture, replay, plots, stops and recording.

mod lifetime_view;
mod player;
mod run_view;

use leptos::prelude::*;
use panel_logic::{RunRow, refusal_text, run_rows};
use rvac_api::{Failure, RequestBody, Run, RunRecord, RunTrack, Statistics};
use wasm_bindgen::JsValue;

use crate::focus::focus_soon_on;
use crate::language::words;
use crate::store::{RUN_ID, Store};
use lifetime_view::LifetimeView;
use run_view::RunView;

/// Handles on all of it; cheap to copy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HistoryDesk {
    runs: RwSignal<Vec<Run>>,
    /// There are older ones.
    more: RwSignal<bool>,
    /// An answer continues the list.
    extends: RwSignal<bool>,
    /// What all runs come to.
    lifetime: RwSignal<Option<Statistics>>,
    /// The run that is shown, by its number.
    chosen: RwSignal<Option<u64>>,
    record: RwSignal<Option<RunRecord>>,
    track: RwSignal<Option<RunTrack>>,
    /// Why there is no more to see of it.
    wrong: RwSignal<Option<String>>,
}

impl HistoryDesk {
    pub(crate) fn new() -> Self {
        Self {
            runs: RwSignal::new(Vec::new()),
            more: RwSignal::new(false),
            extends: RwSignal::new(false),
            lifetime: RwSignal::new(None),
            chosen: RwSignal::new(None),
            record: RwSignal::new(None),
            track: RwSignal::new(None),
            wrong: RwSignal::new(None),
        }
    }

    pub(crate) fn on_runs(self, runs: Vec<Run>, more: bool) {
        self.more.set(more);
        if self.extends.get_untracked() {
            self.runs.update(|known| known.extend(runs));
        } else {
            self.runs.set(runs);
        }
        self.extends.set(false);
    }

    /// What all runs come to, if that was asked for.
    pub(crate) fn statistics(self) -> Option<Statistics> {
        self.lifetime.get_untracked()
    }

    /// The runs of the list.
    pub(crate) fn known_runs(self) -> Vec<Run> {
        self.runs.get_untracked()
    }

    pub(crate) fn on_statistics(self, sums: Statistics) {
        self.lifetime.set(Some(sums));
    }

    /// The run that ended last; a view that asks follows it.
    pub(crate) fn newest(self) -> Option<Run> {
        self.runs.with(|runs| runs.first().cloned())
    }

    /// A run is over.
    pub(crate) fn on_kept(self, run: Run) {
        self.runs.update(|known| {
            known.retain(|other| other.number != run.number);
            known.insert(0, run);
        });
    }

    pub(crate) fn on_record(self, record: RunRecord) {
        if self.chosen.get_untracked() == Some(record.run.number) {
            self.record.set(Some(record));
        }
    }

    pub(crate) fn on_track(self, track: RunTrack) {
        if self.chosen.get_untracked() == Some(track.number) {
            self.track.set(Some(track));
        }
    }

    /// Whether the refusal concerns the shown run, beside which it is displayed.
    pub(crate) fn on_failed(self, failure: &Failure) -> bool {
        let is_ours = failure.id == Some(RUN_ID);
        if is_ours {
            self.wrong
                .set(Some(refusal_text(words(), &failure.reason, &failure.text)));
        }
        is_ours
    }
}

impl Store {
    fn list_runs(self) {
        self.history.extends.set(false);
        self.ask_quietly(RequestBody::Runs {
            before: None,
            count: None,
        });
    }

    /// What all runs come to changes with each that ends; whoever has never looked at it is not told.
    pub(crate) fn renew_lifetime(self) {
        if self.history.lifetime.with_untracked(Option::is_some) {
            self.ask_quietly(RequestBody::Statistics);
        }
    }

    fn list_older_runs(self) {
        let desk = self.history;
        let before = desk.runs.with_untracked(|runs| runs.last().map(|run| run.number));
        desk.extends.set(true);
        self.ask_quietly(RequestBody::Runs { before, count: None });
    }

    fn show_run(self, number: u64) {
        let desk = self.history;
        desk.record.set(None);
        desk.track.set(None);
        desk.wrong.set(None);
        desk.chosen.set(Some(number));
        focus_soon_on("all-runs".to_owned());
        self.ask_as(RUN_ID, RequestBody::Run { number });
        let is_recorded =
            |run: &Run| run.number == number && run.recordings.iter().any(|found| found.bytes.is_some());
        if desk.runs.with_untracked(|runs| runs.iter().any(is_recorded)) {
            self.ask_as(
                RUN_ID,
                RequestBody::RunTrack {
                    number,
                    recording: None,
                },
            );
        }
    }
}

#[component]
pub(crate) fn HistorySheet(store: Store) -> impl IntoView {
    let desk = store.history;
    // A page that is loaded anew may show its history before it is connected.
    Effect::new(move |_| {
        store.opened.track();
        store.list_runs();
        store.ask_quietly(RequestBody::Statistics);
    });
    let rows = move || desk.runs.with(|runs| run_rows(words(), runs));
    view! {
        <div class="home" id="history-sheet">
            <Show
                when=move || desk.chosen.get().is_some()
                fallback=move || view! {
                    <LifetimeView store />
                    <h3 id="runs-title">{words().history.runs}</h3>
                    <ul id="runs" class="rows runs" aria-labelledby="runs-title">
                        <For each=rows key=|row| row.number let:row>
                            {run_button(store, row)}
                        </For>
                    </ul>
                    <Show when=move || desk.runs.with(Vec::is_empty)>
                        <p class="hint">{words().history.none}</p>
                    </Show>
                    <Show when=move || desk.more.get()>
                        <div class="draw-tools">
                            <button type="button" class="small" id="older-runs" on:click=move |_| store.list_older_runs()>
                                {words().history.older}
                            </button>
                        </div>
                    </Show>
                }
            >
                <RunView store />
            </Show>
        </div>
    }
}

fn run_button(store: Store, row: RunRow) -> impl IntoView {
    let number = row.number;
    view! {
        <li>
            <button
                type="button"
                class="run"
                id=format!("run-{number}-open")
                class:alarming=row.is_bad
                on:click=move |_| store.show_run(number)
            >
                <span class="name">{words().history.numbered.fill([&number, &date_text(row.start_s)])}</span>
                <span class="result">{row.words}</span>
                <span class="words">{row.figures}</span>
            </button>
        </li>
    }
}

/// A time as clocks here show it.
pub(crate) fn date_text(utc_s: Option<i64>) -> String {
    let Some(utc_s) = utc_s else {
        return words().history.no_clock.to_owned();
    };
    let date = js_sys::Date::new(&JsValue::from_f64(1000.0 * utc_s as f64));
    let two = |number: u32| format!("{number:02}");
    let time = format!("{}:{}", two(date.get_hours()), two(date.get_minutes()));
    let (month, day) = (two(date.get_month() + 1), two(date.get_date()));
    words()
        .unit
        .date
        .fill([&date.get_full_year(), &month, &day, &time])
}
