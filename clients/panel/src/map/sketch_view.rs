//! What is being drawn, over the map: a line or a rectangle from the first place to the pointer, and the middle of the map
//! for those who draw with keys.

use leptos::prelude::*;
use panel_logic::Tool;

use crate::store::Store;

#[component]
pub(crate) fn SketchView(store: Store) -> impl IntoView {
    let orders = store.orders;
    let draws = move || orders.sketch.with(|sketch| sketch.tool() != Tool::Choose);
    let path = move || {
        let Some((x, y)) = orders.sketch.with(|sketch| sketch.first()) else {
            return String::new();
        };
        let (far_x, far_y) = orders.pointer.get().unwrap_or((x, y));
        let is_line = orders.sketch.with(|sketch| sketch.is_line());
        let corners = if is_line {
            vec![(x, y), (far_x, far_y)]
        } else {
            vec![(x, y), (far_x, y), (far_x, far_y), (x, far_y), (x, y)]
        };
        let on_screen = |(x, y): (f64, f64)| {
            let (px, py) = store
                .map
                .with_value(|map| map.with(|scene| scene.camera.screen_from_map(x, y)));
            format!("{px:.1} {py:.1}")
        };
        let places: Vec<String> = corners.into_iter().map(on_screen).collect();
        format!("M{}", places.join("L"))
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
