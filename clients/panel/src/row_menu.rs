//! The less usual actions of a row, behind one button.

use std::fmt::Display;

use leptos::ev::{self, FocusEvent, KeyboardEvent};
use leptos::html::Div;
use leptos::prelude::*;
use wasm_bindgen::JsCast;
use web_sys::{EventTarget, Node, ScrollIntoViewOptions, ScrollLogicalPosition};

use crate::focus::focus_on;
use crate::icons::{Icon, icon};
use crate::language::words;

/// The class of a list of actions; `focus_on` knows it, too.
pub(crate) const FOLDED_ACTIONS: &str = ".row-actions[hidden]";

/// A press on an action, a press elsewhere, Escape, and keys that go on fold the actions away again.
#[component]
pub(crate) fn RowMenu(
    /// First part of the names of its elements, unique in the page, as in `room-3`.
    of: String,
    /// What the row is about, for those who do not see the row.
    name: String,
    children: Children,
) -> impl IntoView {
    let is_open = RwSignal::new(false);
    let whole = NodeRef::<Div>::new();
    let actions = NodeRef::<Div>::new();
    let (button_id, actions_id) = (menu_id(&of), format!("actions-{of}"));
    close_on_press_elsewhere(is_open, whole);
    let close = {
        let button_id = button_id.clone();
        move || {
            // What has the focus would lose it with the fold.
            if is_open.get_untracked() && contains(actions, document().active_element().map(Into::into)) {
                focus_on(&button_id);
            }
            is_open.set(false);
        }
    };
    let on_key = {
        let close = close.clone();
        move |event: KeyboardEvent| {
            if event.key() == "Escape" && is_open.get_untracked() {
                event.stop_propagation();
                close();
            }
        }
    };
    let on_leave = move |event: FocusEvent| {
        // Some browsers give a pressed button no focus: then nothing follows, and the press decides.
        let follows = event.related_target();
        if follows.is_some() && !contains(whole, follows) {
            is_open.set(false);
        }
    };
    let toggle = move |_| {
        is_open.update(|is_open| *is_open = !*is_open);
        if is_open.get_untracked() {
            request_animation_frame(move || show_all_of(actions));
        }
    };
    view! {
        <div class="row-menu" node_ref=whole on:keydown=on_key on:focusout=on_leave>
            <button
                type="button"
                class="small"
                id=button_id
                aria-label=words().frame.more_for.fill([&name])
                aria-expanded=move || if is_open.get() { "true" } else { "false" }
                aria-controls=actions_id.clone()
                on:click=toggle
            >
                {icon(Icon::More)}
            </button>
            <div class="row-actions" id=actions_id node_ref=actions hidden=move || !is_open.get() on:click=move |_| close()>
                {children()}
            </div>
        </div>
    }
}

/// The button that unfolds the actions of a row.
pub(crate) fn menu_id(of: impl Display) -> String {
    format!("more-{of}")
}

fn close_on_press_elsewhere(is_open: RwSignal<bool>, whole: NodeRef<Div>) {
    let listener = window_event_listener(ev::pointerdown, move |event| {
        if is_open.get_untracked() && !contains(whole, event.target()) {
            is_open.set(false);
        }
    });
    on_cleanup(move || listener.remove());
}

fn contains(whole: NodeRef<Div>, target: Option<EventTarget>) -> bool {
    let node = target.and_then(|target| target.dyn_into::<Node>().ok());
    whole
        .get_untracked()
        .is_some_and(|whole| whole.contains(node.as_ref()))
}

/// At the foot of the page the actions would unfold below its edge.
fn show_all_of(actions: NodeRef<Div>) {
    if let Some(actions) = actions.get_untracked() {
        let nearest = ScrollIntoViewOptions::new();
        nearest.set_block(ScrollLogicalPosition::Nearest);
        actions.scroll_into_view_with_scroll_into_view_options(&nearest);
    }
}
