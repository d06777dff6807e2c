//! The floors of the home: on which the robot is, and what a person can say of them.

use leptos::prelude::*;
use panel_logic::{area_text, floor_title, question_text};
use rvac_api::{FloorView, RequestBody};

use crate::access::{EDITS_HOME, Needs};
use crate::floor_files::FloorFiles;
use crate::home_view::rooms_text;
use crate::language::words;
use crate::rename_form::RenameForm;
use crate::row_menu::RowMenu;
use crate::store::Store;

#[component]
pub(crate) fn FloorList(store: Store) -> impl IntoView {
    let renamed = RwSignal::new(None::<u16>);
    let question = move || {
        store.floors.with(|view| {
            view.question
                .as_ref()
                .map(|question| question_text(words(), question))
        })
    };
    let is_open = move || {
        store
            .floors
            .with(|view| view.here.is_none() && view.question.is_none())
    };
    let begin = move |_| store.ask(RequestBody::NewFloor { name: None });
    view! {
        <h3 id="floors-title">{words().home.floors}</h3>
        {move || question().map(|text| view! { <p class="hint" id="floor-question" role="status">{text}</p> })}
        <Show when=is_open>
            <p class="hint">{words().home.floor_open}</p>
        </Show>
        <ul id="floors" class="rows" aria-labelledby="floors-title">
            {move || {
                let view = store.floors.get();
                let here = view.here;
                view.floors.into_iter().map(|floor| row(store, floor, here, renamed)).collect_view()
            }}
        </ul>
        <div class="draw-tools">
            <Needs store verb=EDITS_HOME>
                <button type="button" class="small" id="new-floor" on:click=begin>
                    {words().home.new_floor}
                </button>
            </Needs>
        </div>
        <FloorFiles store />
    }
}

fn row(store: Store, floor: FloorView, here: Option<u16>, renamed: RwSignal<Option<u16>>) -> impl IntoView {
    let (number, title) = (floor.number, floor_title(words(), &floor));
    let is_here = here == Some(number);
    let (is_removed, name) = (floor.removed, title.clone());
    let extent = extent_text(&floor);
    let (named, rename_label) = (
        floor.name.clone().unwrap_or_default(),
        words().home.rename_named.fill([&title]),
    );
    let choose = (!floor.removed && !is_here).then(|| {
        action(
            format!("choose-floor-{number}"),
            words().home.is_on.fill([&title]),
            words().home.it_is_here,
            move || {
                store.ask(RequestBody::ChooseFloor { floor: number });
            },
        )
    });
    let remove = (!floor.removed).then(|| {
        action(
            format!("remove-floor-{number}"),
            words().home.remove_named.fill([&title]),
            words().frame.remove,
            move || {
                store.ask(RequestBody::RemoveFloor { floor: number });
            },
        )
    });
    let restore = floor.removed.then(|| {
        action(
            format!("restore-floor-{number}"),
            words().home.bring_back_named.fill([&title]),
            words().home.bring_back,
            move || {
                store.ask(RequestBody::RestoreFloor { floor: number });
            },
        )
    });
    let rename = (!floor.removed).then(|| {
        action(
            format!("rename-floor-{number}"),
            rename_label,
            words().frame.rename,
            move || {
                renamed.update(|renamed| *renamed = (*renamed != Some(number)).then_some(number));
            },
        )
    });
    view! {
        <li>
            <span class="name">{title.clone()}</span>
            <span class="words">{extent}</span>
            {is_here.then(|| view! { <span class="newest">{words().home.is_here}</span> })}
            <Needs store verb="choose-floor">{choose}</Needs>
            <Needs store verb=EDITS_HOME>
                {restore}
                {(!is_removed).then(|| view! { <RowMenu of=format!("floor-{number}") name>{rename} {remove}</RowMenu> })}
            </Needs>
        </li>
        <Show when=move || renamed.get() == Some(number)>
            {rename_form(store, number, named.clone(), renamed)}
        </Show>
    }
}

fn rename_form(store: Store, number: u16, name: String, renamed: RwSignal<Option<u16>>) -> impl IntoView {
    view! {
        <RenameForm
            label=words().home.floor_name.fill([&number])
            field_id="floor-name"
            button_id="save-floor-name"
            name
            opener=format!("rename-floor-{number}")
            on_save=move |name| {
                store.ask(RequestBody::NameFloor { floor: number, name });
                renamed.set(None);
            }
        />
    }
}

fn action(id: String, label: String, text: &'static str, press: impl Fn() + 'static) -> impl IntoView {
    view! {
        <button type="button" class="small" id=id aria-label=label on:click=move |_| press()>
            {text}
        </button>
    }
}

/// What people call a floor, else its number.
fn extent_text(floor: &FloorView) -> String {
    let removed = if floor.removed { words().home.removed } else { "" };
    if floor.area_m2 == 0.0 {
        return format!("{}{removed}", words().home.no_map);
    }
    format!(
        "{}, {}{removed}",
        area_text(words(), floor.area_m2),
        rooms_text(floor.rooms)
    )
}
