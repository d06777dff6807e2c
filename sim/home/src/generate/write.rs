//! Writes a generated home as a home TOML.

use core::fmt::Write;

use super::shape::Rect;
use super::things::{Piece, PlacedLine, Rug, Things};
use crate::point::Point;

/// How the drawn home is laid on the paper, so that not every home has its corridor from left to right.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turn {
    pub(super) swap: bool,
    pub(super) mirror_x: bool,
    pub(super) mirror_y: bool,
}

impl Turn {
    fn direction(self, [x, y]: Point) -> Point {
        let x = if self.mirror_x { -x } else { x };
        let y = if self.mirror_y { -y } else { y };
        if self.swap { [y, x] } else { [x, y] }
    }

    fn point(self, point: Point) -> String {
        let [x, y] = self.direction(point);
        // Without `+ 0.0` a mirrored 0 would be written as -0.
        format!("[{:.3}, {:.3}]", x + 0.0, y + 0.0)
    }

    fn polygon(self, corners: &[Point]) -> String {
        let points: Vec<String> = corners.iter().map(|corner| self.point(*corner)).collect();
        format!("[{}]", points.join(", "))
    }
}

/// The text of a home TOML.
pub(super) fn write(name: &str, things: &Things, turn: Turn) -> String {
    let mut text = format!(
        "# A generated home; `rvac-sim homes` wrote it. Lengths in metres.\nformat = \"librervac-home\"\nversion = 1\nname = \"{name}\"\n"
    );
    for room in &things.rooms {
        named(&mut text, "room", room.kind.name());
        line(&mut text, "polygon", &turn.polygon(&room.rect.corners()));
    }
    for stairs in &things.stairs {
        named(&mut text, "cliff", "Stairs down");
        line(&mut text, "polygon", &turn.polygon(&stairs.corners()));
    }
    for rug in &things.rugs {
        write_rug(&mut text, rug, turn);
    }
    for wall in &things.walls {
        strip(&mut text, "wall", wall.ends, turn);
        line(&mut text, "thickness-m", &format!("{:.2}", wall.thickness_m));
    }
    for door in &things.doors {
        strip(&mut text, "door", door.ends, turn);
        line(&mut text, "thickness-m", "0.16");
        line(
            &mut text,
            "state",
            if door.open { "\"open\"" } else { "\"closed\"" },
        );
    }
    for piece in &things.pieces {
        write_piece(&mut text, piece, turn);
    }
    for door in things.doors.iter().filter(|door| door.threshold_m > 0.0) {
        strip(&mut text, "threshold", door.ends, turn);
        line(&mut text, "width-m", "0.08");
        line(&mut text, "height-m", &format!("{:.3}", door.threshold_m));
    }
    for cable in &things.cables {
        write_cable(&mut text, cable, turn);
    }
    for mirror in &things.mirrors {
        strip(&mut text, "mirror", mirror.ends, turn);
        line(&mut text, "thickness-m", &format!("{:.2}", mirror.thickness_m));
    }
    for visitor in &things.visitors {
        text.push_str("\n[[visitor]]\n");
        line(&mut text, "position", &turn.point(visitor.place));
        line(&mut text, "diameter-m", &format!("{:.2}", visitor.diameter_m));
        line(&mut text, "from-s", &format!("{:.1}", visitor.from_s));
        line(&mut text, "until-s", &format!("{:.1}", visitor.until_s));
    }
    for walker in &things.walkers {
        text.push_str("\n[[walker]]\n");
        line(&mut text, "kind", &format!("\"{}\"", walker.kind));
        line(&mut text, "goals", &turn.polygon(&walker.goals));
        line(&mut text, "rest-s", &format!("{:.1}", walker.rest_s));
        line(&mut text, "from-s", &format!("{:.1}", walker.from_s));
        line(&mut text, "until-s", &format!("{:.1}", walker.until_s));
    }
    if let Some((place, into)) = things.dock {
        let [x, y] = turn.direction(into);
        text.push_str("\n[dock]\n");
        line(&mut text, "position", &turn.point(place));
        line(
            &mut text,
            "heading-deg",
            &format!("{:.1}", libm::atan2(y, x).to_degrees()),
        );
    }
    text
}

fn line(text: &mut String, key: &str, value: &str) {
    // Writing into a string cannot fail.
    writeln!(text, "{key} = {value}").ok();
}

fn named(text: &mut String, table: &str, name: &str) {
    writeln!(text, "\n[[{table}]]\nname = \"{name}\"").ok();
}

fn strip(text: &mut String, table: &str, ends: [Point; 2], turn: Turn) {
    writeln!(text, "\n[[{table}]]").ok();
    line(text, "from", &turn.point(ends[0]));
    line(text, "to", &turn.point(ends[1]));
}

fn write_rug(text: &mut String, rug: &Rug, turn: Turn) {
    text.push_str("\n[[rug]]\n");
    line(text, "polygon", &turn.polygon(&rug.polygon));
    line(text, "drag-n", &format!("{:.2}", rug.drag_n));
    line(text, "slip", &format!("{:.3}", rug.slip));
    line(text, "bias-deg-per-m", &format!("{:.2}", rug.bias_deg_per_m));
    if rug.black {
        line(text, "black", "true");
    }
}

fn write_piece(text: &mut String, piece: &Piece, turn: Turn) {
    named(text, "furniture", piece.name);
    if !piece.polygon.is_empty() {
        line(text, "polygon", &turn.polygon(&piece.polygon));
    }
    if !piece.legs.is_empty() {
        line(text, "legs", &turn.polygon(&piece.legs));
        line(text, "leg-diameter-m", &format!("{:.3}", piece.leg_diameter_m));
    }
}

/// A cable is a low, slippery edge.
fn write_cable(text: &mut String, cable: &PlacedLine, turn: Turn) {
    text.push_str("\n# a cable");
    strip(text, "threshold", cable.ends, turn);
    line(text, "width-m", &format!("{:.3}", cable.thickness_m));
    line(text, "height-m", "0.006");
}

/// The place in the middle of a rectangle.
pub(super) fn middle(rect: &Rect) -> Point {
    [
        0.5 * (rect.low[0] + rect.high[0]),
        0.5 * (rect.low[1] + rect.high[1]),
    ]
}
