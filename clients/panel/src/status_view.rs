//! What the robot is doing and why, in words, and the figures of the job.

use leptos::prelude::*;
use panel_logic::{
    Explanation, JobProgress, area_text, clock_text, decision_text, distance_text, explain, headline,
    percent_text, place_text, state_title, strategy_title,
};
use rvac_api::Status;

use crate::actions::PatternChoice;
use crate::evidence_view::StandstillView;
use crate::icons::{Icon, icon};
use crate::language::words;
use crate::news::SilenceView;
use crate::store::Store;

/// A robot that has driven less stands still yet, metres.
const DRIVEN_M: f64 = 0.05;
/// Getting ready takes no longer, seconds.
const READY_AFTER_S: f64 = 60.0;

impl Store {
    /// Whether the robot rests, so that a job can be begun.
    pub(crate) fn rests(self) -> bool {
        self.status.with(|status| {
            status
                .as_ref()
                .is_some_and(|status| matches!(status.state.as_str(), "idle" | "docked"))
        })
    }
}

#[component]
pub(crate) fn StatusView(store: Store) -> impl IntoView {
    let state = Memo::new(move |_| {
        store.status.with(|status| {
            status
                .as_ref()
                .map_or_else(|| "disconnected".to_owned(), |status| status.state.clone())
        })
    });
    let reason = Memo::new(move |_| {
        store
            .status
            .with(|status| status.as_ref().map(reason_text).unwrap_or_default())
    });
    let title = Memo::new(move |_| {
        store.status.with(|status| {
            let title = || state_title(words(), "disconnected").to_owned();
            status
                .as_ref()
                .map_or_else(title, |status| headline(words(), status))
        })
    });
    let is_away = Memo::new(move |_| state.get() == "disconnected");
    let rests = Memo::new(move |_| store.rests());
    view! {
        <section class="card now" aria-labelledby="state" data-state=move || state.get() id="now">
            <div role="status" aria-live="polite">
                <h2 id="state">{move || title.get()}</h2>
                <p id="reason">{move || reason.get()}</p>
            </div>
            <SilenceView store />
            <Progress store />
            <Inhibits store />
            <StandstillView store />
            <Lately store />
            {store.late.when_there(move |views| (views.summary)(store))}
            <Show when=move || rests.get()>
                <PatternChoice store />
            </Show>
            <Show when=move || !is_away.get()>
                <details class="folded figures-fold">
                    <summary>{words().status.figures}</summary>
                    <Figures store />
                </details>
            </Show>
        </section>
    }
}

/// How far the job is, and how long it takes yet.
#[component]
fn Progress(store: Store) -> impl IntoView {
    let job = Memo::new(move |_| {
        let route_m = store.route_m.get();
        store.status.with(|status| {
            let of = |estimate: &Option<_>| {
                status.as_ref().map_or_else(JobProgress::default, |status| {
                    JobProgress::of(status, route_m, estimate.as_ref())
                })
            };
            store.estimate.with(of)
        })
    });
    let text = Memo::new(move |_| job.get().text(words()));
    let share = move || job.get().share;
    let percent = move || share().map(|share| format!("{:.0}", 100.0 * share));
    view! {
        <Show when=move || text.get().is_some()>
            <p id="remaining">{move || text.get()}</p>
        </Show>
        <Show when=move || share().is_some()>
            <div
                class="progress"
                role="progressbar"
                aria-label=words().status.progress
                aria-valuemin="0"
                aria-valuemax="100"
                aria-valuenow=percent
            >
                <span style:width=move || format!("{}%", percent().unwrap_or_default())></span>
            </div>
        </Show>
    }
}

/// Why the robot is in its state. That a person asked for it needs no words while it works.
fn reason_text(status: &Status) -> String {
    let plain = matches!(
        status.reason.as_str(),
        "" | "command" | "start-up" | "link-restored" | "released" | "docked"
    );
    match (plain, status.state.as_str()) {
        (true, "idle" | "docked") => words().status.ready_to_clean.to_owned(),
        (true, "starting") => words().status.beeps.to_owned(),
        (true, "paused") => words().status.waits_for_resume.to_owned(),
        (true, "manual") => status
            .driver
            .as_ref()
            .map_or_else(String::new, |driver| words().status.in_control.fill([driver])),
        (true, "cleaning") if status.path_m < DRIVEN_M && status.job_s < READY_AFTER_S => {
            words().status.getting_ready.to_owned()
        }
        (true, "cleaning") => cleaning_text(status),
        (true, _) => String::new(),
        (false, _) => code_text(&status.reason),
    }
}

/// How it cleans. Where it does is in the headline.
fn cleaning_text(status: &Status) -> String {
    let strategy = status.strategy.as_ref();
    strategy.map_or_else(String::new, |name| {
        words().status.strategy.fill([&strategy_title(words(), name)])
    })
}

/// The sentences for a code; a code without any is shown as it is.
fn code_text(code: &str) -> String {
    explain(words(), code).map_or_else(|| words().status.reason.fill([&code]), Explanation::text)
}

/// What the firmware says against moving, as far as it is not the reason already.
#[component]
fn Inhibits(store: Store) -> impl IntoView {
    let sentences = Memo::new(move |_| {
        store.status.with(|status| {
            let status = status.as_ref()?;
            let normal = ["not-armed", "stopped", "docked", "link-lost"];
            let shown = status
                .inhibits
                .iter()
                .filter(|code| **code != status.reason && !normal.contains(&code.as_str()));
            let sentences: Vec<String> = shown.map(|code| code_text(code)).collect();
            (!sentences.is_empty()).then_some(sentences)
        })
    });
    view! {
        <Show when=move || sentences.get().is_some()>
            <ul class="inhibits">
                {move || {
                    let sentences = sentences.get().unwrap_or_default();
                    sentences.into_iter().map(|text| view! { <li>{icon(Icon::Warning)} {text}</li> }).collect_view()
                }}
            </ul>
        </Show>
    }
}

/// The last decision, while a job runs: the answer to "why did you turn".
#[component]
fn Lately(store: Store) -> impl IntoView {
    let works = move || {
        store.status.with(|status| {
            status.as_ref().is_some_and(|status| {
                matches!(status.state.as_str(), "cleaning" | "spot" | "going" | "docking")
            })
        })
    };
    let text = Memo::new(move |_| {
        store.decisions.with(|book| {
            book.newest_first()
                .next()
                .map(|entry| decision_text(words(), entry))
                .unwrap_or_default()
        })
    });
    view! {
        <Show when=works>
            <p id="lately">{move || text.get()}</p>
        </Show>
    }
}

#[component]
fn Figures(store: Store) -> impl IntoView {
    let figure = move |text: fn(&Status) -> String| {
        Memo::new(move |_| {
            store
                .status
                .with(|status| status.as_ref().map_or_else(|| "–".to_owned(), text))
        })
    };
    let swept = figure(|status| area_text(words(), status.swept_m2));
    let time = figure(|status| clock_text(status.job_s));
    let path = figure(|status| distance_text(words(), status.path_m));
    let bumps = figure(|status| status.bumps.to_string());
    let covered = Memo::new(move |_| {
        store
            .truth
            .with(|truth| truth.map(|truth| percent_text(words(), truth.covered)))
    });
    let place = Memo::new(move |_| {
        store
            .estimate
            .with(|estimate| estimate.as_ref().map(|estimate| place_text(words(), estimate)))
    });
    let is_lost = move || {
        store
            .estimate
            .with(|estimate| estimate.is_some_and(|estimate| estimate.lost))
    };
    view! {
        <dl class="figures">
            <div><dt>{words().status.swept}</dt><dd id="swept">{move || swept.get()}</dd></div>
            <div><dt>{words().status.time}</dt><dd>{move || time.get()}</dd></div>
            <div><dt>{words().status.distance}</dt><dd>{move || path.get()}</dd></div>
            <div><dt>{words().status.bumps}</dt><dd>{move || bumps.get()}</dd></div>
            <Show when=move || covered.get().is_some()>
                <div><dt>{words().status.actual_coverage}</dt><dd title=words().status.actual_coverage_long>{move || covered.get()}</dd></div>
            </Show>
            <Show when=move || place.get().is_some()>
                <div class:alarming=is_lost>
                    <dt>{words().status.place}</dt>
                    <dd id="place" title=words().status.place_long>{move || place.get()}</dd>
                </div>
            </Show>
        </dl>
    }
}
