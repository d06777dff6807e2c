//! Updates of the robot's software, for administrators: a file goes to the robot, and its steps are shown until it has ended.

use leptos::prelude::*;
use panel_logic::{
    StepState, UpdateRow, UpdateSight, step_text, update_file_problem, update_obstacle, update_sight,
};
use rvac_api::SoftwareUpdate;
use web_sys::File;

use crate::http::{self, Failed};

use crate::file_button::FileButton;
use crate::language::words;
use crate::store::Store;

/// Where files are sent.
const ADDRESS: &str = "/api/update";

/// What is known here beside what the robot tells.
#[derive(Clone, Copy)]
struct Desk {
    is_sending: RwSignal<bool>,
    wrong: RwSignal<String>,
}

impl Desk {
    async fn send(self, file: File) {
        self.wrong.set(String::new());
        if let Some(problem) = update_file_problem(words(), file.size() as u64) {
            self.wrong.set(problem);
            return;
        }
        self.is_sending.set(true);
        if let Err(failed) = http::send_file(ADDRESS, &file).await {
            self.wrong.set(match failed {
                Failed::Unreachable => words().software.lost.to_owned(),
                refused => refused.text(),
            });
        }
        self.is_sending.set(false);
    }
}

#[component]
pub(crate) fn SoftwareView(store: Store) -> impl IntoView {
    let texts = &words().software;
    let desk = Desk {
        is_sending: RwSignal::new(false),
        wrong: RwSignal::new(String::new()),
    };
    let obstacle = Memo::new(move |_| {
        store
            .status
            .with(|status| update_obstacle(words(), status.as_ref()))
    });
    let goes_on = move || {
        store
            .software
            .with(|told| told.as_ref().is_some_and(|told| told.end.is_none()))
    };
    let sight = Memo::new(move |_| {
        store
            .software
            .with(|told: &Option<SoftwareUpdate>| told.as_ref().map(|told| update_sight(words(), told)))
    });
    view! {
        <section class="software" id="software" aria-labelledby="software-title">
            <h3 id="software-title">{texts.title}</h3>
            <p class="hint">{texts.how} " " {texts.dock}</p>
            <div class="draw-tools">
                <FileButton
                    id="choose-update"
                    file_id="update-file"
                    text=texts.choose
                    label=texts.file
                    accept=".update"
                    disabled=Signal::derive(move || {
                        desk.is_sending.get() || goes_on() || obstacle.get().is_some()
                    })
                    on_file=move |file| leptos::task::spawn_local(desk.send(file))
                />
            </div>
            <p class="hint" id="update-obstacle" hidden=move || obstacle.get().is_none()>{move || obstacle.get()}</p>
            <p class="wrong" id="update-wrong" role="alert">{move || desk.wrong.get()}</p>
            <p id="update-headline" role="status">{move || sight.with(|sight| sight.as_ref().map(|sight| sight.headline.clone()))}</p>
            {move || sight.get().map(course)}
        </section>
    }
}

/// The bar, the steps and the end.
fn course(sight: UpdateSight) -> impl IntoView {
    let texts = &words().software;
    let reload = move |_| {
        window().location().reload().ok(); // Whoever may not reload does it by hand.
    };
    view! {
        {sight.percent.map(|percent| view! {
            <div
                class="progress"
                id="update-progress"
                role="progressbar"
                aria-label=texts.progress
                aria-valuemin="0"
                aria-valuemax="100"
                aria-valuenow=percent.to_string()
                aria-valuetext=sight.headline.clone()
            >
                <span style:width=format!("{percent}%")></span>
            </div>
        })}
        <ol class="update-steps" id="update-steps" aria-label=texts.progress>
            {sight.rows.iter().map(step).collect_view()}
        </ol>
        {sight.why.map(|why| view! { <p id="update-why" class="wrong">{why}</p> })}
        {sight.is_installed.then(|| view! {
            <button type="button" class="small" id="update-reload" on:click=reload>{texts.reload}</button>
        })}
    }
}

fn step(row: &UpdateRow) -> impl IntoView + use<> {
    let (name, sign) = match row.state {
        StepState::Done => ("done", "✓"),
        StepState::Now => ("now", "…"),
        StepState::Failed => ("failed", "✗"),
        StepState::ToCome => ("to-come", "·"),
    };
    let is_now = (row.state == StepState::Now).then_some("step");
    view! {
        <li data-state=name aria-current=is_now>
            <span class="sign" aria-hidden="true">{sign}</span>
            <span>{row.text}</span>
            <span class="visually-hidden">": " {step_text(words(), row.state)}</span>
        </li>
    }
}
