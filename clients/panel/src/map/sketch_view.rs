//! What is being drawn, over the map: a spot under the pointer, a line, a rectangle or a robot on its dock from the first place to it, and
//! the middle of the map for those who draw with keys.

use leptos::prelude::*;
use panel_logic::{Sketch, Tool, dock_border, dock_pose, spot_border};

use crate::store::Store;

/// Corners of what would be drawn if the pointer's place were the last one, for a robot of this radius.
fn corners(sketch: Sketch, pointer: Option<(f64, f64)>, radius_m: f64) -> Vec<(f64, f64)> {
    if sketch.is_place() {
        let border = pointer.map(|place| spot_border(place.into())).unwrap_or_default();
        let again = border.first().copied();
        return border.into_iter().chain(again).map(Into::into).collect();
    }
    let Some((x, y)) = sketch.first() else {
        return Vec::new();
    };
    let (far_x, far_y) = pointer.unwrap_or((x, y));
    if sketch.tool() == Tool::Dock {
        let border = dock_border(dock_pose((x, y), (far_x, far_y)), radius_m);
        return border.into_iter().map(Into::into).collect();
    }
    if sketch.is_line() {
        vec![(x, y), (far_x, far_y)]
    } else {
        vec![(x, y), (far_x, y), (far_x, far_y), (x, far_y), (x, y)]
    }
}

#[component]
pub(crate) fn SketchView(store: Store) -> impl IntoView {
    let orders = store.orders;
    let draws = move || orders.sketch.with(|sketch| sketch.tool() != Tool::Choose);
    let path = move || {
        let radius_m = store
            .map
            .with_value(|map| map.with(|scene| scene.body_radius_m()));
        let corners = corners(orders.sketch.get(), orders.pointer.get(), radius_m);
        if corners.is_empty() {
            return String::new();
        }
        let on_screen = |(x, y): (f64, f64)| {
            let (px, py) = store
                .map
                .with_value(|map| map.with(|scene| scene.camera.screen_from_map(x, y)));
            format!("{px:.1} {py:.1}")
        };
        store.map.with_value(super::MapHandle::follow_camera);
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
