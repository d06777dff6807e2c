//! Names of rooms over the canvas: text that the browser draws, moved along with the camera. Who cannot see the map finds the
//! rooms as a list on the page, so these are hidden from screen readers.

use leptos::prelude::document;
use panel_logic::{ITEMS_MAX, room_name};
use rvac_api::RoomView;
use wasm_bindgen::JsCast;
use web_sys::HtmlElement;

use super::scene::{Ground, Scene};

use crate::language::words;

/// Rooms smaller than this on the screen have no room for their name, CSS pixels squared.
const SMALL_PX2: f64 = 900.0;

/// The names.
#[derive(Debug, Default)]
pub(crate) struct Labels {
    place: Option<HtmlElement>,
    rooms: Vec<RoomView>,
    names: Vec<HtmlElement>,
}

impl Labels {
    /// From now on the names are in this element.
    pub(crate) fn put_into(&mut self, place: HtmlElement) {
        self.place = Some(place);
        self.names.clear();
        let rooms = std::mem::take(&mut self.rooms);
        self.name(&rooms);
    }

    /// Takes the rooms that there are.
    pub(crate) fn name(&mut self, rooms: &[RoomView]) {
        self.rooms = rooms.iter().take(ITEMS_MAX).cloned().collect();
        let Some(place) = &self.place else { return };
        while self.names.len() > self.rooms.len() {
            if let Some(name) = self.names.pop() {
                name.remove();
            }
        }
        while self.names.len() < self.rooms.len() {
            let element = document().create_element("span").ok();
            let Some(name) = element.and_then(|element| element.dyn_into::<HtmlElement>().ok()) else {
                return;
            };
            place.append_child(&name).ok(); // A new element can always be added.
            self.names.push(name);
        }
        for (name, room) in self.names.iter().zip(&self.rooms) {
            name.set_text_content(Some(&room_name(words(), room)));
        }
    }

    /// Moves the names to where the camera sees their rooms.
    pub(crate) fn place(&self, scene: &Scene) {
        let scale = scene.camera.scale();
        for (name, room) in self.names.iter().zip(&self.rooms) {
            let (x, y) = scene.camera.screen_from_map(room.x, room.y);
            let shown = scene.ground() == Ground::Known && room.area_m2 * scale * scale > SMALL_PX2;
            let style = name.style();
            // Neither property can be refused.
            style
                .set_property("display", if shown { "block" } else { "none" })
                .ok();
            style
                .set_property(
                    "transform",
                    &format!("translate({x:.1}px, {y:.1}px) translate(-50%, -50%)"),
                )
                .ok();
        }
    }
}
