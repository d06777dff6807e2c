//! How a room is cleaned, as a form below its row.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;
use panel_logic::{Edit, PASSES_MAX, PowerPart, pattern_text, percent_text};
use rvac_api::{CleaningPattern, RoomSettings};

use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn SettingsForm(
    store: Store,
    id: u16,
    name: String,
    opened: RwSignal<Option<u16>>,
) -> impl IntoView {
    let before = settings_of(store, id);
    let settings = RwSignal::new(before.unwrap_or_default());
    let ask = move |after: Option<RoomSettings>| {
        store.edit(Edit::Settings {
            room: id,
            before: settings_of(store, id),
            after,
        });
        opened.set(None);
    };
    let save = move |event: SubmitEvent| {
        event.prevent_default();
        let wanted = settings.get_untracked();
        ask((wanted != RoomSettings::default()).then_some(wanted));
    };
    let parts = store.robot.with_untracked(|robot| PowerPart::of(robot.as_ref()));
    view! {
        <li>
            <form class="room-settings" aria-label=words().home.set_room_named.fill([&name]) on:submit=save>
                <Passes settings />
                <PatternField settings />
                {parts.into_iter().map(|part| power(part, settings)).collect_view()}
                <p class="hint">{words().home.set_hint}</p>
                <div class="draw-tools">
                    <button type="submit" class="small" id="save-settings">{words().frame.save}</button>
                    <button type="button" class="small" id="usual-settings" on:click=move |_| ask(None)>
                        {words().home.set_usual}
                    </button>
                </div>
            </form>
        </li>
    }
}

fn settings_of(store: Store, id: u16) -> Option<RoomSettings> {
    let home = store.known_home();
    home.rooms.iter().find(|room| room.id == id)?.settings
}

#[component]
fn Passes(settings: RwSignal<RoomSettings>) -> impl IntoView {
    let choose = move |event| {
        let passes = event_target_value(&event).parse().unwrap_or(1);
        settings.update(|settings| settings.passes = passes);
    };
    let option = move |passes: u8| {
        let told = if passes == 1 {
            words().home.set_once.to_owned()
        } else {
            words().home.set_times.fill([&passes])
        };
        view! {
            <option value=passes.to_string() selected=move || settings.with(|settings| settings.passes == passes)>
                {told}
            </option>
        }
    };
    view! {
        <label class="field grow">
            {words().home.set_passes}
            <select id="room-passes" on:change=choose>
                {(1..=PASSES_MAX).map(option).collect_view()}
            </select>
        </label>
    }
}

#[component]
fn PatternField(settings: RwSignal<RoomSettings>) -> impl IntoView {
    let choose = move |event| {
        let pattern = CleaningPattern::from_name(&event_target_value(&event)).unwrap_or_default();
        settings.update(|settings| settings.pattern = pattern);
    };
    let option = move |pattern: CleaningPattern| {
        let chosen = move || settings.with(|settings| settings.pattern == pattern);
        view! { <option value=pattern.name() selected=chosen>{pattern_text(words(), pattern)}</option> }
    };
    view! {
        <label class="field grow">
            {words().home.set_pattern}
            <select id="room-pattern" on:change=choose>
                {CleaningPattern::ALL.map(option).into_iter().collect_view()}
            </select>
        </label>
    }
}

/// Percent in steps of five.
fn power(part: PowerPart, settings: RwSignal<RoomSettings>) -> impl IntoView {
    let percent = move || settings.with(|settings| (100.0 * part.share(&settings.power)).round());
    let slide = move |event| {
        let percent = event_target_value(&event).parse().unwrap_or(100);
        settings.update(|settings| part.set(&mut settings.power, percent));
    };
    view! {
        <label class="field grow">
            {part.name(words())}
            " "
            {move || percent_text(words(), settings.with(|settings| part.share(&settings.power)))}
            <input
                id=format!("room-{}", part.code())
                type="range"
                min="0"
                max="100"
                step="5"
                prop:value=move || percent().to_string()
                on:input=slide
            />
        </label>
    }
}
