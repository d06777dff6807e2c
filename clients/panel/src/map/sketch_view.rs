//! What is being drawn, over the map: a spot under the pointer, a line, a rectangle or a robot on its dock from the first place to it, and
//! the middle of the map for those who draw with keys.

use leptos::prelude::*;
use panel_logic::{MapPoint, Sketch, Tool, dock_border, dock_pose, spot_border};

use crate::store::Store;

/// Corners of what would be drawn if the pointer's place were the last one, for a robot of this radius.
fn corners(sketch: Sketch, pointer: Option<MapPoint>, radius_m: f64) -> Vec<MapPoint> {
    if sketch.is_place() {
        let border = pointer.map(|place| spot_border(place.into())).unwrap_or_default();
        let again = border.first().copied();
        return border.into_iter().chain(again).map(Into::into).collect();
    }
    let Some(first) = sketch.first() else {
        return Vec::new();
    };
    let last = pointer.unwrap_or(first);
    if sketch.tool() == Tool::Dock {
        let border = dock_border(dock_pose(first, last), radius_m);
        return border.into_iter().map(Into::into).collect();
    }
    if sketch.is_line() {
        vec![first, last]
    } else {
        let (beside, above) = (MapPoint::new(last.x, first.y), MapPoint::new(first.x, last.y));
        vec![first, beside, last, above, first]
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
        let on_screen = |corner: MapPoint| {
            let pixel = store
                .map
                .with_value(|map| map.with(|scene| scene.camera.screen_from_map(corner)));
            format!("{:.1} {:.1}", pixel.x, pixel.y)
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
