//! The page as a whole.

use leptos::prelude::*;
use panel_logic::Currency;

use crate::access::{Access, NewcomerView};
use crate::actions::Actions;
use crate::bottom_sheet::SheetHandle;
use crate::focus::keep_focus;
use crate::header::Header;
use crate::language::words;
use crate::map::MapView;
use crate::status_view::StatusView;
use crate::store::Store;
use crate::tabs::Tabs;
use crate::theme::Theme;
use crate::toasts::Toasts;

#[component]
pub(crate) fn App() -> impl IntoView {
    let store = Store::new();
    let theme = RwSignal::new(Theme::at_start());
    store.map.with_value(|map| map.set_theme(theme.get_untracked()));
    store.connect();
    keep_focus();
    // What comes with the first picture is not held up by what comes after it.
    Effect::new(move |_| {
        if store.status.with(Option::is_some) {
            store.late.load();
        }
    });
    let is_stranger = Memo::new(move |_| store.entrance.access.with(|access| *access == Access::Stranger));
    let is_current = Memo::new(move |_| store.currency.get() == Currency::Current);
    view! {
        <a class="skip" href="#actions">{words().frame.skip}</a>
        <Header store theme />
        <Show when=move || is_stranger.get()>
            {store.late.view(move |views| (views.pair)(store))}
        </Show>
        <main class="page" hidden=move || is_stranger.get() data-current=move || if is_current.get() { "yes" } else { "no" }>
            <MapView store />
            <div class="side">
                <div class="sheets">
                    <SheetHandle />
                    <StatusView store />
                    <NewcomerView entrance=store.entrance />
                    <Tabs store />
                </div>
                <Actions store />
            </div>
        </main>
        <Toasts store />
    }
}
