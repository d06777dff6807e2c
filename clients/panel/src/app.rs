//! The page as a whole.

use leptos::prelude::*;

use crate::access::{Access, NewcomerView, PairView};
use crate::actions::Actions;
use crate::header::Header;
use crate::language::words;
use crate::map::MapView;
use crate::status_view::{RefusalView, StatusView};
use crate::store::Store;
use crate::tabs::Tabs;
use crate::theme::Theme;

#[component]
pub(crate) fn App() -> impl IntoView {
    let store = Store::new();
    let theme = RwSignal::new(Theme::at_start());
    store.map.with_value(|map| map.set_theme(theme.get_untracked()));
    store.connect();
    let is_stranger = Memo::new(move |_| store.entrance.access.with(|access| *access == Access::Stranger));
    view! {
        <a class="skip" href="#actions">{words().frame.skip}</a>
        <Header store theme />
        <Show when=move || is_stranger.get()>
            <PairView store />
        </Show>
        <main class="page" hidden=move || is_stranger.get()>
            <MapView store />
            <div class="side">
                <StatusView store />
                <RefusalView store />
                <NewcomerView entrance=store.entrance />
                <Actions store />
                <Tabs store />
            </div>
        </main>
    }
}
