//! What people have said of a home.

use brain::CutLine;
use brain::mapping::{Annotations, RoomChange};
use brain::{NoGo, NoGoShape, Pattern, PlaceShape, RoomPower, Zone};

use crate::ContentHash;

/// More rooms than a home has.
const ROOMS_MAX: u16 = 1_000;

impl ContentHash {
    pub(crate) fn add_annotations(&mut self, said: &Annotations) {
        for (number, no_go) in said.no_go() {
            self.add(number);
            self.add_no_go(no_go);
        }
        for (number, place) in said.places() {
            self.add(number);
            self.add_text(place.name().as_str());
            match place.shape() {
                PlaceShape::Zone(zone) => self.add_zone(zone),
                PlaceShape::Spot(place) => self.add_point(*place),
            }
        }
        for room in 1..ROOMS_MAX {
            if let Some(name) = said.name(room) {
                self.add(room);
                self.add_text(name.as_str());
            }
            if let Some(settings) = said.settings(room) {
                self.add(room);
                self.add(settings.passes());
                self.add_power(settings.power());
                self.add_pattern(settings.pattern());
            }
        }
        for (number, change) in said.room_changes().made() {
            self.add(number);
            self.add_room_change(change);
        }
    }

    pub(crate) fn add_no_go(&mut self, no_go: &NoGo) {
        match no_go.shape() {
            NoGoShape::Zone => self.add(0),
            NoGoShape::Wall { from, to } => {
                self.add(1);
                self.add_point(from);
                self.add_point(to);
            }
        }
        self.add_zone(no_go.area());
        self.add_text(no_go.name().map_or("", |name| name.as_str()));
    }

    pub(crate) fn add_zone(&mut self, zone: &Zone) {
        self.add(zone.corners().len() as u64);
        for corner in zone.corners() {
            self.add_point(*corner);
        }
    }

    pub(crate) fn add_power(&mut self, power: RoomPower) {
        self.add_bytes(&[power.suction, power.main_brush, power.side_brushes]);
    }

    pub(crate) fn add_pattern(&mut self, pattern: Pattern) {
        self.add(match pattern {
            Pattern::Lines => 0,
            Pattern::Contour => 1,
        });
    }

    fn add_room_change(&mut self, change: &RoomChange) {
        match change {
            RoomChange::Split(split) => {
                self.add(split.room);
                self.add(split.part);
                self.add_line(split.line);
            }
            RoomChange::Join(join) => {
                self.add(join.kept);
                self.add(join.lost);
                for place in join.at {
                    self.add_point(place);
                }
            }
        }
    }

    fn add_line(&mut self, line: CutLine) {
        for end in line.ends() {
            self.add_point(end);
        }
    }
}
