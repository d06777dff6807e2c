//! Hands on the map: pointer, fingers, wheel and keys.

use leptos::ev::{KeyboardEvent, PointerEvent, WheelEvent};
use leptos::html;
use leptos::prelude::*;
use panel_logic::{MapPoint, Orbit, Pixel, Tool, View};
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use web_sys::ResizeObserver;

use super::MapHandle;
use super::gestures::{Gestures, Movement};
use super::scene::{CameraMode, Scene};
use crate::language::words;
use crate::store::Store;

/// Zoom of one press of a button or key.
pub(super) const STEP: f64 = 1.4;

/// Pixels of one press of an arrow key.
const PAN_PX: f64 = 60.0;

/// Pixels of a turn by a radian.
const PIXELS_PER_RAD: f64 = 170.0;

/// Zooms about the middle; the camera stays where a person put it unless it follows the robot.
pub(super) fn zoom(scene: &mut Scene, factor: f64) {
    scene.camera.zoom(factor);
    if scene.mode == CameraMode::Fitted {
        scene.mode = CameraMode::Free;
    }
}

pub(super) fn fit(scene: &mut Scene) {
    if scene.camera.orbit().is_some() {
        scene.camera.look_from(Some(Orbit::default()));
    }
    scene.mode = CameraMode::Fitted;
    scene.refit();
}

fn pan(scene: &mut Scene, dx: f64, dy: f64) {
    scene.camera.drag(dx, dy);
    scene.mode = CameraMode::Free;
}

/// From straight above to an orbit and back.
pub(super) fn toggle_relief(scene: &mut Scene) {
    let orbit = if scene.camera.orbit().is_some() {
        None
    } else {
        Some(Orbit::default())
    };
    scene.look_from(orbit);
}

fn turn(scene: &mut Scene, dx: f64, dy: f64) {
    scene.camera.turn(dx, dy);
    scene.refit();
}

/// What a drag does that does not move the picture: it turns it, where there is an orbit to turn on.
fn turn_or_pan(scene: &mut Scene, dx: f64, dy: f64) {
    if scene.camera.orbit().is_some() {
        turn(scene, dx, dy);
    } else {
        pan(scene, dx, dy);
    }
}

pub(super) fn apply(store: Store, mode: RwSignal<CameraMode>, change: impl FnOnce(&mut Scene)) {
    store.map.with_value(|map| {
        map.change(change);
        mode.set(map.with(|scene| scene.mode));
    });
}

#[component]
pub(super) fn MapCanvas(
    store: Store,
    mode: RwSignal<CameraMode>,
    failure: RwSignal<Option<String>>,
) -> impl IntoView {
    let canvas = NodeRef::<html::Canvas>::new();
    let gestures = StoredValue::new(Gestures::default());
    Effect::new(move |_| {
        if let Some(canvas) = canvas.get() {
            begin(&store.map.get_value(), canvas, failure);
        }
    });
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
            // The second button, or Shift, moves the picture where the first one turns it.
            let pans = event.shift_key() || event.buttons() & 1 == 0;
            let drag = if pans { pan } else { turn_or_pan };
            move_camera(store, mode, movement, drag);
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
            aria-label=words().map.canvas
            on:wheel=move |event| on_wheel(store, mode, &event)
            on:pointerdown=on_down
            on:pointermove=on_move
            on:pointerup=on_up
            on:pointercancel=on_cancel
            on:contextmenu=move |event| event.prevent_default()
            on:keydown=move |event| on_key(store, mode, &event)
        ></canvas>
    }
}

fn on_wheel(store: Store, mode: RwSignal<CameraMode>, event: &WheelEvent) {
    event.prevent_default();
    // Line-wise wheels report lines of about 16 pixels.
    let pixels = if event.delta_mode() == WheelEvent::DOM_DELTA_PIXEL {
        event.delta_y()
    } else {
        event.delta_y() * 16.0
    };
    let at = Pixel::new(f64::from(event.offset_x()), f64::from(event.offset_y()));
    apply(store, mode, |scene| {
        scene
            .camera
            .zoom_at(at, (-pixels * 0.0018).clamp(-0.7, 0.7).exp());
        if scene.mode == CameraMode::Fitted {
            scene.mode = CameraMode::Free;
        }
    });
}

fn place(event: &PointerEvent) -> Pixel {
    Pixel::new(f64::from(event.offset_x()), f64::from(event.offset_y()))
}

/// A finger that is down and may become a tap, or the second corner of a drawing.
#[derive(Clone, Copy, Debug)]
struct Press {
    at: Pixel,
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

fn map_place(store: Store, pixel: Pixel) -> MapPoint {
    store
        .map
        .with_value(|map| map.with(|scene| scene.camera.map_from_screen(pixel)))
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
            .with_untracked(|sketch| sketch.first().is_none() && !sketch.is_place());
    if has_begun {
        store.point_at(map_place(store, at));
    }
    Some(Press { at, has_begun })
}

/// Two taps draw, and so does one drag. A spot lies where the finger leaves the map.
fn end_press(store: Store, press: Press, at: Pixel) {
    let is_tap = (at.x - press.at.x).hypot(at.y - press.at.y) < TAP_PX;
    let points = if draws(store) {
        !(press.has_begun && is_tap)
    } else {
        is_tap
    };
    if points {
        store.point_at(map_place(store, at));
    }
}

/// `drag` says what one finger does to the picture.
fn move_camera(store: Store, mode: RwSignal<CameraMode>, movement: Movement, drag: fn(&mut Scene, f64, f64)) {
    match movement {
        Movement::Nothing => {}
        Movement::Drag { dx, dy } => apply(store, mode, |scene| drag(scene, dx, dy)),
        Movement::Pinch {
            at,
            factor,
            dx,
            dy,
            turn_rad,
        } => apply(store, mode, |scene| {
            scene.camera.zoom_at(at, factor);
            scene.camera.turn(turn_rad * PIXELS_PER_RAD, 0.0);
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
            store.drop_reshape();
            return;
        }
        _ => {}
    }
    let turns = event.shift_key()
        && store
            .map
            .with_value(|map| map.with(|scene| scene.camera.orbit().is_some()));
    let change: fn(&mut Scene) = match event.key().as_str() {
        "ArrowLeft" if turns => |scene| turn(scene, PAN_PX, 0.0),
        "ArrowRight" if turns => |scene| turn(scene, -PAN_PX, 0.0),
        "ArrowUp" if turns => |scene| turn(scene, 0.0, PAN_PX),
        "ArrowDown" if turns => |scene| turn(scene, 0.0, -PAN_PX),
        "3" => toggle_relief,
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
fn middle(store: Store) -> MapPoint {
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
