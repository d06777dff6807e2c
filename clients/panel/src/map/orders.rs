//! What a person orders: rooms, zones and spots to be cleaned, floor that is forbidden.

use leptos::prelude::*;
use panel_logic::{
    Drawn, Edit, Forbidden, MapPoint, NoGoRow, PlaceRow, Reshape, RoomChangeRow, RoomChoice, Sketch, Tool,
    dock_text, job_estimate_text, joinable, known_dock, no_go_rows, place_rows, refusal_text,
    room_change_rows, whole_home_text,
};
use rvac_api::{Failure, HomeView, JobEstimate, JobOrder, RequestBody};

use super::MapHandle;
use super::scene::Ground;
use crate::access::EDITS_HOME;
use crate::bottom_sheet;
use crate::changes::set_if_changed;
use crate::language::words;
use crate::store::Store;

/// Numbers of requests for estimates begin here, so that they are known from all others.
const FIRST_ESTIMATE: u32 = 1_000;

/// Handles on all of it; cheap to copy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orders {
    /// Rooms, zones and spots that are chosen.
    pub(crate) choice: RwSignal<RoomChoice>,
    /// The estimated time and energy for them, or why there is none; nothing while the robot computes.
    pub(crate) prospect: RwSignal<Option<String>>,
    /// What is being drawn.
    pub(crate) sketch: RwSignal<Sketch>,
    /// What is being reshaped.
    pub(crate) reshape: RwSignal<Option<Reshape>>,
    /// Where the pointer is while something is drawn, in the map.
    pub(crate) pointer: RwSignal<Option<MapPoint>>,
    /// What is forbidden.
    pub(crate) no_go: RwSignal<Vec<NoGoRow>>,
    /// Zones and spots that are kept.
    pub(crate) places: RwSignal<Vec<PlaceRow>>,
    /// What is known of the dock's place.
    pub(crate) dock: RwSignal<Option<&'static str>>,
    /// How the rooms were split and joined.
    pub(crate) room_changes: RwSignal<Vec<RoomChangeRow>>,
    /// What the whole home takes; nothing where the robot does not know it, or works.
    pub(crate) whole_home: RwSignal<Option<String>>,
    asked: StoredValue<u32>,
    asked_for_whole_home: StoredValue<u32>,
}

impl Orders {
    pub(crate) fn new() -> Self {
        Self {
            choice: RwSignal::new(RoomChoice::default()),
            prospect: RwSignal::new(None),
            sketch: RwSignal::new(Sketch::default()),
            reshape: RwSignal::new(None),
            pointer: RwSignal::new(None),
            no_go: RwSignal::new(Vec::new()),
            places: RwSignal::new(Vec::new()),
            dock: RwSignal::new(None),
            room_changes: RwSignal::new(Vec::new()),
            whole_home: RwSignal::new(None),
            asked: StoredValue::new(FIRST_ESTIMATE),
            asked_for_whole_home: StoredValue::new(FIRST_ESTIMATE),
        }
    }

    pub(crate) fn on_home(self, home: &HomeView) {
        let rows = no_go_rows(words(), home);
        set_if_changed(self.no_go, rows);
        let places = place_rows(words(), home);
        set_if_changed(self.places, places);
        let dock = dock_text(words(), home);
        set_if_changed(self.dock, dock);
        let changes = room_change_rows(words(), home);
        set_if_changed(self.room_changes, changes);
        let mut choice = self.choice.get_untracked();
        if choice.retain_known(home) {
            self.choice.set(choice);
        }
    }

    /// The newest estimate counts; one for another choice came too late.
    pub(crate) fn on_estimate(self, estimate: &JobEstimate) {
        if estimate.id == Some(self.asked.get_value()) {
            self.prospect.set(Some(job_estimate_text(words(), estimate)));
        } else if estimate.id == Some(self.asked_for_whole_home.get_value()) {
            self.whole_home.set(Some(whole_home_text(words(), estimate)));
        }
    }

    /// Whether the refusal concerns an estimate, which is displayed beside the choice.
    pub(crate) fn on_failed(self, failure: &Failure) -> bool {
        let is_newest = failure.id == Some(self.asked.get_value());
        if is_newest {
            self.prospect
                .set(Some(refusal_text(words(), &failure.reason, &failure.text)));
        } else if failure.id == Some(self.asked_for_whole_home.get_value()) {
            self.whole_home.set(None);
        }
        is_newest || failure.id.is_some_and(|id| id >= FIRST_ESTIMATE)
    }

    /// Number of the next request for an estimate.
    fn next_number(self) -> u32 {
        let last = self.asked.get_value().max(self.asked_for_whole_home.get_value());
        last.wrapping_add(1).max(FIRST_ESTIMATE)
    }
}

impl Store {
    /// Chooses a room or takes it out.
    pub(crate) fn toggle_room(self, room: u16) {
        self.choose(|choice| choice.toggle(room));
        self.show_known_home();
    }

    /// Chooses a kept place or takes it out.
    pub(crate) fn toggle_place(self, number: u16) {
        self.choose(|choice| choice.toggle_place(number));
        self.show_known_home();
    }

    /// Begins to draw, or lays the tool down.
    pub(crate) fn take_tool(self, tool: Tool) {
        if tool.changes_home() && !self.admits(EDITS_HOME) {
            return;
        }
        self.lay_tool_down();
        if tool != Tool::Choose {
            self.orders.reshape.set(None);
            self.orders.sketch.update(|sketch| sketch.take(tool));
            // What was refused before lies over the hint on a phone.
            self.refusal.set(None);
            self.show_known_home();
            bottom_sheet::lower();
            self.map.with_value(MapHandle::focus);
        }
    }

    /// Nothing is drawn any more.
    pub(super) fn lay_tool_down(self) {
        self.orders.sketch.update(|sketch| sketch.take(Tool::Choose));
        self.orders.pointer.set(None);
    }

    /// A person pointed at a place of the map.
    pub(crate) fn point_at(self, place: MapPoint) {
        // A finger that misses a dot of what is reshaped chooses nothing.
        if self.orders.reshape.with_untracked(Option::is_some) {
            return;
        }
        if self.orders.sketch.with_untracked(|sketch| sketch.tool()) == Tool::Choose {
            if self.take_spot_out_at(place) {
                return;
            }
            let room = self.map.with_value(|map| map.with(|scene| scene.room_at(place)));
            if let Some(room) = room {
                self.toggle_room(room);
            }
            return;
        }
        let drawn = self
            .orders
            .sketch
            .try_update(|sketch| sketch.point(place))
            .flatten();
        match drawn {
            None => return,
            Some(Drawn::Forbidden(shape)) => self.edit(Edit::Forbid(Forbidden { shape, name: None })),
            Some(Drawn::Cut(line)) => self.edit(Edit::Split(line)),
            Some(Drawn::Dock(after)) => {
                if let Some(before) = known_dock(&self.known_home()) {
                    self.edit(Edit::Dock { before, after });
                }
            }
            Some(Drawn::Clean(corners)) => self.choose(|choice| choice.add_zone(corners)),
            Some(Drawn::Spot(middle)) => self.choose(|choice| choice.add_spot(middle)),
            Some(Drawn::Place([x, y])) => self.ask(RequestBody::GoTo { x, y }),
            Some(Drawn::Avoid(shape)) => self.choose(|choice| choice.keep_out_of(shape)),
        }
        self.orders.pointer.set(None);
    }

    /// Takes a chosen spot out that was pointed at; `false` when there is none.
    fn take_spot_out_at(self, place: MapPoint) -> bool {
        let mut is_one = false;
        self.choose(|choice| is_one = choice.take_spot_out_at(place));
        is_one
    }

    /// The chosen rooms, if they are two that can be merged. Read again when the choice or a room changes.
    pub(crate) fn joinable_rooms(self) -> Option<[u16; 2]> {
        self.rooms.track();
        let chosen = self.orders.choice.with(RoomChoice::rooms);
        if chosen.len() != 2 {
            return None;
        }
        joinable(&self.known_home(), &chosen)
    }

    /// Makes the two chosen rooms one.
    pub(crate) fn join_chosen(self) {
        if let Some(rooms) = self.joinable_rooms() {
            self.edit(Edit::Join(rooms));
        }
    }

    /// What was chosen has become a job.
    pub(crate) fn on_choice_sent(self) {
        self.orders.choice.update(RoomChoice::clear);
        self.edits.on_sent();
    }

    /// Asks what cleaning the chosen rooms takes.
    pub(crate) fn ask_prospect(self) {
        self.orders.prospect.set(None);
        if let Some(order) = self.orders.choice.with_untracked(panel_logic::RoomChoice::order) {
            let number = self.orders.next_number();
            self.orders.asked.set_value(number);
            self.ask_as(number, RequestBody::Estimate(order));
        }
    }

    /// Asks what cleaning the whole home takes.
    pub(crate) fn ask_whole_home(self) {
        let number = self.orders.next_number();
        self.orders.asked_for_whole_home.set_value(number);
        self.ask_as(number, RequestBody::Estimate(JobOrder::default()));
    }

    /// Rooms and what is forbidden are visible on the robot's map, not on the floor plan of a simulator.
    pub(super) fn show_known_home(self) {
        self.map.with_value(|map| {
            if map.with(|scene| scene.ground()) != Ground::Known {
                map.change(|scene| scene.show(Ground::Known));
            }
        });
    }
}
