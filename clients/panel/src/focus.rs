//! Where the keys go when what had the focus is not there any more.

use leptos::prelude::{document, request_animation_frame};
use wasm_bindgen::JsCast;
use web_sys::HtmlElement;

/// Gives the focus to an element by its name.
pub(crate) fn focus_on(id: &str) {
    let element = document().get_element_by_id(id);
    if let Some(element) = element.and_then(|element| element.dyn_into::<HtmlElement>().ok()) {
        element.focus().ok(); // An element that cannot take the focus leaves it where it is.
    }
}

/// The same of one that is there with the next picture.
pub(crate) fn focus_soon_on(id: String) {
    request_animation_frame(move || focus_on(&id));
}
