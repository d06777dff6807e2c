//! Light or dark: as the system says until a person chooses.

use leptos::prelude::*;
use panel_logic::MapPalette;

/// The two themes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Theme {
    Light,
    Dark,
}

impl Theme {
    /// What is in force when the page opens: the choice that `boot.js` found, else the system's.
    pub(crate) fn at_start() -> Self {
        let chosen = document()
            .document_element()
            .and_then(|root| root.get_attribute("data-theme"));
        match chosen.as_deref() {
            Some("dark") => Self::Dark,
            Some("light") => Self::Light,
            _ => Self::of_system(),
        }
    }

    /// The colours of the map.
    pub(crate) const fn palette(self) -> MapPalette {
        match self {
            Self::Light => MapPalette::LIGHT,
            Self::Dark => MapPalette::DARK,
        }
    }

    /// The other one.
    pub(crate) const fn other(self) -> Self {
        match self {
            Self::Light => Self::Dark,
            Self::Dark => Self::Light,
        }
    }

    /// Makes it the choice, for this page and the next visit.
    pub(crate) fn choose(self) {
        let name = match self {
            Self::Light => "light",
            Self::Dark => "dark",
        };
        if let Some(root) = document().document_element() {
            root.set_attribute("data-theme", name).ok(); // The name is a valid one.
        }
        if let Ok(Some(storage)) = window().local_storage() {
            storage.set_item("theme", name).ok(); // Without storage the choice lasts as long as the page.
        }
    }

    fn of_system() -> Self {
        let dark = window()
            .match_media("(prefers-color-scheme: dark)")
            .ok()
            .flatten();
        if dark.is_some_and(|query| query.matches()) {
            Self::Dark
        } else {
            Self::Light
        }
    }
}
