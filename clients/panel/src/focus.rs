//! Where the keys go when what had the focus is not there any more.

use std::cell::RefCell;
use std::time::Duration;

use leptos::ev;
use leptos::prelude::{document, request_animation_frame, set_interval, window_event_listener};
use wasm_bindgen::JsCast;
use web_sys::{FocusEvent, HtmlElement};

use crate::row_menu::FOLDED_ACTIONS;

/// How often it is looked whether the focus was lost.
const LOOK_EVERY: Duration = Duration::from_millis(100);
/// A part of the page that is drawn anew is there again after so many looks.
const LOOKS: u8 = 8;

thread_local! {
    /// What a keyboard was on last, and how often it was missed since.
    static LAST: RefCell<Option<(HtmlElement, u8)>> = const { RefCell::new(None) };
}

/// Whoever goes by keys never loses the focus: when what had it is drawn anew it has it again, and when it is gone for good the open
/// tab has.
pub(crate) fn keep_focus() {
    window_event_listener(ev::focusin, |event: FocusEvent| {
        let element = event
            .target()
            .and_then(|target| target.dyn_into::<HtmlElement>().ok());
        let by_keys = element.filter(|element| element.matches(":focus-visible").unwrap_or(false));
        LAST.set(by_keys.map(|element| (element, 0)));
    });
    set_interval(look, LOOK_EVERY);
}

fn look() {
    let has_one = document()
        .active_element()
        .is_some_and(|element| element.tag_name() != "BODY");
    if has_one {
        return;
    }
    let missed = LAST.with_borrow_mut(|last| {
        let (element, looks) = last.as_mut().filter(|(element, _)| !element.is_connected())?;
        *looks = looks.saturating_add(1);
        Some((element.id(), *looks))
    });
    let Some((id, looks)) = missed else { return };
    if !id.is_empty() && document().get_element_by_id(&id).is_some() {
        focus_on(&id);
    } else if looks >= LOOKS
        && let Ok(Some(tab)) = document().query_selector("[role=tab][aria-selected=true]")
    {
        focus_on(&tab.id());
    }
}

/// Gives the focus to an element by its name, or to what unfolds it.
pub(crate) fn focus_on(id: &str) {
    let element = document().get_element_by_id(id);
    let folded = element
        .as_ref()
        .and_then(|element| element.closest(FOLDED_ACTIONS).ok().flatten());
    let opener = folded.and_then(|actions| actions.previous_element_sibling());
    if let Some(element) = opener
        .or(element)
        .and_then(|element| element.dyn_into::<HtmlElement>().ok())
    {
        element.focus().ok(); // An element that cannot take the focus leaves it where it is.
    }
}

/// The same of one that is there with the next picture.
pub(crate) fn focus_soon_on(id: String) {
    request_animation_frame(move || focus_on(&id));
}
