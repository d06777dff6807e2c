//! The form for a schedule.

use leptos::ev::{Event, SubmitEvent};
use leptos::prelude::*;
use panel_logic::{PASSES_MAX, ScheduleForm, day_text, floor_elsewhere};
use rvac_api::{JobPart, Weekday};

use super::clock_field::ClockField;
use crate::icons::{Icon, icon};
use crate::job_settings_view::JobSettingsFields;
use crate::language::words;
use crate::store::Store;

type Form = RwSignal<Option<ScheduleForm>>;

fn text(form: Form, part: fn(&ScheduleForm) -> String) -> impl Fn() -> String + Copy + Send + Sync + 'static {
    move || form.with(|form| form.as_ref().map(part).unwrap_or_default())
}

fn is(form: Form, part: fn(&ScheduleForm) -> bool) -> impl Fn() -> bool + Copy + Send + Sync + 'static {
    move || form.with(|form| form.as_ref().is_some_and(part))
}

fn write(form: Form, change: fn(&mut ScheduleForm, String)) -> impl Fn(Event) + Copy + 'static {
    move |event| {
        let typed = event_target_value(&event);
        form.update(|form| {
            if let Some(form) = form {
                change(form, typed);
            }
        });
    }
}

fn check(form: Form, change: fn(&mut ScheduleForm, bool)) -> impl Fn(Event) + Copy + 'static {
    move |event| {
        let checked = event_target_checked(&event);
        form.update(|form| {
            if let Some(form) = form {
                change(form, checked);
            }
        });
    }
}

/// Somebody else has changed the same schedule: what it is now, and the choice between the two.
#[component]
fn Conflict(store: Store) -> impl IntoView {
    let theirs = move || {
        store.schedules.known.track();
        store.their_words()
    };
    view! {
        <div class="conflict" id="conflict">
            <p>{move || words().schedule.theirs.fill([&theirs()])}</p>
            <div class="order-tools">
                <button type="button" class="small" id="take-theirs" on:click=move |_| store.take_theirs()>
                    {words().schedule.take_theirs}
                </button>
                <button type="button" class="small strong" id="keep-mine" on:click=move |_| store.keep_mine()>
                    {words().schedule.keep_mine}
                </button>
            </div>
        </div>
    }
}

#[component]
pub(super) fn FormView(store: Store) -> impl IntoView {
    let desk = store.schedules;
    let form = desk.form;
    let is_new = Memo::new(move |_| is(form, |form| form.number.is_none())());
    let is_once = Memo::new(move |_| is(form, |form| form.is_once)());
    let save = move |event: SubmitEvent| {
        event.prevent_default();
        store.save_schedule();
    };
    view! {
        <form
            id="schedule-form"
            class="schedule-form"
            aria-labelledby="form-title"
            on:input=move |_| desk.wrong.set(None)
            on:submit=save
        >
            <h3 id="form-title">{move || if is_new.get() { words().schedule.new } else { words().schedule.change }}</h3>
            <label class="field">
                {words().schedule.name}
                <input
                    id="schedule-name"
                    autocomplete="off"
                    prop:value=text(form, |form| form.name.clone())
                    on:input=write(form, |form, typed| form.name = typed)
                />
            </label>
            <ClockField
                id="schedule-at"
                label=words().schedule.time
                at=Signal::derive(text(form, |form| form.at.clone()))
                change=Callback::new(move |at| form.update(|form| if let Some(form) = form { form.at = at }))
            />
            <label class="check">
                <input
                    id="schedule-once"
                    type="checkbox"
                    prop:checked=is_once
                    on:change=check(form, |form, checked| form.is_once = checked)
                />
                {words().schedule.once}
            </label>
            <Show when=move || is_once.get() fallback=move || view! { <Days store /> }>
                <label class="field">
                    {words().schedule.date}
                    <input
                        id="schedule-date"
                        type="date"
                        class:empty=is(form, |form| form.date.is_empty())
                        prop:value=text(form, |form| form.date.clone())
                        on:input=write(form, |form, typed| form.date = typed)
                    />
                </label>
            </Show>
            <Rooms store />
            <Terms store />
            <p role="alert" id="schedule-wrong" class="wrong">{move || desk.wrong.get()}</p>
            <Show when=move || desk.conflicts.get()>
                <Conflict store />
            </Show>
            <div class="order-tools">
                <button type="submit" class="small strong" id="save-schedule">{words().frame.save}</button>
                <button type="button" class="small" id="cancel-schedule" on:click=move |_| form.set(None)>{words().frame.cancel}</button>
            </div>
        </form>
    }
}

#[component]
fn Days(store: Store) -> impl IntoView {
    let form = store.schedules.form;
    let button = move |day: Weekday| {
        let chosen = move || form.with(|form| form.as_ref().is_some_and(|form| form.days.contains(&day)));
        view! {
            <button
                type="button"
                id=format!("day-{day:?}").to_lowercase()
                aria-pressed=move || if chosen() { "true" } else { "false" }
                on:click=move |_| form.update(|form| if let Some(form) = form { form.toggle_day(day) })
            >
                {day_text(words(), day)}
            </button>
        }
    };
    view! {
        <div class="passes days" role="group" aria-label=words().schedule.days>
            {Weekday::ALL.map(button).into_iter().collect_view()}
        </div>
    }
}

#[component]
fn Rooms(store: Store) -> impl IntoView {
    let form = store.schedules.form;
    let elsewhere = Memo::new(move |_| {
        let floor = form.with(|form| form.as_ref().and_then(|form| form.floor));
        store
            .floors
            .with(|floors| floor_elsewhere(words(), floor, floors))
    });
    let hint = move || match elsewhere.get() {
        Some(title) => Some(words().schedule.other_floor.fill([&title])),
        None => store
            .rooms
            .with(Vec::is_empty)
            .then(|| words().schedule.no_rooms.to_owned()),
    };
    view! {
        <fieldset class="rooms">
            <legend>{words().schedule.rooms}</legend>
            {move || hint().map(|text| view! { <p class="hint">{text}</p> })}
            <Show when=move || elsewhere.with(Option::is_none)>
                <For each=move || store.rooms.get() key=|row| (row.id, row.name.clone()) let:row>
                    {choice(form, format!("schedule-room-{}", row.id), row.name, JobPart::Room(row.id))}
                </For>
                <For each=move || store.orders.places.get() key=|row| (row.number, row.name.clone()) let:row>
                    {choice(form, format!("schedule-place-{}", row.number), row.name, JobPart::Place(row.number))}
                </For>
            </Show>
            <Drawn form />
        </fieldset>
    }
}

fn choice(form: Form, id: String, name: String, part: JobPart) -> impl IntoView {
    let chosen = part.clone();
    let is_chosen = move || form.with(|form| form.as_ref().is_some_and(|form| form.parts.contains(&chosen)));
    view! {
        <label class="check">
            <input
                type="checkbox"
                id=id
                prop:checked=is_chosen
                on:change=move |_| form.update(|form| if let Some(form) = form { form.toggle_part(part.clone()) })
            />
            {name}
        </label>
    }
}

/// Zones and spots of a schedule that was made by `rvac` or a program, each to be taken out.
#[component]
fn Drawn(form: Form) -> impl IntoView {
    let drawn = Memo::new(move |_| {
        form.with(|form| form.as_ref().map(|form| form.drawn(words())).unwrap_or_default())
    });
    let part = move |(part, name): (JobPart, String)| {
        let label = words().map.take_out.fill([&name]);
        view! {
            <button
                type="button"
                class="small part"
                aria-label=label.clone()
                title=label
                on:click=move |_| form.update(|form| if let Some(form) = form { form.toggle_part(part.clone()) })
            >
                {name}
                {icon(Icon::Close)}
            </button>
        }
    };
    view! {
        <Show when=move || drawn.with(|drawn| !drawn.is_empty())>
            <div class="order-tools" id="schedule-drawn">
                {move || drawn.get().into_iter().map(part).collect_view()}
            </div>
        </Show>
    }
}

#[component]
fn Terms(store: Store) -> impl IntoView {
    let form = store.schedules.form;
    view! {
        <label class="field">
            {words().schedule.passes}
            <select id="schedule-passes" on:change=write(form, |form, typed| form.passes = typed.parse().unwrap_or(1))>
                {(1..=PASSES_MAX).map(|passes| {
                    let chosen = move || form.with(|form| form.as_ref().is_some_and(|form| form.passes == passes));
                    view! { <option value=passes.to_string() selected=chosen>{passes}</option> }
                }).collect_view()}
            </select>
        </label>
        <JobSettingsFields
            place="schedule"
            settings=Signal::derive(move || form.with(|form| form.as_ref().map(|form| form.settings).unwrap_or_default()))
            change=Callback::new(move |settings| form.update(|form| if let Some(form) = form { form.settings = settings }))
        />
        <label class="field">
            {words().schedule.late}
            <input
                id="schedule-late"
                type="number"
                min="0"
                max="720"
                prop:value=text(form, |form| form.late_min.to_string())
                on:input=write(form, |form, typed| form.late_min = typed.parse().unwrap_or(0))
            />
        </label>
        <label class="check">
            <input
                id="schedule-waits"
                type="checkbox"
                prop:checked=is(form, |form| form.waits)
                on:change=check(form, |form, checked| form.waits = checked)
            />
            {words().schedule.waits}
        </label>
    }
}
