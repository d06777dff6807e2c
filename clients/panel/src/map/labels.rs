//! Names of rooms, the places of zones and spots in the order, and where the robot waits for help, over the canvas: text that the
//! browser draws, moved along with the camera. Who cannot see the map finds them as lists on the page, so these are hidden from screen
//! readers.

use core::cmp::Ordering;

use leptos::prelude::document;
use panel_logic::{DrawnPart, ITEMS_MAX, MapPoint, NameBox, Pixel, lay_out_names, room_name};
use rvac_api::RoomView;
use wasm_bindgen::JsCast;
use web_sys::HtmlElement;

use super::scene::{Ground, Scene};

use crate::language::words;

/// Rooms smaller than this on the screen have no room for their name, CSS pixels squared.
const SMALL_PX2: f64 = 900.0;

/// What is written over the map.
#[derive(Debug, Default)]
pub(crate) struct Labels {
    place: Option<HtmlElement>,
    rooms: Vec<Label>,
    parts: Vec<Label>,
    stop: Option<Label>,
    elements: Vec<HtmlElement>,
    /// Width and height of each element, CSS pixels.
    sizes_px: Vec<[f64; 2]>,
}

#[derive(Clone, Debug)]
struct Label {
    text: String,
    at: MapPoint,
    /// Area of the room whose name it is.
    room_m2: Option<f64>,
    class: &'static str,
}

impl Label {
    fn is_seen(&self, scene: &Scene) -> bool {
        let scale = scene.camera.scale();
        self.room_m2
            .is_none_or(|area_m2| scene.ground() == Ground::Known && area_m2 * scale * scale > SMALL_PX2)
    }
}

impl Labels {
    /// From now on the labels are in this element.
    pub(crate) fn put_into(&mut self, place: HtmlElement) {
        self.place = Some(place);
        self.elements.clear();
        self.write();
    }

    /// Takes the rooms that there are.
    pub(crate) fn name(&mut self, rooms: &[RoomView]) {
        let label = |room: &RoomView| Label {
            text: room_name(words(), room),
            at: MapPoint::new(room.x, room.y),
            room_m2: Some(room.area_m2),
            class: "",
        };
        self.rooms = rooms.iter().take(ITEMS_MAX).map(label).collect();
        // Where two names have no room beside each other, the larger room has its own.
        self.rooms
            .sort_by(|one, other| other.room_m2.partial_cmp(&one.room_m2).unwrap_or(Ordering::Equal));
        self.write();
    }

    /// Takes the zones and spots that are to be cleaned.
    pub(crate) fn number(&mut self, parts: &[DrawnPart]) {
        let label = |part: &DrawnPart| Label {
            text: part.place.to_string(),
            at: part.middle.into(),
            room_m2: None,
            class: "number",
        };
        self.parts = parts.iter().map(label).collect();
        self.write();
    }

    /// Takes where the robot waits for help.
    pub(crate) fn mark_stop(&mut self, at: Option<MapPoint>) {
        self.stop = at.map(|at| Label {
            text: "!".to_owned(),
            at,
            room_m2: None,
            class: "number stop",
        });
        self.write();
    }

    fn labels(&self) -> impl Iterator<Item = &Label> {
        self.rooms.iter().chain(&self.parts).chain(&self.stop)
    }

    fn write(&mut self) {
        let Some(place) = &self.place else { return };
        let count = self.labels().count();
        while self.elements.len() > count {
            if let Some(element) = self.elements.pop() {
                element.remove();
            }
        }
        while self.elements.len() < count {
            let element = document().create_element("span").ok();
            let Some(element) = element.and_then(|element| element.dyn_into::<HtmlElement>().ok()) else {
                return;
            };
            place.append_child(&element).ok(); // A new element can always be added.
            self.elements.push(element);
        }
        for (element, label) in self.elements.iter().zip(self.labels()) {
            element.set_text_content(Some(&label.text));
            element.set_class_name(label.class);
        }
        let size_px =
            |element: &HtmlElement| [element.offset_width(), element.offset_height()].map(f64::from);
        self.sizes_px = self.elements.iter().map(size_px).collect();
    }

    /// Moves the labels to the screen positions of what they name, and those that would cover another beside them.
    pub(crate) fn place(&self, scene: &Scene) {
        let seen: Vec<(&HtmlElement, NameBox)> = self
            .elements
            .iter()
            .zip(self.labels())
            .zip(&self.sizes_px)
            .filter_map(|((element, label), size_px)| {
                let name = NameBox {
                    middle: scene.camera.screen_from_map(label.at),
                    size_px: *size_px,
                    is_fixed: label.room_m2.is_none(),
                };
                if label.is_seen(scene) {
                    return Some((element, name));
                }
                hide(element);
                None
            })
            .collect();
        let names: Vec<NameBox> = seen.iter().map(|(_, name)| *name).collect();
        for ((element, name), down_px) in seen.iter().zip(lay_out_names(&names)) {
            match down_px {
                Some(down_px) => show_at(element, Pixel::new(name.middle.x, name.middle.y + down_px)),
                None => hide(element),
            }
        }
    }
}

/// It keeps its size, which is measured before it is shown.
fn hide(element: &HtmlElement) {
    element.style().set_property("visibility", "hidden").ok(); // The property cannot be refused.
}

fn show_at(element: &HtmlElement, Pixel { x, y }: Pixel) {
    let style = element.style();
    // Neither property can be refused.
    style.set_property("visibility", "visible").ok();
    style
        .set_property(
            "transform",
            &format!("translate({x:.1}px, {y:.1}px) translate(-50%, -50%)"),
        )
        .ok();
}
