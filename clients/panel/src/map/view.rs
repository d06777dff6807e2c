//! The map on the page: canvas, its buttons, legend and scale.

use std::time::Duration;

use leptos::ev::{KeyboardEvent, PointerEvent, WheelEvent};
use leptos::html;
use leptos::prelude::*;
use panel_logic::{Tool, View, scale_bar};
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use web_sys::ResizeObserver;

use super::MapHandle;
use super::gestures::{Gestures, Movement};
use super::order_bar::OrderBar;
use super::scene::{CameraMode, Ground, Scene};
use super::sketch_view::SketchView;
use crate::icons::{Icon, icon};
use crate::store::Store;

/// Zoom of one press of a button or key.
const STEP: f64 = 1.4;

/// Pixels of one press of an arrow key.
const PAN_PX: f64 = 60.0;

#[component]
pub(crate) fn MapView(store: Store) -> impl IntoView {
    let map = store.map.get_value();
    let failure = RwSignal::new(None::<String>);
    let mode = RwSignal::new(CameraMode::Fitted);
    let footer = RwSignal::new(Footer::default());
    let ground = RwSignal::new(Ground::Known);
    refresh(store, (mode, ground), footer);
    Effect::new(move |_| {
        store.orders.choice.with(|choice| {
            store
                .map
                .with_value(|map| map.change(|scene| scene.choose(choice.rooms())));
        });
    });
    let follow = {
        let map = StoredValue::new_local(map.clone());
        move |_| {
            let next = if mode.get_untracked() == CameraMode::Following {
                CameraMode::Free
            } else {
                CameraMode::Following
            };
            mode.set(next);
            map.with_value(|map| map.change(|scene| scene.mode = next));
        }
    };
    let button = move |label: &'static str, shape: Icon, change: fn(&mut Scene)| {
        view! {
            <button type="button" class="round" aria-label=label title=label on:click=move |_| apply(store, mode, change)>
                {icon(shape)}
            </button>
        }
    };
    view! {
        <section class="map" aria-label="Map">
            <MapCanvas store mode failure />
            <RoomNames store />
            <SketchView store />
            <GroundSwitch store shown=ground />
            <Show when=move || failure.get().is_some()>
                <p class="map-failure" role="alert">
                    {move || failure.get()} " The map cannot be drawn; everything else works."
                </p>
            </Show>
            <div class="map-tools" role="group" aria-label="View of the map">
                {button("Zoom in", Icon::Plus, |scene| zoom(scene, STEP))}
                {button("Zoom out", Icon::Minus, |scene| zoom(scene, 1.0 / STEP))}
                {button("Show everything", Icon::Fit, fit)}
                <button
                    type="button"
                    class="round"
                    id="follow"
                    aria-label="Follow the robot"
                    title="Follow the robot"
                    aria-pressed=move || if mode.get() == CameraMode::Following { "true" } else { "false" }
                    on:click=follow
                >
                    {icon(Icon::Follow)}
                </button>
            </div>
            <OrderBar store />
            <MapFooter store footer />
        </section>
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
            <div class="ground-switch" role="group" aria-label="What the map shows">
                {choice(Ground::True, "ground-true", "True home")}
                {choice(Ground::Known, "ground-known", "What it knows")}
            </div>
        </Show>
    }
}

/// What the footer of the map shows.
#[derive(Clone, Debug, Default, PartialEq)]
struct Footer {
    scale_name: String,
    scale_px: f64,
    frames: String,
    /// A planned way, or doors, are to be seen.
    plans: bool,
    has_doors: bool,
}

#[component]
fn MapFooter(store: Store, footer: RwSignal<Footer>) -> impl IntoView {
    let simulated = move || store.home.with(Option::is_some);
    view! {
        <div class="map-footer">
            <ul class="legend" aria-label="Legend">
                <li><span class="key swept" aria-hidden="true"></span>"Swept"</li>
                <li><span class="key path" aria-hidden="true"></span>"Path"</li>
                <li><span class="key bump" aria-hidden="true"></span>"Bump"</li>
                <Show when=move || footer.get().plans>
                    <li><span class="key way" aria-hidden="true"></span>"Planned"</li>
                </Show>
                <Show when=move || footer.get().has_doors>
                    <li><span class="key door" aria-hidden="true"></span>"Door"</li>
                </Show>
                <Show when=simulated>
                    <li><span class="key truth" aria-hidden="true"></span>"True place"</li>
                </Show>
            </ul>
            <span class="spring"></span>
            <span class="frames" id="frames">{move || footer.get().frames}</span>
            <span class="scale">
                <span class="scale-bar" aria-hidden="true" style:width=move || format!("{:.0}px", footer.get().scale_px)></span>
                {move || footer.get().scale_name}
            </span>
        </div>
    }
}

/// Keeps the figures beside the map up to date, four times a second.
fn refresh(store: Store, (mode, ground): (RwSignal<CameraMode>, RwSignal<Ground>), footer: RwSignal<Footer>) {
    let update = move || {
        store.map.with_value(|map| {
            map.publish_figures();
            let (name, width) = scale_bar(map.with(|scene| scene.camera.scale()));
            let frames = map
                .smoothness()
                .map(|(rate, _)| format!("{rate:.0} frames/s"))
                .unwrap_or_default();
            let next = Footer {
                scale_name: name,
                scale_px: width,
                frames,
                plans: map.with(|scene| !scene.way.is_empty()),
                has_doors: map.with(|scene| scene.doors().next().is_some()),
            };
            if footer.with_untracked(|now| *now != next) {
                footer.set(next);
            }
            let shown = map.with(|scene| scene.ground());
            if ground.get_untracked() != shown {
                ground.set(shown);
            }
            let current = map.with(|scene| scene.mode);
            if mode.get_untracked() != current {
                mode.set(current);
            }
        });
    };
    if let Ok(timer) = set_interval_with_handle(update, Duration::from_millis(250)) {
        on_cleanup(move || timer.clear());
    }
}

/// Zooms about the middle; the camera stays where a person put it unless it follows the robot.
fn zoom(scene: &mut Scene, factor: f64) {
    scene.camera.zoom(factor);
    if scene.mode == CameraMode::Fitted {
        scene.mode = CameraMode::Free;
    }
}

fn fit(scene: &mut Scene) {
    scene.mode = CameraMode::Fitted;
    scene.refit();
}

fn pan(scene: &mut Scene, dx: f64, dy: f64) {
    scene.camera.drag(dx, dy);
    scene.mode = CameraMode::Free;
}

fn apply(store: Store, mode: RwSignal<CameraMode>, change: impl FnOnce(&mut Scene)) {
    store.map.with_value(|map| {
        map.change(change);
        mode.set(map.with(|scene| scene.mode));
    });
}

#[component]
fn MapCanvas(store: Store, mode: RwSignal<CameraMode>, failure: RwSignal<Option<String>>) -> impl IntoView {
    let canvas = NodeRef::<html::Canvas>::new();
    let gestures = StoredValue::new(Gestures::default());
    Effect::new(move |_| {
        if let Some(canvas) = canvas.get() {
            begin(&store.map.get_value(), canvas, failure);
        }
    });
    let on_wheel = move |event: WheelEvent| {
        event.prevent_default();
        // Line-wise wheels report lines of about 16 pixels.
        let pixels = if event.delta_mode() == WheelEvent::DOM_DELTA_PIXEL {
            event.delta_y()
        } else {
            event.delta_y() * 16.0
        };
        let at = (f64::from(event.offset_x()), f64::from(event.offset_y()));
        apply(store, mode, |scene| {
            scene
                .camera
                .zoom_at(at, (-pixels * 0.0018).clamp(-0.7, 0.7).exp());
            if scene.mode == CameraMode::Fitted {
                scene.mode = CameraMode::Free;
            }
        });
    };
    let press = StoredValue::new(None::<Press>);
    let on_down = move |event: PointerEvent| {
        gestures.update_value(|gestures| gestures.down(event.pointer_id(), place(&event)));
        press.set_value(begin_press(store, gestures, &event));
        if let Some(canvas) = canvas.get_untracked() {
            canvas.set_pointer_capture(event.pointer_id()).ok(); // A pointer that is gone already ends the gesture by itself.
        }
    };
    let on_move = move |event: PointerEvent| {
        let movement =
            gestures.try_update_value(|gestures| gestures.moved(event.pointer_id(), place(&event)));
        let movement = movement.unwrap_or(Movement::Nothing);
        if draws(store) && !matches!(movement, Movement::Pinch { .. }) {
            store.orders.pointer.set(Some(map_place(store, place(&event))));
        } else {
            move_camera(store, mode, movement);
        }
    };
    let on_up = move |event: PointerEvent| {
        gestures.update_value(|gestures| gestures.up(event.pointer_id()));
        if let Some(press) = press.try_update_value(Option::take).flatten() {
            end_press(store, press, place(&event));
        }
    };
    let on_cancel = move |event: PointerEvent| {
        gestures.update_value(|gestures| gestures.up(event.pointer_id()));
        press.set_value(None);
    };
    view! {
        <canvas
            node_ref=canvas
            id="map"
            tabindex="0"
            role="img"
            aria-label="Map with the robot, its path and the swept area; the rooms stand as a list under Home. Arrow keys move it, plus and minus zoom, 0 shows everything, F follows the robot, Enter points at the middle."
            on:wheel=on_wheel
            on:pointerdown=on_down
            on:pointermove=on_move
            on:pointerup=on_up
            on:pointercancel=on_cancel
            on:keydown=move |event| on_key(store, mode, &event)
        ></canvas>
    }
}

fn place(event: &PointerEvent) -> (f64, f64) {
    (f64::from(event.offset_x()), f64::from(event.offset_y()))
}

/// A finger that is down and may become a tap, or the second corner of a drawing.
#[derive(Clone, Copy, Debug)]
struct Press {
    at: (f64, f64),
    /// This press has set the first corner.
    has_begun: bool,
}

/// A tap moves less than this, CSS pixels.
const TAP_PX: f64 = 8.0;

fn draws(store: Store) -> bool {
    store
        .orders
        .sketch
        .with_untracked(|sketch| sketch.tool() != Tool::Choose)
}

fn map_place(store: Store, (x, y): (f64, f64)) -> (f64, f64) {
    store
        .map
        .with_value(|map| map.with(|scene| scene.camera.map_from_screen(x, y)))
}

/// A second finger zooms: what the first one began is dropped.
fn begin_press(store: Store, gestures: StoredValue<Gestures>, event: &PointerEvent) -> Option<Press> {
    if !gestures.with_value(Gestures::is_single) {
        store.orders.sketch.update(|sketch| sketch.take(sketch.tool()));
        return None;
    }
    let at = place(event);
    let has_begun = draws(store)
        && store
            .orders
            .sketch
            .with_untracked(|sketch| sketch.first().is_none());
    if has_begun {
        store.point_at(map_place(store, at));
    }
    Some(Press { at, has_begun })
}

/// Two taps draw, and so does one drag.
fn end_press(store: Store, press: Press, (x, y): (f64, f64)) {
    let is_tap = (x - press.at.0).hypot(y - press.at.1) < TAP_PX;
    let points = if draws(store) {
        !(press.has_begun && is_tap)
    } else {
        is_tap
    };
    if points {
        store.point_at(map_place(store, (x, y)));
    }
}

fn move_camera(store: Store, mode: RwSignal<CameraMode>, movement: Movement) {
    match movement {
        Movement::Nothing => {}
        Movement::Drag { dx, dy } => apply(store, mode, |scene| pan(scene, dx, dy)),
        Movement::Pinch { at, factor, dx, dy } => apply(store, mode, |scene| {
            scene.camera.zoom_at(at, factor);
            pan(scene, dx, dy);
        }),
    }
}

fn on_key(store: Store, mode: RwSignal<CameraMode>, event: &KeyboardEvent) {
    if event.ctrl_key() || event.alt_key() || event.meta_key() {
        return;
    }
    match event.key().as_str() {
        "Enter" | " " => {
            event.prevent_default();
            store.point_at(middle(store));
            return;
        }
        "Escape" => {
            store.take_tool(Tool::Choose);
            return;
        }
        _ => {}
    }
    let change: fn(&mut Scene) = match event.key().as_str() {
        "ArrowLeft" => |scene| pan(scene, PAN_PX, 0.0),
        "ArrowRight" => |scene| pan(scene, -PAN_PX, 0.0),
        "ArrowUp" => |scene| pan(scene, 0.0, PAN_PX),
        "ArrowDown" => |scene| pan(scene, 0.0, -PAN_PX),
        "+" | "=" => |scene| zoom(scene, STEP),
        "-" => |scene| zoom(scene, 1.0 / STEP),
        "0" => fit,
        "f" | "F" => |scene| scene.mode = CameraMode::Following,
        _ => return,
    };
    event.prevent_default();
    apply(store, mode, change);
    if draws(store) {
        store.orders.pointer.set(Some(middle(store)));
    }
}

/// The place in the middle of the map.
fn middle(store: Store) -> (f64, f64) {
    store
        .map
        .with_value(|map| map.with(|scene| scene.camera.middle()))
}

/// Attaches the map to its canvas, follows its size, and survives the loss of graphics memory.
fn begin(map: &MapHandle, canvas: web_sys::HtmlCanvasElement, failure: RwSignal<Option<String>>) {
    let sized = map.clone();
    let observed = canvas.clone();
    let on_resize = Closure::<dyn FnMut()>::new(move || {
        let view = View {
            width: f64::from(observed.client_width()),
            height: f64::from(observed.client_height()),
        };
        sized.change(|scene| scene.resize(view));
    });
    if let Ok(observer) = ResizeObserver::new(on_resize.as_ref().unchecked_ref()) {
        observer.observe(&canvas);
    }
    on_resize.forget(); // The map lives as long as the page.
    let (lost, restored) = (map.clone(), map.clone());
    let listen = |name: &'static str, act: Box<dyn FnMut(web_sys::Event)>| {
        let closure = Closure::<dyn FnMut(web_sys::Event)>::wrap(act);
        canvas
            .add_event_listener_with_callback(name, closure.as_ref().unchecked_ref())
            .ok(); // A listener cannot be refused.
        closure.forget(); // The map lives as long as the page.
    };
    listen(
        "webglcontextlost",
        Box::new(move |event| {
            event.prevent_default();
            lost.on_context_lost();
        }),
    );
    listen(
        "webglcontextrestored",
        Box::new(move |_| failure.set(restored.restart().err().map(|error| error.0))),
    );
    failure.set(map.attach(canvas.clone()).err().map(|error| error.0));
}
