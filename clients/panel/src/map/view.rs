//! The map on the page: canvas, its buttons, legend and scale.

use std::time::Duration;

use leptos::html;
use leptos::prelude::*;
use panel_logic::{Orbit, has_carpet, scale_bar};

use super::canvas::{MapCanvas, STEP, apply, fit, toggle_relief, zoom};
use super::scene::{CameraMode, Ground, Scene};
use super::view_memory::{keep_view, kept_view};
use crate::changes::set_if_changed;
use crate::icons::{Icon, icon};
use crate::language::words;
use crate::store::Store;

#[component]
pub(crate) fn MapView(store: Store) -> impl IntoView {
    let map = store.map.get_value();
    let failure = RwSignal::new(None::<String>);
    let mode = RwSignal::new(CameraMode::Fitted);
    let footer = RwSignal::new(Footer::default());
    let ground = RwSignal::new(Ground::Known);
    let orbit = RwSignal::new(kept_view());
    map.change(|scene| scene.look_from(orbit.get_untracked()));
    refresh(store, (mode, ground, orbit), footer);
    Effect::new(move |_| {
        store.orders.choice.with(|choice| {
            store.map.with_value(|map| map.choose(choice));
        });
    });
    view! {
        <section class="map" aria-label=words().map.title>
            <MapCanvas store mode failure />
            <RoomNames store />
            {store.late.when_there(move |views| (views.drawings)(store))}
            <GroundSwitch store shown=ground />
            <Failures failure footer />
            <MapTools store mode orbit />
            <MapFooter store footer />
        </section>
        {store.late.when_there(move |views| (views.order_bar)(store))}
    }
}

/// Buttons for the view, and for edits.
#[component]
fn MapTools(store: Store, mode: RwSignal<CameraMode>, orbit: RwSignal<Option<Orbit>>) -> impl IntoView {
    let follow = move |_| {
        let next = if mode.get_untracked() == CameraMode::Following {
            CameraMode::Free
        } else {
            CameraMode::Following
        };
        mode.set(next);
        store.map.with_value(|map| map.change(|scene| scene.mode = next));
    };
    let button = move |label: &'static str, shape: Icon, change: fn(&mut Scene)| {
        view! {
            <button type="button" class="round" aria-label=label title=label on:click=move |_| apply(store, mode, change)>
                {icon(shape)}
            </button>
        }
    };
    view! {
        <div class="map-tools" role="group" aria-label=words().map.view>
            {button(words().map.zoom_in, Icon::Plus, |scene| zoom(scene, STEP))}
            {button(words().map.zoom_out, Icon::Minus, |scene| zoom(scene, 1.0 / STEP))}
            {button(words().map.everything, Icon::Fit, fit)}
            <button
                type="button"
                class="round"
                id="follow"
                aria-label=words().map.follow
                title=words().map.follow
                aria-pressed=move || if mode.get() == CameraMode::Following { "true" } else { "false" }
                on:click=follow
            >
                {icon(Icon::Follow)}
            </button>
            <button
                type="button"
                class="round words"
                id="view-3d"
                aria-label=words().map.relief
                title=words().map.relief_key
                aria-pressed=move || if orbit.get().is_some() { "true" } else { "false" }
                on:click=move |_| {
                    apply(store, mode, toggle_relief);
                    orbit.set(store.map.with_value(|map| map.with(|scene| scene.camera.orbit())));
                }
            >
                "3D"
            </button>
            {store.late.when_there(move |views| (views.edit_bar)(store))}
        </div>
    }
}

/// Why there is no map, or no view of it in 3D.
#[component]
fn Failures(failure: RwSignal<Option<String>>, footer: RwSignal<Footer>) -> impl IntoView {
    view! {
        <Show when=move || failure.get().is_some()>
            <p class="map-failure" role="alert">
                {move || failure.get()} " " {words().map.cannot_draw}
            </p>
        </Show>
        <Show when=move || footer.with(|footer| footer.relief_failure.is_some())>
            <p class="map-note" id="no-relief" role="status">
                {words().map.no_relief} " "
                {move || footer.with(|footer| footer.relief_failure.clone())}
            </p>
        </Show>
    }
}

/// Where the names of the rooms go. Readers find them as a list on the page.
#[component]
fn RoomNames(store: Store) -> impl IntoView {
    let place = NodeRef::<html::Div>::new();
    Effect::new(move |_| {
        if let Some(place) = place.get() {
            store.map.with_value(|map| map.name_rooms_in(place.into()));
        }
    });
    view! { <div class="room-names" node_ref=place aria-hidden="true"></div> }
}

/// What lies under path and robot, where there is a choice: only a simulated home has a true plan.
#[component]
fn GroundSwitch(store: Store, shown: RwSignal<Ground>) -> impl IntoView {
    let simulated = move || store.home.with(Option::is_some);
    let choice = move |ground: Ground, id: &'static str, label: &'static str| {
        let choose = move |_| {
            shown.set(ground);
            store.map.with_value(|map| map.change(|scene| scene.show(ground)));
        };
        view! {
            <button
                type="button"
                id=id
                aria-pressed=move || if shown.get() == ground { "true" } else { "false" }
                on:click=choose
            >
                {label}
            </button>
        }
    };
    view! {
        <Show when=simulated>
            <div class="ground-switch" role="group" aria-label=words().map.ground>
                {choice(Ground::True, "ground-true", words().map.floor_plan)}
                {choice(Ground::Known, "ground-known", words().map.robot_map)}
            </div>
        </Show>
    }
}

/// What the footer of the map shows.
#[derive(Clone, Debug, Default, PartialEq)]
struct Footer {
    scale_name: String,
    scale_px: f64,
    /// A planned path, or doors, are visible.
    plans: bool,
    /// The robot's map is shown, and with it its border.
    unsure: bool,
    /// Detected carpet is shown.
    carpet: bool,
    has_doors: bool,
    /// Why there is no view in 3D.
    relief_failure: Option<String>,
}

#[component]
fn MapFooter(store: Store, footer: RwSignal<Footer>) -> impl IntoView {
    let simulated = move || store.home.with(Option::is_some);
    let unfolded = RwSignal::new(false);
    view! {
        <div class="map-footer">
            <button
                type="button"
                class="small legend-fold"
                id="legend-fold"
                aria-expanded=move || if unfolded.get() { "true" } else { "false" }
                aria-controls="legend"
                on:click=move |_| unfolded.update(|unfolded| *unfolded = !*unfolded)
            >
                {words().map.legend}
            </button>
            <ul class="legend" id="legend" class:unfolded=move || unfolded.get() aria-label=words().map.legend>
                <li><span class="key swept" aria-hidden="true"></span>{words().map.swept}</li>
                <li><span class="key path" aria-hidden="true"></span>{words().map.path}</li>
                <li><span class="key bump" aria-hidden="true"></span>{words().map.bump}</li>
                <Show when=move || footer.get().unsure>
                    <li><span class="key unsure" aria-hidden="true"></span>{words().map.unsure}</li>
                </Show>
                <Show when=move || footer.get().carpet>
                    <li><span class="key carpet" aria-hidden="true"></span>{words().map.carpet}</li>
                </Show>
                <Show when=move || footer.get().plans>
                    <li><span class="key way" aria-hidden="true"></span>{words().map.planned}</li>
                </Show>
                <Show when=move || footer.get().has_doors>
                    <li><span class="key door" aria-hidden="true"></span>{words().map.door}</li>
                </Show>
                <Show when=simulated>
                    <li><span class="key truth" aria-hidden="true"></span>{words().map.actual_position}</li>
                </Show>
            </ul>
            <span class="spring"></span>
            <span class="scale">
                <span class="scale-bar" aria-hidden="true" style:width=move || format!("{:.0}px", footer.get().scale_px)></span>
                {move || footer.get().scale_name}
            </span>
        </div>
    }
}

/// What the buttons show of the scene.
type Shown = (RwSignal<CameraMode>, RwSignal<Ground>, RwSignal<Option<Orbit>>);

/// Keeps the figures beside the map up to date, four times a second.
fn refresh(store: Store, (mode, ground, orbit): Shown, footer: RwSignal<Footer>) {
    let update = move || {
        store.map.with_value(|map| {
            map.publish_figures();
            let (name, width) = scale_bar(words(), map.with(|scene| scene.camera.scale()));
            let next = Footer {
                scale_name: name,
                scale_px: width,
                unsure: map.with(|scene| scene.ground() == Ground::Known && scene.plan().is_some()),
                carpet: map
                    .with(|scene| scene.ground() == Ground::Known && scene.plan().is_some_and(has_carpet)),
                plans: map.with(|scene| !scene.planned_path.is_empty()),
                has_doors: map.with(|scene| scene.doors().next().is_some()),
                relief_failure: map.with(|scene| scene.relief_failure().map(str::to_owned)),
            };
            set_if_changed(footer, next);
            let shown = map.with(|scene| scene.ground());
            set_if_changed(ground, shown);
            let seen_from = map.with(|scene| scene.camera.orbit());
            set_if_changed(orbit, seen_from);
            keep_view(seen_from);
            let current = map.with(|scene| scene.mode);
            set_if_changed(mode, current);
        });
    };
    if let Ok(timer) = set_interval_with_handle(update, Duration::from_millis(250)) {
        on_cleanup(move || timer.clear());
    }
}
