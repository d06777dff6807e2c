//! Finds places for furniture: at a wall or freely, away from doors and from each other.

use super::draw::Draw;
use super::shape::{Rect, RoomSide, WallFrame};
use super::sizes::Size;
use super::things::{Piece, Rug, Things};
use crate::point::Point;

/// Places that are tried before a piece is left out.
const TRIES: usize = 40;
/// Usual least distance of two pieces: a person passes, and so does a robot.
const PASSAGE_M: f64 = 0.46;
/// Least distance of pieces that may be close to each other.
const CLOSE_M: f64 = 0.06;
const CLOSE_SHARE: f64 = 0.2;

/// Where a piece may stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Where {
    /// Its back at any wall.
    Wall,
    /// Its back at this wall.
    At(RoomSide),
    /// In a corner.
    Corner,
}

/// One room that is being furnished.
pub(super) struct Furnisher<'a> {
    pub(super) room: Rect,
    /// Fixed things are drawn with this.
    pub(super) draw: &'a mut Draw,
    /// What people move from day to day is drawn with this.
    pub(super) moved: &'a mut Draw,
    pub(super) things: &'a mut Things,
    /// Where things stand already.
    pub(super) solid: Vec<Rect>,
    /// What must stay clear.
    pub(super) clear: Vec<Rect>,
}

impl Furnisher<'_> {
    /// A place for a piece of this size with so much free floor in front. The frame's origin is the piece's corner at
    /// the wall; the piece and the floor in front are taken from now on.
    pub(super) fn at_wall(
        &mut self,
        (width, depth): Size,
        front_m: f64,
        place: Where,
    ) -> Option<(WallFrame, RoomSide)> {
        for _ in 0..TRIES {
            let side = match place {
                Where::At(side) => side,
                Where::Wall | Where::Corner => RoomSide::ALL[self.draw.below(4)],
            };
            let free_m = WallFrame::length_of(&self.room, side) - width;
            if free_m < 0.0 {
                continue;
            }
            let along = match place {
                Where::Corner if self.draw.chance(0.5) => 0.0,
                Where::Corner => free_m,
                Where::Wall | Where::At(_) => self.snapped(free_m),
            };
            let frame = WallFrame::of_side(&self.room, side).moved(along, 0.0);
            let body = frame.rect([0.0, 0.0], [width, depth]);
            let front = frame.rect([0.0, depth], [width, depth + front_m]);
            let passage_m = self.passage_m();
            if self.is_free(&body, passage_m) && self.is_open(&front) {
                self.solid.push(body);
                self.clear.push(front);
                return Some((frame, side));
            }
        }
        None
    }

    /// Nobody puts a cupboard a hand's breadth from the corner.
    fn snapped(&mut self, free_m: f64) -> f64 {
        let along = self.draw.length(0.0, free_m);
        if along < 0.45 {
            0.0
        } else if along > free_m - 0.45 {
            free_m
        } else {
            along
        }
    }

    fn passage_m(&mut self) -> f64 {
        if self.draw.chance(CLOSE_SHARE) {
            CLOSE_M
        } else {
            PASSAGE_M
        }
    }

    /// A free place for a group of this size, away from the walls by at least a passage.
    pub(super) fn freely(&mut self, size: Size) -> Option<WallFrame> {
        let (width, depth) = if self.draw.chance(0.5) {
            size
        } else {
            (size.1, size.0)
        };
        let turned = (width, depth) != size;
        for _ in 0..TRIES {
            let low = self.room.grown(-PASSAGE_M);
            if low.width() < width || low.depth() < depth {
                return None;
            }
            let x = self.draw.length(low.low[0], low.high[0] - width);
            let y = self.draw.length(low.low[1], low.high[1] - depth);
            let body = Rect::new([x, y], [x + width, y + depth]);
            if self.is_free(&body, PASSAGE_M) {
                self.solid.push(body);
                return Some(if turned {
                    WallFrame {
                        origin: [body.high[0], body.low[1]],
                        along: [0.0, 1.0],
                        into: [-1.0, 0.0],
                    }
                } else {
                    WallFrame {
                        origin: body.low,
                        along: [1.0, 0.0],
                        into: [0.0, 1.0],
                    }
                });
            }
        }
        None
    }

    /// A place where people have put something down today.
    pub(super) fn put_down(&mut self, size_m: f64) -> Option<Point> {
        for _ in 0..TRIES {
            let inner = self.room.grown(-0.5 * size_m);
            let x = self.moved.length(inner.low[0], inner.high[0]);
            let y = self.moved.length(inner.low[1], inner.high[1]);
            let body = Rect::new([x, y], [x, y]).grown(0.5 * size_m);
            if self.is_free(&body, PASSAGE_M) {
                self.solid.push(body);
                return Some([x, y]);
            }
        }
        None
    }

    fn is_free(&self, body: &Rect, passage_m: f64) -> bool {
        self.room.contains(body)
            && !self.clear.iter().any(|clear| clear.overlaps(body))
            && !self
                .solid
                .iter()
                .any(|solid| solid.grown(passage_m).overlaps(body))
    }

    /// Whether the floor in front of a piece is free of solid things.
    fn is_open(&self, front: &Rect) -> bool {
        self.room.contains(front) && !self.solid.iter().any(|solid| solid.overlaps(front))
    }

    /// A piece that stands on the floor with its whole outline.
    pub(super) fn solid(&mut self, name: &'static str, rect: &Rect) {
        self.things.pieces.push(Piece {
            name,
            polygon: rect.corners(),
            legs: Vec::new(),
            leg_diameter_m: LEG_M,
        });
    }

    /// A piece on four legs.
    pub(super) fn on_legs(&mut self, name: &'static str, rect: &Rect, leg_m: f64) {
        let inner = rect.grown(-0.5 * leg_m - 0.02);
        self.legs(name, inner.corners(), leg_m);
    }

    /// A piece of which only these places touch the floor.
    pub(super) fn legs(&mut self, name: &'static str, legs: Vec<Point>, leg_m: f64) {
        self.things.pieces.push(Piece {
            name,
            polygon: Vec::new(),
            legs,
            leg_diameter_m: leg_m,
        });
    }

    /// A rug; what it is made of is drawn.
    pub(super) fn rug(&mut self, rect: &Rect) {
        let (drag_n, slip) = (self.draw.number(0.4, 1.8), self.draw.number(0.01, 0.04));
        let bias_deg_per_m = self.draw.number(-1.0, 1.0);
        self.things.rugs.push(Rug {
            polygon: rect.corners(),
            drag_n,
            slip,
            bias_deg_per_m,
            black: false,
        });
    }

    /// A chair in this frame, drawn back from its place toward `back` (0..1 of 35 cm) and turned a little.
    pub(super) fn chair(&mut self, frame: &WallFrame, at: Point, back: Point) {
        let drawn_m = 0.35 * self.moved.number(0.0, 1.0);
        let turn_rad = self.moved.number(-0.3, 0.3);
        let centre = frame.point(at[0] + back[0] * drawn_m, at[1] + back[1] * drawn_m);
        let (sin, cos) = libm::sincos(turn_rad);
        let half = CHAIR_HALF_M;
        let legs = [[-half, -half], [half, -half], [half, half], [-half, half]]
            .iter()
            .map(|[x, y]| [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y])
            .collect();
        self.legs("Chair", legs, CHAIR_LEG_M);
    }
}

/// Usual leg.
pub(super) const LEG_M: f64 = 0.05;
const CHAIR_LEG_M: f64 = 0.035;
/// Half of the distance between two legs of a chair.
const CHAIR_HALF_M: f64 = 0.19;
