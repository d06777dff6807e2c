//! The floors of the home: on which the robot is, and what a person can say of them.

use leptos::ev::SubmitEvent;
use leptos::prelude::*;
use panel_logic::area_text;
use rvac_api::{FloorView, RequestBody};

use crate::store::Store;

/// Longest name of a floor, in characters.
const NAME_MAX: &str = "40";

#[component]
pub(crate) fn FloorList(store: Store) -> impl IntoView {
    let renamed = RwSignal::new(None::<u16>);
    let question = move || {
        store
            .floors
            .with(|view| view.question.as_ref().map(|question| question.text.clone()))
    };
    let is_open = move || {
        store
            .floors
            .with(|view| view.here.is_none() && view.question.is_none())
    };
    let begin = move |_| store.ask(RequestBody::NewFloor { name: None });
    view! {
        <h3 id="floors-title">"Floors"</h3>
        {move || question().map(|text| view! { <p class="hint" id="floor-question" role="status">{text}</p> })}
        <Show when=is_open>
            <p class="hint">"The robot finds out on which floor it is on its dock, or while it cleans."</p>
        </Show>
        <ul id="floors" class="rows" aria-labelledby="floors-title">
            {move || {
                let view = store.floors.get();
                let here = view.here;
                view.floors.into_iter().map(|floor| row(store, (floor, here), renamed)).collect_view()
            }}
        </ul>
        <div class="draw-tools">
            <button type="button" class="small" id="new-floor" on:click=begin>
                "It is on a new floor"
            </button>
        </div>
    }
}

fn row(
    store: Store,
    (floor, here): (FloorView, Option<u16>),
    renamed: RwSignal<Option<u16>>,
) -> impl IntoView {
    let (number, title) = (floor.number, floor.title());
    let is_here = here == Some(number);
    let words = words(&floor);
    let (named, rename_label) = (floor.name.clone().unwrap_or_default(), format!("Rename {title}"));
    let choose = (!floor.removed && !is_here).then(|| {
        action(
            (
                format!("choose-floor-{number}"),
                format!("The robot is on {title}"),
            ),
            "It is here",
            move || {
                store.ask(RequestBody::ChooseFloor { floor: number });
            },
        )
    });
    let remove = (!floor.removed).then(|| {
        action(
            (format!("remove-floor-{number}"), format!("Remove {title}")),
            "Remove",
            move || {
                store.ask(RequestBody::RemoveFloor { floor: number });
            },
        )
    });
    let restore = floor.removed.then(|| {
        action(
            (format!("restore-floor-{number}"), format!("Bring {title} back")),
            "Bring back",
            move || {
                store.ask(RequestBody::RestoreFloor { floor: number });
            },
        )
    });
    let rename = (!floor.removed).then(|| {
        action(
            (format!("rename-floor-{number}"), rename_label),
            "Rename",
            move || {
                renamed.update(|renamed| *renamed = (*renamed != Some(number)).then_some(number));
            },
        )
    });
    view! {
        <li>
            <span class="name">{title}</span>
            <span class="words">{words}</span>
            {is_here.then(|| view! { <span class="newest">"the robot is here"</span> })}
            {choose} {rename} {remove} {restore}
        </li>
        <Show when=move || renamed.get() == Some(number)>
            <RenameForm store number named=named.clone() renamed />
        </Show>
    }
}

fn action((id, label): (String, String), text: &'static str, press: impl Fn() + 'static) -> impl IntoView {
    view! {
        <button type="button" class="small" id=id aria-label=label on:click=move |_| press()>
            {text}
        </button>
    }
}

fn words(floor: &FloorView) -> String {
    let rooms = if floor.rooms == 1 { "room" } else { "rooms" };
    let removed = if floor.removed { ", removed" } else { "" };
    if floor.area_m2 == 0.0 {
        return format!("no map yet{removed}");
    }
    format!("{}, {} {rooms}{removed}", area_text(floor.area_m2), floor.rooms)
}

#[component]
fn RenameForm(store: Store, number: u16, named: String, renamed: RwSignal<Option<u16>>) -> impl IntoView {
    let text = RwSignal::new(named);
    let save = move |event: SubmitEvent| {
        event.prevent_default();
        let name = Some(text.get_untracked()).filter(|name| !name.trim().is_empty());
        store.ask(RequestBody::NameFloor { floor: number, name });
        renamed.set(None);
    };
    view! {
        <li>
            <form class="rename" on:submit=save>
                <label class="field grow">
                    {format!("New name of floor {number}; empty for its number")}
                    <input
                        id="floor-name"
                        maxlength=NAME_MAX
                        autocomplete="off"
                        prop:value=move || text.get()
                        on:input=move |event| text.set(event_target_value(&event))
                    />
                </label>
                <button type="submit" class="small" id="save-floor-name">"Save"</button>
            </form>
        </li>
    }
}
