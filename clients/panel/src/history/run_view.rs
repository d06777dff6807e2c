//! One run.

use leptos::prelude::*;
use panel_logic::{StopRow, run_figures, run_text, stop_rows};
use rvac_api::{Run, RunRecord};

use super::date_text;
use super::player::Player;
use crate::evidence_view::EvidenceView;
use crate::focus::focus_soon_on;
use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn RunView(store: Store) -> impl IntoView {
    let desk = store.history;
    let back = move |_| {
        let shown = desk.chosen.get_untracked();
        desk.chosen.set(None);
        if let Some(number) = shown {
            focus_soon_on(format!("run-{number}-open"));
        }
    };
    view! {
        <div class="draw-tools">
            <button type="button" class="small" id="all-runs" on:click=back>{words().history.all}</button>
        </div>
        <p class="wrong" id="run-wrong" role="status">{move || desk.wrong.get()}</p>
        {move || desk.record.get().map(|record| run(store, record))}
    }
}

fn run(store: Store, record: RunRecord) -> impl IntoView {
    let kept = &record.run;
    let (number, text) = (kept.number, run_text(words(), kept));
    let heading = words().history.run.fill([&number, &date_text(kept.start_s)]);
    let figures = run_figures(words(), kept);
    let stops = stop_rows(words(), &record);
    let left_out = (kept.stop_count as usize).saturating_sub(stops.len());
    let download = download(kept);
    let time = RwSignal::new(0.0_f64);
    let (has_stops, has_more) = (!stops.is_empty(), left_out > 0);
    let record = StoredValue::new(record);
    view! {
        <h3 id="run-title">{heading}</h3>
        <p id="run-result" class="remark">{text}</p>
        <Player store record time />
        <Show when=move || has_stops>
            <h3 id="stops-title">{words().history.stops}</h3>
        </Show>
        <ol id="run-stops" class="sentences" aria-label=words().history.stops>
            {stops.into_iter().map(|stop| stop_line(stop, time)).collect_view()}
        </ol>
        <Show when=move || has_more>
            <p class="hint">{words().history.more_stops.fill([&left_out])}</p>
        </Show>
        <h3>{words().history.figures}</h3>
        <dl class="run-figures">
            {figures.into_iter().map(|(what, value)| view! { <dt>{what}</dt><dd>{value}</dd> }).collect_view()}
        </dl>
        <h3>{words().history.report}</h3>
        <div class="draw-tools">{download}</div>
    }
}

/// A stop, with a button that shows the moment.
fn stop_line(
    StopRow {
        number,
        at_s,
        words: sentence,
        evidence,
    }: StopRow,
    time: RwSignal<f64>,
) -> impl IntoView {
    view! {
        <li class="stop">
            <button
                type="button"
                class="small choose"
                aria-label=words().history.show_stop.fill([&number])
                on:click=move |_| time.set(at_s)
            >
                {number}
            </button>
            <div>
                <span>{sentence}</span>
                {(!evidence.is_empty()).then(|| view! { <EvidenceView evidence /> })}
            </div>
        </li>
    }
}

/// A link that saves all recordings that are there as one file.
fn download(run: &Run) -> AnyView {
    let there = run
        .recordings
        .iter()
        .filter(|recording| recording.bytes.is_some());
    let bytes = there.clone().filter_map(|recording| recording.bytes).sum::<u64>();
    let hint = match (run.recordings.len(), there.count()) {
        (0, _) => Some(words().history.not_recorded),
        (_, 0) => Some(words().history.recording_gone),
        (all, left) => (left < all).then_some(words().history.recording_part_gone),
    };
    let address = format!("/api/runs/{}/recording", run.number);
    let text = words()
        .history
        .save_recording
        .fill([&words().number(bytes as f64 / 1e6, 1)]);
    let link = (bytes > 0).then(|| {
        view! { <a class="small link" id="save-recording" href=address download="">{text}</a> }
    });
    let hint = hint.map(|hint| view! { <p class="hint">{hint}</p> });
    view! { {link}{hint} }.into_any()
}
