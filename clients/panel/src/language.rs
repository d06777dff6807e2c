//! The language of the page: that of the browser until a person chooses.

use std::cell::Cell;

use leptos::prelude::*;
use panel_logic::{Language, Words};

use crate::icons::{Icon, icon};

/// Under this name the browser keeps the choice, or the page's address has it; `boot.js` reads both.
const KEY: &str = "language";

thread_local! {
    static SPOKEN: Cell<Language> = const { Cell::new(Language::English) };
}

/// Takes the language that `boot.js` found.
pub(crate) fn begin() {
    let tag = document()
        .document_element()
        .and_then(|root| root.get_attribute("lang"));
    let found = tag.and_then(|tag| Language::of_tag(&tag));
    SPOKEN.set(found.unwrap_or(Language::English));
}

/// Every text of the page. It stays the same as long as the page.
pub(crate) fn words() -> &'static Words {
    SPOKEN.get().words()
}

/// Stores the choice for the next visit and loads the page again. A browser that keeps nothing gets it in the page's address, where
/// `boot.js` looks first.
fn choose(language: Language) {
    let storage = window().local_storage().ok().flatten();
    let is_kept = storage.is_some_and(|storage| storage.set_item(KEY, language.tag()).is_ok());
    let wanted = if is_kept {
        String::new()
    } else {
        format!("?{KEY}={}", language.tag())
    };
    let location = window().location();
    // A page that cannot be loaded again goes on in the old language.
    if location.search().is_ok_and(|search| search == wanted) {
        location.reload().ok();
    } else {
        location.set_search(&wanted).ok();
    }
}

#[component]
pub(crate) fn LanguageChoice() -> impl IntoView {
    let spoken = words().language;
    let take = move |event| {
        if let Some(language) = Language::of_tag(&event_target_value(&event)) {
            choose(language);
        }
    };
    let option = move |language: Language| {
        view! {
            <option value=language.tag() lang=language.tag() selected=language == spoken>{language.own_name()}</option>
        }
    };
    view! {
        <span class="round language">
            {icon(Icon::Globe)}
            <select id="language" aria-label=words().frame.language title=words().frame.language on:change=take>
                {Language::ALL.map(option).into_iter().collect_view()}
            </select>
        </span>
    }
}
