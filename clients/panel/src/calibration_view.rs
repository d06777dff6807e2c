//! Measuring what differs from robot to robot, a page a step.

use std::time::Duration;

use leptos::ev::{self, KeyboardEvent, PointerEvent};
use leptos::html;
use leptos::prelude::*;
use panel_logic::{
    calibration_name, danger_text, explain, is_held, lacking_text, live_text, measured_text, task_text,
    value_state,
};
use rvac_api::{CalibrationAnswer, CalibrationAsk, CalibrationPage, CalibrationValue, RequestBody};

use crate::access::{Needs, OnlyLooks};
use crate::changes::set_if_changed;
use crate::focus::focus_soon_on;
use crate::language::words;
use crate::store::Store;

/// A request that needs the same role as all of a calibration.
const CALIBRATES: &str = "begin-calibration";
/// The robot is told so often that the button is held; it believes that for half a second.
const HELD_EVERY: Duration = Duration::from_millis(150);
/// The page's text takes the focus when a new step begins.
const STEP_ID: &str = "calibration-step";

/// What was measured, and the calibration that this page does.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CalibrationDesk {
    values: RwSignal<Vec<CalibrationValue>>,
    file: RwSignal<String>,
    page: RwSignal<Option<CalibrationPage>>,
}

impl CalibrationDesk {
    pub(crate) fn on_values(self, values: Vec<CalibrationValue>, file: String) {
        self.values.set(values);
        set_if_changed(self.file, file);
    }

    pub(crate) fn on_page(self, page: CalibrationPage) {
        self.page.set(Some(page));
    }

    fn of_page<T>(self, read: impl Fn(&CalibrationPage) -> T) -> Option<T> {
        self.page.with(|page| page.as_ref().map(&read))
    }

    /// A step is shown, so the list gives way to it.
    pub(crate) fn is_running(self) -> bool {
        self.of_page(|page| !page.over).unwrap_or(false)
    }
}

#[component]
pub(crate) fn CalibrationSection(store: Store) -> impl IntoView {
    let desk = store.calibration;
    Effect::new(move |_| {
        // Asked again when the robot has changed and when a calibration is over.
        store.robot.track();
        if !desk.is_running() {
            store.ask_quietly(RequestBody::Calibration);
        }
    });
    let running = Memo::new(move |_| desk.is_running());
    let lacks = move || {
        store.robot.with(|robot| {
            robot
                .as_ref()
                .and_then(|robot| lacking_text(words(), &robot.lacking))
        })
    };
    view! {
        <section id="calibration" aria-labelledby="calibration-title">
            <h3 id="calibration-title" tabindex="-1">{words().calibration.title}</h3>
            <p class="hint">{words().calibration.why}</p>
            <p id="calibration-lacks" class="hint" hidden=move || lacks().is_none()><strong>{lacks}</strong></p>
            <OnlyLooks store verb=CALIBRATES />
            <Show when=move || running.get() fallback=move || view! { <ValueList store /> }>
                <StepView store />
            </Show>
        </section>
    }
}

/// What was measured, and where to begin.
#[component]
fn ValueList(store: Store) -> impl IntoView {
    let desk = store.calibration;
    let begin = move |names: Vec<String>| {
        desk.page.set(None);
        store.ask(RequestBody::BeginCalibration { names });
    };
    let ended = move || {
        let over = desk.page.get().filter(|page| page.over)?;
        Some(over.reason.map_or_else(
            || words().calibration.over.to_owned(),
            |reason| reason_text(&reason, over.text),
        ))
    };
    let row = move |known: CalibrationValue| {
        let name = calibration_name(words(), &known.name);
        let label = if known.value.is_some() {
            words().calibration.again
        } else {
            words().calibration.measure
        };
        let said = format!("{label}: {name}");
        let id = format!("measure-{}", known.name);
        let state = value_state(words(), &known);
        view! {
            <li>
                <span class="name">{name}</span>
                <span class="words">{state}</span>
                <Needs store verb=CALIBRATES>
                    <button type="button" class="small" id=id aria-label=said on:click=move |_| begin(vec![known.name.clone()])>{label}</button>
                </Needs>
            </li>
        }
    };
    view! {
        <p id="calibration-over" role="status">{ended}</p>
        <p class="hint" hidden=move || desk.file.with(|file| !file.contains(" = "))>{words().calibration.next}</p>
        <Needs store verb=CALIBRATES>
            <button type="button" class="small strong" id="calibration-begin" on:click=move |_| begin(Vec::new())>
                {words().calibration.begin}
            </button>
        </Needs>
        <details>
            <summary>{words().calibration.all}</summary>
            <ul class="rows" aria-labelledby="calibration-title">
                {move || desk.values.get().into_iter().map(row).collect_view()}
            </ul>
        </details>
        <details>
            <summary>{words().calibration.file}</summary>
            <pre id="calibration-file" tabindex="0">{move || desk.file.get()}</pre>
        </details>
    }
}

/// One step: what is measured, what to do, what is seen, and the answers.
#[component]
fn StepView(store: Store) -> impl IntoView {
    let desk = store.calibration;
    let title = move || {
        desk.of_page(|page| match page.number {
            0 => String::new(),
            number => {
                let step = words().calibration.step.fill([&number, &page.of]);
                format!("{step}: {}", calibration_name(words(), &page.value))
            }
        })
    };
    let task = move || desk.of_page(|page| task_text(words(), page)).flatten();
    let danger = move || desk.of_page(|page| danger_text(words(), page)).flatten();
    let live = move || desk.of_page(|page| live_text(words(), page)).flatten();
    let failure = move || {
        desk.of_page(|page| {
            let reason = page.reason.as_ref()?;
            Some(reason_text(reason, page.text.clone()))
        })
        .flatten()
    };
    let value = move || desk.of_page(|page| page.value.clone());
    let asks = move || {
        desk.of_page(|page| page.asks.map(|asks| format!("{asks:?}")))
            .flatten()
    };
    let code_of_task = move || desk.of_page(|page| page.task.clone()).flatten();
    let measures = move || {
        desk.of_page(|page| page.asks.is_none() && page.permille.is_none())
            .unwrap_or(false)
    };
    let held = Memo::new(move |_| desk.of_page(is_held).unwrap_or(false));
    // The button that was pressed is gone with its step; the keys stay with the steps.
    let page = Memo::new(move |_| desk.of_page(|page| page.page));
    Effect::new(move |_| {
        page.track();
        focus_soon_on(STEP_ID.to_owned());
    });
    view! {
        <div class="step" id=STEP_ID tabindex="-1" data-page=page data-value=value data-asks=asks data-task=code_of_task>
            <h4 id="calibration-what">{title}</h4>
            <p id="calibration-danger" class="danger" hidden=move || danger().is_none()><strong>{danger}</strong></p>
            <p id="calibration-task" role="status">{task}</p>
            <p id="calibration-failed" role="alert">{failure}</p>
            <p id="calibration-live" class="hint">{live}</p>
            <p class="hint" hidden=move || !measures()>
                {words().calibration.measuring} " "
                {move || desk.of_page(|page| page.percent.map(|percent| words().unit.percent_said.fill([&percent]))).flatten()}
            </p>
            <Findings desk />
            <Show when=move || held.get()><HoldButton store /></Show>
            <Answers store />
            <div class="row">
                <button type="button" class="small" id="calibration-end" on:click=move |_| store.ask(RequestBody::EndCalibration)>
                    {words().calibration.end}
                </button>
            </div>
        </div>
    }
}

/// What was found, beside what was kept before.
#[component]
fn Findings(desk: CalibrationDesk) -> impl IntoView {
    let figure = |value: Option<i64>, page: &CalibrationPage| {
        value.map(|value| measured_text(words(), value, &page.unit))
    };
    let kept = move || {
        desk.of_page(|page| figure(page.kept, page).map(|kept| words().calibration.kept.fill([&kept])))
            .flatten()
    };
    let found = move || {
        desk.of_page(|page| figure(page.found, page).map(|found| words().calibration.found.fill([&found])))
            .flatten()
    };
    view! {
        <p id="calibration-found"><strong>{found}</strong></p>
        <p id="calibration-kept" class="hint">{kept}</p>
    }
}

/// The answers that a step takes.
#[component]
fn Answers(store: Store) -> impl IntoView {
    let desk = store.calibration;
    let asked = Memo::new(move |_| desk.of_page(|page| (page.asks, page.page)));
    let answer = move |answer: CalibrationAnswer| {
        if let Some(page) = desk
            .page
            .with_untracked(|page| page.as_ref().map(|page| page.page))
        {
            store.ask(RequestBody::AnswerCalibration { page, answer });
        }
    };
    let button = move |id: &'static str, label: &'static str, given: CalibrationAnswer| {
        let is_strong = given == CalibrationAnswer::Go;
        view! { <button type="button" class="small" class:strong=is_strong id=id on:click=move |_| answer(given)>{label}</button> }
    };
    let texts = words().calibration;
    let go = move |label| button("calibration-go", label, CalibrationAnswer::Go);
    let again = move || button("calibration-again", texts.repeat, CalibrationAnswer::Again);
    let skip = move || button("calibration-skip", texts.skip, CalibrationAnswer::Skip);
    view! {
        <div class="row">
            {move || match asked.get().and_then(|(asks, _)| asks) {
                Some(CalibrationAsk::Ready) => view! { {go(texts.ready)} {skip()} }.into_any(),
                Some(CalibrationAsk::Done) => view! { {go(texts.done)} }.into_any(),
                Some(CalibrationAsk::Keep) => view! { {go(texts.keep)} {again()} {skip()} }.into_any(),
                Some(CalibrationAsk::Retry) => view! { {again()} {skip()} }.into_any(),
                Some(CalibrationAsk::Number) => view! { <NumberForm answer=Callback::new(answer) /> }.into_any(),
                Some(CalibrationAsk::Hold) | None => ().into_any(),
            }}
        </div>
    }
}

/// A whole number that a person reads off.
#[component]
fn NumberForm(answer: Callback<CalibrationAnswer>) -> impl IntoView {
    let typed = RwSignal::new(String::new());
    let wrong = RwSignal::new(false);
    let submit = move |event: ev::SubmitEvent| {
        event.prevent_default();
        match typed.with_untracked(|text| text.trim().parse::<i64>()) {
            Ok(number) => answer.run(CalibrationAnswer::Number(number)),
            Err(_) => wrong.set(true),
        }
    };
    view! {
        <form on:submit=submit>
            <input
                id="calibration-number"
                inputmode="numeric"
                autocomplete="off"
                aria-labelledby="calibration-task"
                aria-describedby="calibration-whole"
                on:input=move |event| typed.set(event_target_value(&event))
            />
            <button type="submit" class="small strong" id="calibration-enter">{words().calibration.enter}</button>
            <p class="hint" id="calibration-whole" role=move || wrong.get().then_some("alert")>{words().calibration.whole}</p>
        </form>
    }
}

/// Motors run only while this is pressed. Whatever ends the press, or hides the page, lets go.
#[component]
fn HoldButton(store: Store) -> impl IntoView {
    let button = NodeRef::<html::Button>::new();
    let held = RwSignal::new(false);
    let tell = move |held| store.ask_quietly(RequestBody::HoldCalibration { held });
    let let_go = move || {
        if held.get_untracked() {
            held.set(false);
            tell(false);
        }
    };
    let hold = move || {
        if !held.get_untracked() {
            held.set(true);
            tell(true);
        }
    };
    keep_held(store, held);
    let_go_when_left(let_go);
    let press = move |event: PointerEvent| {
        let captured = button
            .get_untracked()
            .is_some_and(|button| button.set_pointer_capture(event.pointer_id()).is_ok());
        if captured && event.button() == 0 {
            hold();
        }
    };
    let key = move |event: KeyboardEvent| {
        if matches!(event.key().as_str(), " " | "Enter") {
            event.prevent_default();
            hold();
        }
    };
    // A pointer that moves with no button pressed has let go, whether the browser said so or not.
    let follow = move |event: PointerEvent| {
        if event.buttons() == 0 {
            let_go();
        }
    };
    view! {
        <p class="hint">{words().calibration.hold_hint}</p>
        <button
            type="button"
            class="small strong hold"
            id="calibration-hold"
            node_ref=button
            aria-pressed=move || if held.get() { "true" } else { "false" }
            on:pointerdown=press
            on:pointermove=follow
            on:pointerup=move |_| let_go()
            on:pointercancel=move |_| let_go()
            on:lostpointercapture=move |_| let_go()
            on:contextmenu=move |event| { event.prevent_default(); let_go(); }
            on:keydown=key
            on:keyup=move |_| let_go()
            on:blur=move |_| let_go()
        >
            {words().calibration.hold}
        </button>
    }
}

/// Says again and again that the button is held, and at the end that it is not.
fn keep_held(store: Store, held: RwSignal<bool>) {
    let tell = move |held| store.ask_quietly(RequestBody::HoldCalibration { held });
    let renew = move || {
        if held.get_untracked() {
            tell(true);
        }
    };
    let renewal = set_interval_with_handle(renew, HELD_EVERY);
    on_cleanup(move || {
        if let Ok(renewal) = renewal {
            renewal.clear();
        }
        tell(false);
    });
}

/// A page that is hidden or loses the keys hears no end of a press.
fn let_go_when_left(let_go: impl Fn() + Copy + 'static) {
    let blurred = window_event_listener(ev::blur, move |_| let_go());
    let hidden = window_event_listener(ev::visibilitychange, move |_| let_go());
    on_cleanup(move || {
        blurred.remove();
        hidden.remove();
    });
}

/// A reason in the page's language; one that it does not know in the robot's own words.
fn reason_text(reason: &str, text: String) -> String {
    explain(words(), reason).map_or(text, |told| told.text())
}
