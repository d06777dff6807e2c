//! The views that nobody sees before they ask for them: a file of their own, which the page loads once the robot is on the screen.
// The macro that marks where the program is split writes some.
#![allow(unsafe_code, reason = "wasm_split")]

use leptos::prelude::*;
use leptos::task::spawn_local;
use wasm_split_helpers::{SplitLoaderError, wasm_split};

use crate::access::PairView;
use crate::device_sheet::DeviceSheet;
use crate::drive::LendView;
use crate::history::HistorySheet;
use crate::home_view::{HomePart, HomeSheet};
use crate::language::words;
use crate::log_view::LogView;
use crate::map::{EditBar, OrderBar, ReshapeView, SketchView};
use crate::mixes::MixEditor;
use crate::schedules::ScheduleSheet;
use crate::store::Store;
use crate::summary_view::SummaryView;
use crate::whole_home_view::WholeHomeView;
use crate::why_view::WhyView;

/// How each view is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LateViews {
    pub(crate) home: fn(Store, RwSignal<HomePart>) -> AnyView,
    pub(crate) schedules: fn(Store) -> AnyView,
    pub(crate) history: fn(Store) -> AnyView,
    pub(crate) why: fn(Store) -> AnyView,
    pub(crate) device: fn(Store) -> AnyView,
    pub(crate) log: fn(Store) -> AnyView,
    pub(crate) mix_editor: fn(Store) -> AnyView,
    pub(crate) lend: fn(Store) -> AnyView,
    pub(crate) pair: fn(Store) -> AnyView,
    pub(crate) summary: fn(Store) -> AnyView,
    /// What is drawn over the map: a sketch and a shape that is changed.
    pub(crate) drawings: fn(Store) -> AnyView,
    pub(crate) edit_bar: fn(Store) -> AnyView,
    pub(crate) order_bar: fn(Store) -> AnyView,
}

#[derive(Clone, Copy, Debug)]
enum Loaded {
    NotYet,
    Loading,
    Failed,
    There(LateViews),
}

/// The file of the views, loaded when it is needed for the first time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Late {
    loaded: RwSignal<Loaded>,
}

impl Late {
    pub(crate) fn new() -> Self {
        Self {
            loaded: RwSignal::new(Loaded::NotYet),
        }
    }

    /// Loads the file unless it is there or on its way.
    pub(crate) fn load(self) {
        if !matches!(self.loaded.get_untracked(), Loaded::NotYet | Loaded::Failed) {
            return;
        }
        self.loaded.set(Loaded::Loading);
        spawn_local(async move {
            let views = late_views().await;
            self.loaded.set(views.map_or(Loaded::Failed, Loaded::There));
        });
    }

    /// One of the views as soon as it is there, and nothing before.
    pub(crate) fn when_there(
        self,
        make: impl Fn(LateViews) -> AnyView + Copy + Send + 'static,
    ) -> impl IntoView {
        move || match self.loaded.get() {
            Loaded::There(views) => Some(make(views)),
            Loaded::NotYet | Loaded::Loading | Loaded::Failed => None,
        }
    }

    /// One of the views, or a word about its coming.
    pub(crate) fn view(self, make: impl Fn(LateViews) -> AnyView + Copy + Send + 'static) -> impl IntoView {
        self.load();
        move || {
            match self.loaded.get() {
            Loaded::There(views) => make(views),
            Loaded::NotYet | Loaded::Loading => view! { <p class="hint" role="status">{words().frame.on_its_way}</p> }.into_any(),
            Loaded::Failed => view! {
                <p class="hint" role="alert">{words().frame.did_not_come}</p>
                <button type="button" class="small" on:click=move |_| self.load()>{words().frame.load_again}</button>
            }
            .into_any(),
        }
        }
    }
}

/// The program is cut here: what only these views need is not in the first file.
#[wasm_split(late, fallible)]
fn late_views() -> Result<LateViews, SplitLoaderError> {
    Ok(LateViews {
        home: |store, open| view! { <HomeSheet store open /> }.into_any(),
        schedules: |store| view! { <ScheduleSheet store /> }.into_any(),
        history: |store| view! { <HistorySheet store /> }.into_any(),
        why: |store| view! { <WhyView store /> }.into_any(),
        device: |store| view! { <DeviceSheet store /> }.into_any(),
        log: |store| view! { <LogView store /> }.into_any(),
        mix_editor: |store| view! { <MixEditor store /> }.into_any(),
        lend: |store| view! { <LendView store /> }.into_any(),
        pair: |store| view! { <PairView store /> }.into_any(),
        summary: |store| view! { <SummaryView store /><WholeHomeView store /> }.into_any(),
        drawings: |store| view! { <SketchView store /><ReshapeView store /> }.into_any(),
        edit_bar: |store| view! { <EditBar store /> }.into_any(),
        order_bar: |store| view! { <OrderBar store /> }.into_any(),
    })
}
