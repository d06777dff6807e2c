//! The points of a line's curve, which are dragged, or moved by keys.

use leptos::ev::{KeyboardEvent, PointerEvent};
use leptos::prelude::*;
use leptos::svg::Svg;
use panel_logic::{CurvePoints, Field, LinePart};
use wasm_bindgen::JsCast;
use web_sys::Element;

use super::Bench;
use crate::language::words;

/// The picture reaches from the middle to either edge by this.
const REACH: f64 = 1.12;
/// A press of an arrow key moves a point by this.
const KEY_STEP: f64 = 0.05;

#[component]
pub(super) fn Points(bench: Bench, output: usize, line: usize) -> impl IntoView {
    let field = Field::Line(output, line, LinePart::Curve);
    let points = Memo::new(move |_| {
        bench.of_draft(|draft| {
            let output = draft.profile().outputs.get(output);
            let line = output.and_then(|output| output.lines.get(line));
            line.map(|line| CurvePoints::of(&line.curve)).unwrap_or_default()
        })
    });
    let picked = RwSignal::new(0_usize);
    let set = move |curve: &CurvePoints| {
        let text = curve.text();
        bench.rearrange(|draft| draft.set(field, &text));
    };
    let tools = move || {
        if points.with(|curve| curve.points().is_empty()) {
            return view! {
                <button type="button" class="small" id=format!("shape-{output}-{line}") on:click=move |_| set(&CurvePoints::straight())>
                    {words().mix.shape_curve}
                </button>
            }
            .into_any();
        }
        view! {
            <button type="button" class="small" on:click=move |_| set(&points.with_untracked(CurvePoints::with_one_more))>
                {words().mix.add_point}
            </button>
            <button
                type="button"
                class="small"
                on:click=move |_| set(&points.with_untracked(|curve| curve.without(picked.get_untracked())))
            >
                {words().mix.remove_point}
            </button>
            <button type="button" class="small" on:click=move |_| set(&CurvePoints::default())>
                {words().mix.straighten}
            </button>
        }
        .into_any()
    };
    view! {
        <Show when=move || points.with(|curve| !curve.points().is_empty())>
            <Graph points picked set=Callback::new(move |curve: CurvePoints| set(&curve)) />
        </Show>
        <div class="mix-tools">{tools}</div>
    }
}

#[component]
fn Graph(points: Memo<CurvePoints>, picked: RwSignal<usize>, set: Callback<CurvePoints>) -> impl IntoView {
    let picture = NodeRef::<Svg>::new();
    let count = Memo::new(move |_| points.with(|curve| curve.points().len()));
    let polyline = move || {
        points.with(|curve| {
            let places: Vec<String> = curve
                .points()
                .iter()
                .map(|[at, value]| format!("{at},{}", -value))
                .collect();
            places.join(" ")
        })
    };
    view! {
        <svg
            class="mix-curve mix-points"
            node_ref=picture
            role="group"
            aria-label=words().mix.points_graph
            viewBox=format!("{0} {0} {1} {1}", -REACH, 2.0 * REACH)
        >
            <path class="frame" d="M-1 -1H1V1H-1ZM-1 0H1M0 -1V1" />
            <polyline points=polyline />
            <For each=move || 0..count.get() key=|place| *place let:place>
                <Point points place picked set picture />
            </For>
        </svg>
    }
}

#[component]
fn Point(
    points: Memo<CurvePoints>,
    place: usize,
    picked: RwSignal<usize>,
    set: Callback<CurvePoints>,
    picture: NodeRef<Svg>,
) -> impl IntoView {
    let here = Memo::new(move |_| {
        points
            .with(|curve| curve.points().get(place).copied())
            .unwrap_or_default()
    });
    let held = RwSignal::new(None::<i32>);
    let move_to = move |point: [f64; 2]| {
        let moved = points.with_untracked(|curve| curve.with_point_at(place, point));
        if points.with_untracked(|curve| *curve != moved) {
            set.run(moved);
        }
    };
    let press = move |event: PointerEvent| {
        if event.button() == 0 {
            held.set(captured(&event));
            picked.set(place);
        }
    };
    let follow = move |event: PointerEvent| {
        if held.get_untracked() == Some(event.pointer_id())
            && let Some(point) = place_in(picture, &event)
        {
            move_to(point);
        }
    };
    let on_key = move |event: KeyboardEvent| {
        if let Some(point) = moved_by_key(here.get_untracked(), &event.key()) {
            event.prevent_default();
            event.stop_propagation();
            move_to(point);
        }
    };
    let told = move || told(here.get());
    let label = move || {
        let count = points.with(|curve| curve.points().len());
        words().mix.point_of.fill([&(place + 1), &count])
    };
    view! {
        <g
            class="point"
            class:picked=move || picked.get() == place
            tabindex="0"
            role="slider"
            aria-label=label
            aria-valuemin="-100"
            aria-valuemax="100"
            aria-valuenow=move || (100.0 * here.get()[1]).round().to_string()
            aria-valuetext=told
            transform=move || format!("translate({} {})", here.get()[0], -here.get()[1])
            on:pointerdown=press
            on:pointermove=follow
            on:pointerup=move |_| held.set(None)
            on:pointercancel=move |_| held.set(None)
            on:lostpointercapture=move |_| held.set(None)
            on:focus=move |_| picked.set(place)
            on:keydown=on_key
        >
            <circle class="thumb" r="0.24" />
            <circle r="0.07" />
        </g>
    }
}

/// Where a point is, in words.
fn told([at, value]: [f64; 2]) -> String {
    let percent = |share: f64| words().unit.percent.fill([&words().number(100.0 * share, 0)]);
    words().mix.point_is.fill([&percent(at), &percent(value)])
}

/// The pointer, if what it pressed gets its news from now on.
fn captured(event: &PointerEvent) -> Option<i32> {
    let target = event.current_target()?.dyn_into::<Element>().ok()?;
    let pointer = event.pointer_id();
    target.set_pointer_capture(pointer).ok().map(|()| pointer)
}

/// Where an arrow key moves a point.
fn moved_by_key([at, value]: [f64; 2], key: &str) -> Option<[f64; 2]> {
    match key {
        "ArrowLeft" => Some([at - KEY_STEP, value]),
        "ArrowRight" => Some([at + KEY_STEP, value]),
        "ArrowUp" => Some([at, value + KEY_STEP]),
        "ArrowDown" => Some([at, value - KEY_STEP]),
        _ => None,
    }
}

/// Where a pointer is in the picture.
fn place_in(picture: NodeRef<Svg>, event: &PointerEvent) -> Option<[f64; 2]> {
    let frame = picture.get_untracked()?.get_bounding_client_rect();
    let share =
        |client: i32, from: f64, size: f64| (f64::from(client) - from) / size.max(1.0) * 2.0 * REACH - REACH;
    Some([
        share(event.client_x(), frame.x(), frame.width()),
        -share(event.client_y(), frame.y(), frame.height()),
    ])
}
