//! What is being drawn, over the map: a line or a rectangle from the first place to the pointer, and the middle of the map
//! for those who draw with keys.

use leptos::prelude::*;
use panel_logic::Tool;

use crate::store::Store;

#[component]
pub(crate) fn SketchView(store: Store) -> impl IntoView {
    let orders = store.orders;
    let draws = move || orders.sketch.with(|sketch| sketch.tool() != Tool::Choose);
    let ends = move || {
        let first = orders.sketch.with(|sketch| sketch.first())?;
        let last = orders.pointer.get().unwrap_or(first);
        let on_screen = |(x, y): (f64, f64)| {
            store
                .map
                .with_value(|map| map.with(|scene| scene.camera.screen_from_map(x, y)))
        };
        Some((on_screen(first), on_screen(last)))
    };
    let path = move || {
        let Some(((x, y), (far_x, far_y))) = ends() else {
            return String::new();
        };
        if orders.sketch.with(|sketch| sketch.tool() == Tool::Wall) {
            format!("M{x:.1} {y:.1}L{far_x:.1} {far_y:.1}")
        } else {
            format!("M{x:.1} {y:.1}H{far_x:.1}V{far_y:.1}H{x:.1}Z")
        }
    };
    view! {
        <Show when=draws>
            <div class="cross" aria-hidden="true"></div>
            <svg class="sketch" aria-hidden="true" focusable="false">
                <path d=path />
            </svg>
        </Show>
    }
}
