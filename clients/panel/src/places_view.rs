//! Zones and spots that the robot keeps under names: chosen for cleaning as rooms are, and what is drawn can be kept.

use leptos::prelude::*;
use panel_logic::{Edit, Kept, PlaceRow, Target, Tool};
use rvac_api::PlaceShape;

use crate::access::{EDITS_HOME, Needs};
use crate::language::words;
use crate::rename_form::RenameForm;
use crate::row_tools::{DrawnRow, RowTools};
use crate::store::Store;

#[component]
pub(crate) fn PlaceList(store: Store) -> impl IntoView {
    let renamed = RwSignal::new(None::<u16>);
    let orders = store.orders;
    view! {
        <h3 id="places-title">{words().home.places}</h3>
        <ul id="places" class="rows" aria-labelledby="places-title">
            <For each=move || orders.places.get() key=|row| (row.number, row.name.clone()) let:row>
                <Place store row renamed />
            </For>
        </ul>
        <Show when=move || orders.places.with(Vec::is_empty)>
            <p class="hint">{words().home.no_places}</p>
        </Show>
        <Drawn store />
        <Show
            when=move || store.rooms.with(|rooms| !rooms.is_empty())
            fallback=move || view! { <p class="hint">{words().home.zones_need_rooms}</p> }
        >
            <div class="draw-tools">
                {tool(store, Tool::CleanZone, "draw-clean", words().home.draw_clean)}
                {tool(store, Tool::Spot, "draw-spot", words().home.draw_spot)}
                {tool(store, Tool::GoTo, "draw-go", words().home.draw_go)}
                {tool(store, Tool::AvoidZone, "draw-avoid", words().home.draw_avoid)}
            </div>
        </Show>
    }
}

/// A button that takes a tool for drawing on the map.
pub(crate) fn tool(store: Store, tool: Tool, id: &'static str, label: &'static str) -> impl IntoView {
    view! {
        <button type="button" class="small" id=id on:click=move |_| store.take_tool(tool)>
            {label}
        </button>
    }
}

#[component]
fn Place(store: Store, row: PlaceRow, renamed: RwSignal<Option<u16>>) -> impl IntoView {
    let PlaceRow { number, name, .. } = row;
    // It changes while the row stays: whoever reshapes by keys comes back to the same button.
    let extent = move || {
        let rows = store.orders.places.read();
        rows.iter()
            .find(|row| row.number == number)
            .map(|row| row.words.clone())
    };
    let choice = store.orders.choice;
    let place = Memo::new(move |_| choice.with(|choice| choice.place_of_kept(number)));
    let drawn = DrawnRow {
        target: Target::Place(number),
        kind: "place",
        number,
        name: name.clone(),
    };
    let remove = Callback::new(move |number| forget(store, number));
    let (shown, for_form) = (name.clone(), name);
    view! {
        <li>
            <button
                type="button"
                class="small choose"
                id=format!("place-{number}")
                aria-pressed=move || if place.get().is_some() { "true" } else { "false" }
                on:click=move |_| store.toggle_place(number)
            >
                {move || place.get().map(|place| format!("{place}. "))}
                {shown}
            </button>
            <span class="words">{extent}</span>
            <RowTools store row=drawn renamed remove />
        </li>
        <Show when=move || renamed.get() == Some(number)>
            <RenameForm
                label=words().home.place_name.fill([&for_form])
                field_id="new-place-name"
                button_id="save-place-name"
                name=for_form.clone()
                opener=format!("rename-place-{number}")
                on_save={
                    let before = for_form.clone();
                    move |name| {
                        rename(store, before.clone(), name);
                        renamed.set(None);
                    }
                }
            />
        </Show>
    }
}

/// A place always has a name: an emptied line changes nothing.
fn rename(store: Store, before: String, after: Option<String>) {
    if let Some(after) = after {
        let after = after.trim().to_owned();
        store.edit(Edit::NamePlace { before, after });
    }
}

fn forget(store: Store, number: u16) {
    let places = store.known_home().places;
    if let Some(place) = places.into_iter().find(|place| place.number == number) {
        store.edit(Edit::Forget(Kept {
            number: Some(number),
            name: place.name,
            shape: place.shape,
        }));
    }
}

/// Zones and spots that are chosen and not kept.
#[component]
fn Drawn(store: Store) -> impl IntoView {
    let choice = store.orders.choice;
    let named = RwSignal::new(None::<usize>);
    let drawn = Memo::new(move |_| choice.with(|choice| choice.not_kept(words())));
    let part = move |(place, what, shape): (usize, String, PlaceShape)| {
        let label = format!("{place}. {what}");
        let form_label = words().home.keep_name.fill([&label]);
        let is_named = move || named.get() == Some(place);
        view! {
            <li>
                <button
                    type="button"
                    class="small"
                    id=format!("keep-part-{place}")
                    aria-expanded=move || if is_named() { "true" } else { "false" }
                    on:click=move |_| named.update(|named| *named = (*named != Some(place)).then_some(place))
                >
                    {words().home.keep_named.fill([&label])}
                </button>
            </li>
            <Show when=is_named>
                <RenameForm
                    label=form_label.clone()
                    field_id="place-name"
                    button_id="keep-place"
                    name=String::new()
                    opener=format!("keep-part-{place}")
                    on_save={
                        let shape = shape.clone();
                        move |name| {
                            keep(store, name, shape.clone());
                            named.set(None);
                        }
                    }
                />
            </Show>
        }
    };
    view! {
        <Show when=move || drawn.with(|drawn| !drawn.is_empty())>
            <Needs store verb=EDITS_HOME>
                <ul class="rows" id="not-kept" aria-labelledby="places-title">
                    {move || drawn.get().into_iter().map(part).collect_view()}
                </ul>
            </Needs>
        </Show>
    }
}

fn keep(store: Store, name: Option<String>, shape: PlaceShape) {
    if let Some(name) = name {
        store.edit(Edit::Keep(Kept {
            number: None,
            name: name.trim().to_owned(),
            shape,
        }));
    }
}
