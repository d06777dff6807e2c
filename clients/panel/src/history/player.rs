//! The picture of a run, and the run seen again along its recording.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{Plot, Replay, clock_text, plots, read_decimal, run_drawing};
use rvac_api::RunRecord;

use crate::language::words;
use crate::store::Store;

/// Pause between two pictures of a replay.
const STEP: Duration = Duration::from_millis(100);
/// Diameter for a robot without description: the picture needs some width.
const SWATH_M: f64 = 0.25;
const RADIUS_M: f64 = 0.17;
/// How many times as fast as it was.
const SPEEDS: [(&str, f64); 4] = [("1", 1.0), ("8", 8.0), ("32", 32.0), ("128", 128.0)];

/// How far a replay has come.
#[derive(Clone, Copy, Debug)]
struct PlayTime {
    now_s: RwSignal<f64>,
    /// Of the run.
    end_s: f64,
}

#[component]
pub(crate) fn Player(store: Store, record: StoredValue<RunRecord>, time: RwSignal<f64>) -> impl IntoView {
    let desk = store.history;
    let replay = Memo::new(move |_| {
        desk.track
            .with(|track| track.as_ref().map(Replay::new))
            .filter(|replay| replay.end_s() > 0.0)
    });
    let end_s = record.with_value(|record| record.run.duration_s.max(1.0));
    // At first the whole run is seen.
    time.set(end_s);
    let play = PlayTime { now_s: time, end_s };
    let (plays, speed) = (RwSignal::new(false), RwSignal::new(32.0_f64));
    let step = move || {
        if plays.get_untracked() {
            let next_s = time.get_untracked() + speed.get_untracked() * STEP.as_secs_f64();
            time.set(next_s.min(end_s));
            plays.set(next_s < end_s);
        }
    };
    if let Ok(timer) = set_interval_with_handle(step, STEP) {
        on_cleanup(move || timer.clear());
    }
    let press = move |_| {
        let begins = !plays.get_untracked();
        if begins && time.get_untracked() >= end_s {
            time.set(0.0);
        }
        plays.set(begins);
    };
    let slide = move |event| {
        if let Some(value) = read_decimal(&event_target_value(&event)) {
            plays.set(false);
            time.set(value);
        }
    };
    view! {
        {picture(store, record, replay, play)}
        <Show
            when=move || replay.with(Option::is_some)
            fallback=|| view! { <p class="hint">{words().history.no_replay}</p> }
        >
            <div class="replay-tools">
                <button type="button" class="small strong" id="replay-play" on:click=press>
                    {move || if plays.get() { words().history.pause } else { words().history.play }}
                </button>
                <input
                    type="range"
                    id="replay-time"
                    aria-label=words().history.time
                    min="0"
                    max=end_s
                    step="0.5"
                    prop:value=move || time.get()
                    aria-valuetext=move || clock_text(time.get())
                    on:input=slide
                />
                <span class="replay-clock" id="replay-clock">{move || clock_text(time.get())}</span>
                {speed_choice(speed)}
            </div>
        </Show>
        {move || {
            let plots = desk.track.with(|track| track.as_ref().map(|track| plots(words(), track, end_s)));
            plots.unwrap_or_default().into_iter().map(|plot| plot_view(plot, play)).collect_view()
        }}
    }
}

fn speed_choice(speed: RwSignal<f64>) -> impl IntoView {
    let choose = move |event| speed.set(read_decimal(&event_target_value(&event)).unwrap_or(1.0));
    view! {
        <label class="field">
            <span class="visually-hidden">{words().history.speed}</span>
            <select id="replay-speed" on:change=choose>
                {SPEEDS.map(|(name, factor)| view! {
                    <option value=name selected=factor == 32.0>{format!("{name}×")}</option>
                }).collect_view()}
            </select>
        </label>
    }
}

fn picture(
    store: Store,
    record: StoredValue<RunRecord>,
    replay: Memo<Option<Replay>>,
    play: PlayTime,
) -> impl IntoView {
    let time = play.now_s;
    let drawing = record.with_value(|record| record.picture.as_ref().map(run_drawing).unwrap_or_default());
    let [left, top, width, height] = drawing.view_box;
    let (swath_m, radius_m) = store.robot.with_untracked(|robot| {
        robot
            .as_ref()
            .map_or((SWATH_M, RADIUS_M), |robot| (robot.swath_m, robot.radius_m))
    });
    let swept_is_whole = move || time.get() >= play.end_s || replay.with(Option::is_none);
    let sweeps = record.with_value(|record| {
        record
            .picture
            .as_ref()
            .is_some_and(|picture| !picture.swept_rows.is_empty())
    });
    let (swept, path) = (drawing.swept, drawing.path);
    let driven = move || {
        replay.with(|replay| {
            replay
                .as_ref()
                .map(|replay| replay.path_until(time.get()))
                .unwrap_or_default()
        })
    };
    let robot = move || {
        replay
            .with(|replay| replay.as_ref().and_then(|replay| replay.robot_at(time.get())))
            .map(|(x, y, turn)| format!("translate({x:.1} {y:.1}) rotate({turn:.0})"))
    };
    let text = record.with_value(|record| {
        let swept = words().number(record.run.swept_m2, 0);
        words().history.picture.fill([&swept, &record.run.stop_count])
    });
    let radius_cm = 100.0 * radius_m;
    view! {
        <svg
            class="run-picture"
            id="run-picture"
            role="img"
            aria-label=text
            viewBox=format!("{left} {top} {width} {height}")
        >
            <path class="floor" d=drawing.floor />
            <path class="walls" d=drawing.walls />
            <path class="swept" d=move || if swept_is_whole() { swept.clone() } else { String::new() } />
            <path
                class="sweeping"
                stroke-width=100.0 * swath_m
                d=move || if swept_is_whole() || !sweeps { String::new() } else { driven() }
            />
            <path class="way" d=move || if swept_is_whole() { path.clone() } else { driven() } />
            <g class="robot" id="replay-robot" transform=move || robot().unwrap_or_default() hidden=move || robot().is_none()>
                <circle r=radius_cm />
                <path d=format!("M0 0H{radius_cm:.0}") />
            </g>
            {marks(record)}
        </svg>
    }
}

/// Numbers where it stopped or waited.
fn marks(record: StoredValue<RunRecord>) -> impl IntoView {
    let places = record.with_value(|record| {
        let stops = record
            .stops
            .iter()
            .map(|stop| (100.0 * stop.place.x, -100.0 * stop.place.y));
        stops.collect::<Vec<_>>()
    });
    let mark = |(index, (x, y)): (usize, (f64, f64))| {
        view! {
            <g class="stop-mark" transform=format!("translate({x:.0} {y:.0})")>
                <circle r="14" />
                <text text-anchor="middle" dy="6">{index + 1}</text>
            </g>
        }
    };
    places.into_iter().enumerate().map(mark).collect_view()
}

fn plot_view(plot: Plot, play: PlayTime) -> impl IntoView {
    let names = plot
        .lines
        .iter()
        .map(|(name, _)| *name)
        .collect::<Vec<_>>()
        .join(", ");
    let label = words()
        .history
        .plot
        .fill([&plot.title, &names, &plot.low, &plot.high]);
    let is_alone = plot.lines.len() == 1;
    let at = move || format!("{:.1}", 300.0 * (play.now_s.get() / play.end_s).clamp(0.0, 1.0));
    let line = |(index, (_, path)): (usize, &(&'static str, String))| {
        view! { <path class=format!("line line-{index}") d=path.clone() vector-effect="non-scaling-stroke" /> }
    };
    let key = |(index, (name, _)): (usize, &(&'static str, String))| {
        view! { <li><span class=format!("plot-key line-{index}")></span>{*name}</li> }
    };
    let keys = (!is_alone).then(|| plot.lines.iter().enumerate().map(key).collect_view());
    view! {
        <figure class="plot">
            <figcaption>{plot.title}</figcaption>
            <span class="edge high">{plot.high}</span>
            <svg viewBox="0 -2 300 64" preserveAspectRatio="none" role="img" aria-label=label>
                {plot.lines.iter().enumerate().map(line).collect_view()}
                <line class="now-line" y1="-2" y2="62" x1=at x2=at vector-effect="non-scaling-stroke" />
            </svg>
            <span class="edge low">{plot.low}</span>
            <ul class="plot-keys">{keys}</ul>
        </figure>
    }
}
