//! The rooms as a list with actions, and what is forbidden: all that can be done on the map, for keyboard and screen reader.

use leptos::prelude::*;
use panel_logic::{Edit, Forbidden, NoGoRow, RoomChangeRow, RoomRow, Target, Tool};

use crate::access::{EDITS_HOME, Needs};
use crate::language::words;
use crate::places_view::tool;
use crate::rename_form::RenameForm;
use crate::room_settings_view::SettingsForm;
use crate::row_menu::RowMenu;
use crate::row_tools::{DrawnRow, RowTools};
use crate::store::Store;

#[component]
pub(crate) fn RoomList(store: Store) -> impl IntoView {
    let renamed = RwSignal::new(None::<u16>);
    let set = RwSignal::new(None::<u16>);
    let joinable = Memo::new(move |_| store.joinable_rooms());
    view! {
        <h3 id="rooms-title" class="visually-hidden">{words().home.rooms}</h3>
        <ul id="rooms" class="rows" aria-labelledby="rooms-title">
            <For
                each=move || store.rooms.get()
                key=|row| (row.id, row.name.clone())
                let:row
            >
                <Room store row renamed set />
            </For>
        </ul>
        <Show when=move || store.rooms.with(Vec::is_empty)>
            <p class="hint">{words().home.no_rooms}</p>
        </Show>
        <Show when=move || store.rooms.with(|rooms| !rooms.is_empty())>
            <p class="hint">{words().home.choose_rooms}</p>
            <div class="draw-tools">
                <Needs store verb=EDITS_HOME>
                    <button type="button" class="small" id="draw-cut" on:click=move |_| store.take_tool(Tool::Cut)>
                        {words().home.draw_cut}
                    </button>
                    <Show when=move || joinable.get().is_some()>
                        <button type="button" class="small" id="join-rooms" on:click=move |_| store.join_chosen()>
                            {words().map.join_these}
                        </button>
                    </Show>
                </Needs>
            </div>
            <p class="hint">{words().home.join_hint}</p>
        </Show>
        <RoomChanges store />
    }
}

/// How the rooms were split and joined, each to be taken back.
#[component]
fn RoomChanges(store: Store) -> impl IntoView {
    let changes = store.orders.room_changes;
    view! {
        <Show when=move || changes.with(|changes| !changes.is_empty())>
            <h3 id="room-changes-title">{words().home.room_changes}</h3>
            <ul id="room-changes" class="rows" aria-labelledby="room-changes-title">
                <For
                    each=move || changes.get()
                    key=|row| (row.number, row.text.clone(), row.can_be_taken_back)
                    let:row
                >
                    {room_change(store, row)}
                </For>
            </ul>
        </Show>
    }
}

fn room_change(store: Store, row: RoomChangeRow) -> impl IntoView {
    let RoomChangeRow {
        number,
        text,
        can_be_taken_back,
    } = row;
    let label = words().home.take_back_named.fill([&text]);
    let take_back = move |_| {
        let home = store.known_home();
        let change = home.room_changes.iter().find(|change| change.number == number);
        if let Some(change) = change {
            store.edit(change.line.map_or(Edit::Unjoin(change.rooms), Edit::Unsplit));
        }
    };
    view! {
        <li>
            <span class="name">{text}</span>
            {can_be_taken_back
                .then(|| {
                    view! {
                        <Needs store verb=EDITS_HOME>
                            <button type="button" class="small" aria-label=label on:click=take_back>
                                {words().home.take_back}
                            </button>
                        </Needs>
                    }
                })}
        </li>
    }
}

#[component]
fn Room(
    store: Store,
    row: RoomRow,
    /// The room whose form for a name is open.
    renamed: RwSignal<Option<u16>>,
    /// The room whose form for settings is open.
    set: RwSignal<Option<u16>>,
) -> impl IntoView {
    let for_tools = row.clone();
    let RoomRow { id, name, .. } = row;
    // It changes while the row stays: what is typed into a form below it must not be lost.
    let extent = move || {
        let rows = store.rooms.read();
        rows.iter().find(|row| row.id == id).map(|row| row.words.clone())
    };
    let choice = store.orders.choice;
    let place = Memo::new(move |_| choice.with(|choice| choice.place(id)));
    let is_renamed = move || renamed.get() == Some(id);
    let is_set = move || set.get() == Some(id);
    let (shown, for_form) = (name.clone(), name.clone());
    view! {
        <li>
            <button
                type="button"
                class="small choose"
                id=format!("room-{id}")
                aria-pressed=move || if place.get().is_some() { "true" } else { "false" }
                on:click=move |_| store.toggle_room(id)
            >
                {move || place.get().map(|place| format!("{place}. "))}
                {shown}
            </button>
            <span class="words">{extent}</span>
            <RoomTools store row=for_tools renamed set />
        </li>
        <Show when=is_set>
            <SettingsForm store id name=for_form.clone() opened=set />
        </Show>
        <Show when=is_renamed>
            <RenameForm
                label=words().home.room_name.fill([&name])
                field_id="room-name"
                button_id="save-name"
                name=name.clone()
                opener=format!("rename-room-{id}")
                on_save=move |name| {
                    rename(store, id, name);
                    renamed.set(None);
                }
            />
        </Show>
    }
}

/// The buttons that open the forms of a room.
#[component]
fn RoomTools(
    store: Store,
    row: RoomRow,
    renamed: RwSignal<Option<u16>>,
    set: RwSignal<Option<u16>>,
) -> impl IntoView {
    let RoomRow { id, name, .. } = row;
    let opener = move |button: String, label: String, text: &'static str, open: RwSignal<Option<u16>>| {
        view! {
            <button
                type="button"
                class="small"
                id=button
                aria-label=label
                aria-expanded=move || if open.get() == Some(id) { "true" } else { "false" }
                on:click=move |_| open.update(|open| *open = (*open != Some(id)).then_some(id))
            >
                {text}
            </button>
        }
    };
    let texts = &words().home;
    view! {
        <Needs store verb=EDITS_HOME>
            <RowMenu of=format!("room-{id}") name=name.clone()>
                {opener(format!("rename-room-{id}"), texts.rename_named.fill([&name]), words().frame.rename, renamed)}
                {opener(format!("room-{id}-settings"), texts.set_room_named.fill([&name]), texts.set_room, set)}
            </RowMenu>
        </Needs>
    }
}

/// Names a room, or takes its name away, so that it can be undone.
fn rename(store: Store, id: u16, after: Option<String>) {
    let home = store.known_home();
    let before = home
        .rooms
        .iter()
        .find(|room| room.id == id)
        .and_then(|room| room.name.clone());
    store.edit(Edit::Name {
        room: id,
        before,
        after,
    });
}

#[component]
pub(crate) fn NoGoList(store: Store) -> impl IntoView {
    let renamed = RwSignal::new(None::<u16>);
    view! {
        <h3 id="no-go-title">{words().home.no_go}</h3>
        <ul id="no-go" class="rows" aria-labelledby="no-go-title">
            <For each=move || store.orders.no_go.get() key=|row| (row.number, row.name.clone()) let:row>
                {no_go(store, row, renamed)}
            </For>
        </ul>
        <Show when=move || store.orders.no_go.with(Vec::is_empty)>
            <p class="hint">{words().home.nothing_forbidden}</p>
        </Show>
        <div class="draw-tools">
            <Needs store verb=EDITS_HOME>
                {tool(store, Tool::Wall, "draw-wall", words().home.draw_wall)}
                {tool(store, Tool::Zone, "draw-zone", words().home.draw_zone)}
            </Needs>
        </div>
    }
}

/// Names what is forbidden, or takes its name away, so that it can be undone.
fn rename_no_go(store: Store, number: u16, after: Option<String>) {
    let home = store.known_home();
    if let Some(kept) = home.no_go.into_iter().find(|kept| kept.number == number) {
        store.edit(Edit::NameForbidden {
            shape: kept.shape,
            before: kept.name,
            after,
        });
    }
}

/// Allows again what was forbidden, so that it can be undone.
fn allow(store: Store, number: u16) {
    let home = store.known_home();
    if let Some(kept) = home.no_go.into_iter().find(|kept| kept.number == number) {
        let (shape, name) = (kept.shape, kept.name);
        store.edit(Edit::Allow(Forbidden { shape, name }));
    }
}

fn no_go(store: Store, row: NoGoRow, renamed: RwSignal<Option<u16>>) -> impl IntoView {
    let NoGoRow { number, name, .. } = row;
    // It changes while the row stays: whoever reshapes by keys comes back to the same button.
    let extent = move || {
        let rows = store.orders.no_go.read();
        rows.iter()
            .find(|row| row.number == number)
            .map(|row| row.words.clone())
    };
    let form_label = words().home.no_go_name.fill([&name]);
    let drawn = DrawnRow {
        target: Target::NoGo(number),
        kind: "no-go",
        number,
        name: name.clone(),
    };
    let remove = Callback::new(move |number| allow(store, number));
    view! {
        <li>
            <span class="name">{name.clone()}</span>
            <span class="words">{extent}</span>
            <RowTools store row=drawn renamed remove />
        </li>
        <Show when=move || renamed.get() == Some(number)>
            <RenameForm
                label=form_label.clone()
                field_id="no-go-name"
                button_id="save-no-go-name"
                name=name.clone()
                opener=format!("rename-no-go-{number}")
                on_save=move |name| {
                    rename_no_go(store, number, name);
                    renamed.set(None);
                }
            />
        </Show>
    }
}
