//! The dots by which what was drawn is reshaped, over the map: dragged by pointer, moved by keys; and the bar that keeps the new shape.

use leptos::ev::{KeyboardEvent, PointerEvent};
use leptos::html;
use leptos::prelude::*;
use panel_logic::{HANDLE_FINE_STEP_M, HANDLE_STEP_M, Handle, Pixel, Reshape, Reshaped, RoomChoice, Target};

use crate::access::EDITS_HOME;
use crate::bottom_sheet;
use crate::focus::focus_soon_on;
use crate::language::words;
use crate::store::Store;

/// The direction of an arrow key is taken on the screen, so far from the handle, CSS pixels.
const AHEAD_PX: f64 = 20.0;

impl Store {
    /// Takes something in hand to reshape it.
    pub(crate) fn begin_reshape(self, target: Target) {
        if target.changes_home() && !self.admits(EDITS_HOME) {
            return;
        }
        self.lay_tool_down();
        let (home, choice) = (self.known_home(), self.orders.choice.get_untracked());
        self.orders
            .reshape
            .set(Reshape::begin(target, &home, &choice, words()));
        self.refusal.set(None);
        self.show_known_home();
        bottom_sheet::lower();
    }

    /// Keeps the new shape.
    fn save_reshape(self) {
        let Some(reshape) = self.orders.reshape.get_untracked() else {
            return;
        };
        let target = reshape.target();
        let done = self.orders.choice.with_untracked(|choice| reshape.finish(choice));
        self.end_reshape(target);
        match done {
            None => {}
            Some(Reshaped::Home(edit)) => self.edit(edit),
            Some(Reshaped::Choice(other)) => self.choose(|choice| *choice = other),
        }
    }

    /// Leaves it as it was.
    pub(super) fn drop_reshape(self) {
        if let Some(reshape) = self.orders.reshape.get_untracked() {
            self.end_reshape(reshape.target());
        }
    }

    /// The focus goes back to where it came from.
    fn end_reshape(self, target: Target) {
        self.orders.reshape.set(None);
        focus_soon_on(target.button_id());
    }

    /// Where a place of the map is on the screen. Follows the camera.
    fn on_screen(self, place: [f64; 2]) -> Pixel {
        self.map.with_value(|map| {
            map.follow_camera();
            map.with(|scene| scene.camera.screen_from_map(place.into()))
        })
    }

    fn place_under(self, pixel: Pixel) -> [f64; 2] {
        self.map
            .with_value(|map| map.with(|scene| scene.camera.map_from_screen(pixel)))
            .into()
    }

    fn move_handle(self, handle: Handle, to: [f64; 2]) {
        self.orders.reshape.update(|reshape| {
            if let Some(reshape) = reshape {
                reshape.move_to(handle, to);
            }
        });
    }

    /// A step of the handle in the direction that an arrow key has on the screen, to the right and down.
    fn step_handle(self, handle: Handle, ahead: [f64; 2], step_m: f64) {
        let at = self
            .orders
            .reshape
            .with_untracked(|reshape| reshape.as_ref()?.outline().at(handle));
        let Some([x, y]) = at else { return };
        let pixel = untrack(|| self.on_screen([x, y]));
        let [right, down] = ahead.map(|share| AHEAD_PX * share);
        let [ahead_x, ahead_y] = self.place_under(Pixel::new(pixel.x + right, pixel.y + down));
        let length_m = (ahead_x - x).hypot(ahead_y - y);
        if length_m > 0.0 {
            let share = step_m / length_m;
            self.move_handle(handle, [x + share * (ahead_x - x), y + share * (ahead_y - y)]);
        }
    }
}

#[component]
pub(crate) fn ReshapeView(store: Store) -> impl IntoView {
    let reshape = store.orders.reshape;
    // Something else has become of what was in hand.
    Effect::new(move |_| {
        let choice = store.orders.choice.get();
        let is_orphaned =
            |held: &Option<Reshape>| held.as_ref().is_some_and(|held| held.is_orphaned(&choice));
        if reshape.with_untracked(is_orphaned) {
            reshape.set(None);
        }
    });
    let path = move || {
        let border = reshape.with(|held| held.as_ref().map(|held| held.outline().border()));
        let places: Vec<String> = border
            .unwrap_or_default()
            .into_iter()
            .map(|place| {
                let pixel = store.on_screen(place);
                format!("{:.1} {:.1}", pixel.x, pixel.y)
            })
            .collect();
        format!("M{}", places.join("L"))
    };
    let handles = Memo::new(move |_| {
        reshape.with(|held| {
            held.as_ref()
                .map_or_else(Vec::new, |held| held.outline().handles())
        })
    });
    let label = move || {
        let name = reshape.with(|held| held.as_ref().map(|held| held.name().to_owned()));
        words().map.handles.fill([&name.unwrap_or_default()])
    };
    view! {
        <Show when=move || reshape.with(Option::is_some)>
            <svg class="sketch" aria-hidden="true" focusable="false">
                <path d=path />
            </svg>
            <div class="handles" role="group" aria-label=label>
                <For each=move || handles.get() key=|handle| *handle let:handle>
                    <HandleView store handle />
                </For>
            </div>
        </Show>
    }
}

/// A finger on a handle: where it went down, and where the handle was then.
#[derive(Clone, Copy, Debug)]
struct HandleDrag {
    pointer: i32,
    down: Pixel,
    handle: Pixel,
}

fn client(event: &PointerEvent) -> Pixel {
    Pixel::new(f64::from(event.client_x()), f64::from(event.client_y()))
}

#[component]
fn HandleView(store: Store, handle: Handle) -> impl IntoView {
    let button = NodeRef::<html::Button>::new();
    let at = Memo::new(move |_| {
        let held = store
            .orders
            .reshape
            .with(|held| held.as_ref()?.outline().at(handle));
        held.map(|place| store.on_screen(place))
    });
    let grip = StoredValue::new(None::<HandleDrag>);
    let on_down = move |event: PointerEvent| {
        grip.set_value(at.get_untracked().map(|handle| HandleDrag {
            pointer: event.pointer_id(),
            down: client(&event),
            handle,
        }));
        if let Some(button) = button.get_untracked() {
            button.set_pointer_capture(event.pointer_id()).ok(); // A pointer that is gone already ends the drag by itself.
        }
    };
    let on_move = move |event: PointerEvent| {
        if let Some(grip) = grip.get_value().filter(|grip| grip.pointer == event.pointer_id()) {
            let at = client(&event);
            let to = Pixel::new(
                grip.handle.x + at.x - grip.down.x,
                grip.handle.y + at.y - grip.down.y,
            );
            store.move_handle(handle, store.place_under(to));
        }
    };
    let is_first = move || {
        let first = store.orders.reshape.with_untracked(|held| {
            held.as_ref()
                .and_then(|held| held.outline().handles().first().copied())
        });
        first == Some(handle)
    };
    Effect::new(move |_| {
        if let Some(button) = button.get().filter(|_| is_first()) {
            button.focus().ok(); // An element that cannot have it leaves it where it is.
        }
    });
    let (id, label) = match handle {
        Handle::Corner(corner) => (
            format!("handle-{}", corner + 1),
            words().map.handle_corner.fill([&(corner + 1)]),
        ),
        Handle::Middle => ("handle-middle".to_owned(), words().map.handle_middle.to_owned()),
    };
    view! {
        <button
            type="button"
            node_ref=button
            id=id
            class="handle"
            class:middle=handle == Handle::Middle
            aria-label=label.clone()
            title=label
            style:transform=move || at.get().map(|Pixel { x, y }| format!("translate({x:.1}px, {y:.1}px)"))
            on:pointerdown=on_down
            on:pointermove=on_move
            on:pointerup=move |_| grip.set_value(None)
            on:pointercancel=move |_| grip.set_value(None)
            on:keydown=move |event| on_key(store, handle, &event)
        ></button>
    }
}

fn on_key(store: Store, handle: Handle, event: &KeyboardEvent) {
    if event.ctrl_key() || event.alt_key() || event.meta_key() {
        return;
    }
    let ahead = match event.key().as_str() {
        "ArrowLeft" => [-1.0, 0.0],
        "ArrowRight" => [1.0, 0.0],
        "ArrowUp" => [0.0, -1.0],
        "ArrowDown" => [0.0, 1.0],
        "Enter" => {
            event.prevent_default();
            return store.save_reshape();
        }
        "Escape" => return store.drop_reshape(),
        _ => return,
    };
    event.prevent_default();
    let step_m = if event.shift_key() {
        HANDLE_FINE_STEP_M
    } else {
        HANDLE_STEP_M
    };
    store.step_handle(handle, ahead, step_m);
}

/// What is in hand, how large it is, and the buttons that keep it or leave it as it was.
#[component]
pub(super) fn ReshapeBar(store: Store) -> impl IntoView {
    let told = move || {
        let reshape = store.orders.reshape;
        reshape.with(|held| held.as_ref().map(|held| held.text(words())))
    };
    let problem = move || {
        let reshape = store.orders.reshape;
        reshape.with(|held| held.as_ref().and_then(|held| held.problem(words())))
    };
    view! {
        <div class="order-bar" id="reshape-bar">
            <p role="status"><strong id="reshape-told">{told}</strong></p>
            <p role="status" class="wrong" id="reshape-wrong">{problem}</p>
            <p class="hint">{words().map.reshape_hint}</p>
            <div class="order-tools">
                <button type="button" class="small" id="reshape-cancel" on:click=move |_| store.drop_reshape()>
                    {words().frame.cancel}
                </button>
                <button type="button" class="small strong" id="reshape-save" on:click=move |_| store.save_reshape()>
                    {words().frame.save}
                </button>
            </div>
        </div>
    }
}

impl Store {
    /// Changes what is chosen for a job, so that it can be taken back.
    pub(crate) fn choose(self, change: impl FnOnce(&mut RoomChoice)) {
        let before = self.orders.choice.get_untracked();
        let mut after = before.clone();
        change(&mut after);
        if after != before {
            self.edits.on_chosen(before, after.clone());
            self.orders.choice.set(after);
        }
    }
}
