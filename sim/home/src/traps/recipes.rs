//! How each kind of trap is drawn. The body is 35 cm wide; cells of the plan have 2 cm, so a gap may come out that much
//! wider or narrower than it was drawn.

use core::f64::consts::{PI, TAU};

use super::TrapKind;
use super::sketch::{Sketch, corners};
use crate::point::Point;

/// Width of the body, metres.
const BODY_M: f64 = 0.35;
/// What the narrowest gaps have beyond the body: less is a matter of a cell.
const TIGHT_M: f64 = 0.05;
/// A wider gap is no trap.
const LOOSE_M: f64 = 0.14;

pub(super) fn draw(kind: TrapKind, sketch: &mut Sketch) {
    match kind {
        TrapKind::Airer => airer(sketch),
        TrapKind::Bed => bed(sketch),
        TrapKind::BlackIsland => black(sketch, ExitKind::None),
        TrapKind::BlackRug => black(sketch, ExitKind::AlongTheWall),
        TrapKind::Cables => cables(sketch),
        TrapKind::Carpet => carpet(sketch),
        TrapKind::Chairs => chairs(sketch),
        TrapKind::Closet => closet(sketch, ExitKind::None),
        TrapKind::Door => closet(sketch, ExitKind::Later),
        TrapKind::DoorLeaf => door_leaf(sketch),
        TrapKind::Landing => landing(sketch),
        TrapKind::Mirror => mirror(sketch),
        TrapKind::People => people(sketch),
        TrapKind::RugEdge => rug_edge(sketch),
        TrapKind::Slot => slot(sketch),
        TrapKind::Sofa => sofa(sketch),
        TrapKind::Stools => stools(sketch),
        TrapKind::Table => table(sketch),
        TrapKind::Threshold => threshold(sketch),
        TrapKind::Toilet => toilet(sketch),
        TrapKind::Hook => hook(sketch),
        TrapKind::Wedge => wedge(sketch),
    }
}

/// Whether there is an exit.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ExitKind {
    None,
    AlongTheWall,
    Later,
}

fn gap(sketch: &mut Sketch) -> f64 {
    BODY_M + sketch.number(TIGHT_M, LOOSE_M)
}

fn any_heading(sketch: &mut Sketch) -> f64 {
    sketch.number(-180.0, 180.0)
}

fn around(middle: Point, radius_m: f64, angle_rad: f64) -> Point {
    let (sin, cos) = libm::sincos(angle_rad);
    [middle[0] + radius_m * cos, middle[1] + radius_m * sin]
}

fn airer(sketch: &mut Sketch) {
    let (length, width) = (sketch.number(0.9, 1.3), sketch.number(0.5, 0.65));
    let (west, south) = (0.8, 1.2);
    sketch.block([west, south - 0.03], [west + length, south]);
    sketch.block([west, south + width], [west + length, south + width + 0.03]);
    sketch.block([west - 0.03, south - 0.03], [west, south + width + 0.03]);
    // A foot blocks the open end.
    let gap = gap(sketch).min(width);
    sketch.block(
        [west + length - 0.03, south + gap],
        [west + length, south + width],
    );
    sketch.start([west + 0.25, south + 0.5 * width], 180.0);
    sketch.end_at(
        [west - 0.1, south - 0.1],
        [west + length + 0.1, south + width + 0.1],
    );
}

fn bed(sketch: &mut Sketch) {
    let (east, north) = (sketch.number(1.7, 2.1), sketch.number(1.4, 1.8));
    let gap = gap(sketch);
    // Boxes along the open sides, one gap between two of them.
    let split = sketch.number(0.4, east - gap - 0.45);
    sketch.block([0.0, north - 0.3], [split, north]);
    sketch.block([split + gap, north - 0.3], [east, north]);
    sketch.block([east - 0.3, 0.0], [east, north - 0.3]);
    let middle = sketch.number(0.5, east - 0.75);
    sketch.legs(&[[middle, 0.5 * (north - 0.3)]], 0.05);
    let heading_deg = any_heading(sketch);
    sketch.start([0.22, 0.22], heading_deg);
    sketch.end_at([0.0, 0.0], [east, north]);
}

fn black(sketch: &mut Sketch, exit: ExitKind) {
    let (low, high) = ([0.9, 1.0], [sketch.number(1.6, 1.9), sketch.number(1.8, 2.1)]);
    let lane_m = sketch.number(0.55, 0.75);
    let north = high[1] + 0.45;
    let south = low[1] - 0.45;
    // With an exit, the island reaches the wall in the west, and a lane leads along that wall.
    match exit {
        ExitKind::AlongTheWall => {
            sketch.black_rug(&[
                [0.0, south],
                [2.4, south],
                [2.4, north],
                [lane_m, north],
                [lane_m, high[1]],
                high,
                [high[0], low[1]],
                [0.0, low[1]],
            ]);
            sketch.end_at([0.0, south], [2.4, north]);
        }
        ExitKind::None | ExitKind::Later => {
            let outer = [
                [0.3, south],
                [2.4, south],
                [2.4, north],
                [0.3, north],
                [0.3, south],
            ];
            let inner = [low, [low[0], high[1]], high, [high[0], low[1]], low];
            sketch.black_rug(&[outer.as_slice(), inner.as_slice()].concat());
            sketch.end_at([0.3, south], [2.4, north]);
        }
    }
    let heading_deg = any_heading(sketch);
    sketch.start([0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])], heading_deg);
}

fn cables(sketch: &mut Sketch) {
    let middle = [1.3, 1.5];
    let knots: Vec<Point> = (0..5)
        .map(|knot| {
            let radius_m = sketch.number(0.5, 0.8);
            around(middle, radius_m, TAU / 5.0 * f64::from(knot))
        })
        .collect();
    for (number, knot) in knots.iter().enumerate() {
        let next = knots.get((number + 1) % knots.len()).copied().unwrap_or(*knot);
        let height_m = sketch.number(0.006, 0.013);
        sketch.threshold([*knot, next], 0.02, height_m);
    }
    let heading_deg = any_heading(sketch);
    sketch.start(middle, heading_deg);
    sketch.end_at([0.4, 0.6], [2.2, 2.4]);
}

fn carpet(sketch: &mut Sketch) {
    let feel = [
        sketch.number(2.0, 3.5),
        sketch.number(0.2, 0.5),
        sketch.number(-6.0, 6.0),
    ];
    sketch.rug(&corners([0.2, 0.4], [2.6, 2.6]), feel);
    let heading_deg = any_heading(sketch);
    sketch.start([1.4, 1.5], heading_deg);
    sketch.end_at([0.2, 0.4], [2.6, 2.6]);
}

fn chairs(sketch: &mut Sketch) {
    let middle = [1.2, 1.5];
    let radius_m = sketch.number(0.42, 0.6);
    let gap_rad = (gap(sketch) + 0.04) / radius_m;
    let gap_at_rad = sketch.number(-PI, PI);
    // So many legs that the robot does not fit between two of them.
    let count = libm::ceil((TAU - gap_rad) * radius_m / 0.3);
    let legs: Vec<Point> = (0..=count as u32)
        .map(|leg| {
            let angle_rad = gap_at_rad + 0.5 * gap_rad + (TAU - gap_rad) * f64::from(leg) / count;
            around(middle, radius_m, angle_rad)
        })
        .collect();
    sketch.legs(&legs, 0.04);
    let heading_deg = any_heading(sketch);
    sketch.start(middle, heading_deg);
    let reach_m = radius_m + 0.15;
    sketch.end_at(
        [middle[0] - reach_m, middle[1] - reach_m],
        [middle[0] + reach_m, middle[1] + reach_m],
    );
}

fn closet(sketch: &mut Sketch, exit: ExitKind) {
    let (east, north) = (sketch.number(0.8, 1.2), sketch.number(1.1, 2.2));
    sketch.wall([[east, 0.0], [east, north]]);
    sketch.wall([[0.0, north], [east + 0.05, north]]);
    let start = sketch.number(0.1, north - 0.95);
    let opens_s = (exit == ExitKind::Later).then(|| sketch.number(90.0, 300.0));
    sketch.shut_door([[east, start], [east, start + 0.75]], opens_s);
    let heading_deg = any_heading(sketch);
    sketch.start([0.4 * east, 0.5 * north], heading_deg);
    sketch.end_at([0.0, 0.0], [east + 0.1, north + 0.1]);
}

fn door_leaf(sketch: &mut Sketch) {
    // The leaf hangs at the south wall and is open toward the west wall.
    let hinge = sketch.number(0.95, 1.15);
    let gap = gap(sketch);
    let tip_x = gap + 0.03;
    let rise = libm::sqrt((0.85f64 * 0.85 - (hinge - tip_x) * (hinge - tip_x)).max(0.1));
    sketch.solid(&[
        [hinge, 0.0],
        [hinge + 0.05, 0.0],
        [tip_x + 0.05, rise],
        [tip_x, rise],
    ]);
    sketch.start([0.3, 0.22], -90.0);
    sketch.end_at([0.0, 0.0], [hinge + 0.05, rise + 0.25]);
}

fn landing(sketch: &mut Sketch) {
    let (east, south) = (sketch.number(1.2, 1.6), sketch.number(1.9, 2.1));
    let exit_m = sketch.number(0.7, 0.9);
    sketch.wall([[0.0, south - 0.05], [east, south - 0.05]]);
    // Stairs down at the west and, except for the exit, in the east.
    sketch.cliff([0.0, south], [0.25, 3.0]);
    sketch.cliff([east, south + exit_m], [east + 0.6, 3.0]);
    sketch.block([east, south - 0.1], [east + 0.6, south]);
    let heading_deg = any_heading(sketch);
    sketch.start([0.6 * east, south + 0.45], heading_deg);
    sketch.end_at([0.0, south - 0.1], [east + 0.6, 3.0]);
}

fn mirror(sketch: &mut Sketch) {
    let depth = sketch.number(1.0, 1.6);
    let gap = gap(sketch) + 0.05;
    let (south, north) = (1.5 - 0.5 * gap, 1.5 + 0.5 * gap);
    sketch.block([0.0, 0.0], [depth, south]);
    sketch.block([0.0, north], [depth, 3.0]);
    sketch.mirror([[0.0, south], [depth, south]]);
    sketch.mirror([[0.0, north], [depth, north]]);
    let heading_deg = any_heading(sketch);
    sketch.start([0.3, 1.5], heading_deg);
    sketch.end_at([0.0, 0.0], [depth, 3.0]);
}

fn people(sketch: &mut Sketch) {
    let middle = [1.2, 1.5];
    let turn_rad = sketch.number(0.0, TAU);
    let until_s = sketch.number(60.0, 240.0);
    for person in 0..3 {
        let place = around(middle, 0.39, turn_rad + TAU / 3.0 * f64::from(person));
        sketch.visitor(place, until_s + 2.0 * f64::from(person));
    }
    let heading_deg = any_heading(sketch);
    sketch.start(middle, heading_deg);
    sketch.end_at([0.6, 0.9], [1.8, 2.1]);
}

fn rug_edge(sketch: &mut Sketch) {
    let (low, high) = ([0.4, 0.6], [sketch.number(1.6, 2.4), sketch.number(1.8, 2.4)]);
    let feel = [
        sketch.number(0.8, 2.0),
        sketch.number(0.05, 0.2),
        sketch.number(-3.0, 3.0),
    ];
    sketch.rug(&corners(low, high), feel);
    let edges = corners(low, high);
    for (number, corner) in edges.iter().enumerate() {
        let next = edges.get((number + 1) % edges.len()).copied().unwrap_or(*corner);
        let height_m = sketch.number(0.010, 0.0145);
        sketch.threshold([*corner, next], 0.04, height_m);
    }
    let heading_deg = any_heading(sketch);
    sketch.start([1.0, 1.2], heading_deg);
    sketch.end_at(low, high);
}

fn slot(sketch: &mut Sketch) {
    let depth = sketch.number(0.8, 1.6);
    let half = 0.5 * gap(sketch);
    sketch.block([0.0, 0.0], [depth, 1.5 - half]);
    sketch.block([0.0, 1.5 + half], [depth, 3.0]);
    sketch.start([0.2, 1.5], 180.0);
    sketch.end_at([0.0, 0.0], [depth, 3.0]);
}

fn sofa(sketch: &mut Sketch) {
    let north = sketch.number(0.42, 0.6);
    let pitch = gap(sketch) + 0.04;
    // All gaps but one are closed by a leg in their middle.
    let exit_side = libm::floor(sketch.number(0.0, 3.99)) as u32;
    let mut legs = Vec::new();
    for field in 0..4 {
        let west = 0.05 + pitch * f64::from(field);
        legs.push([west, north]);
        if field != exit_side {
            legs.push([west + 0.5 * pitch, north]);
        }
    }
    let east = 0.05 + 4.0 * pitch;
    legs.push([east, north]);
    sketch.legs(&legs, 0.04);
    sketch.block([east, 0.0], [east + 0.3, north + 0.05]);
    sketch.start([0.67, 0.2], 180.0);
    sketch.end_at([0.0, 0.0], [east + 0.3, north + 0.1]);
}

fn stools(sketch: &mut Sketch) {
    let middle = [1.3, 1.5];
    let radius_m = sketch.number(0.5, 0.62);
    let turn_rad = sketch.number(0.0, TAU);
    for stool in 0..4 {
        let foot = around(middle, radius_m, turn_rad + TAU / 4.0 * f64::from(stool));
        let rim: Vec<Point> = (0..10)
            .map(|corner| around(foot, 0.2, TAU / 10.0 * f64::from(corner)))
            .collect();
        sketch.rug(&rim, [3.4, 0.4, 0.0]);
        sketch.legs(&[foot], 0.06);
    }
    let heading_deg = any_heading(sketch);
    sketch.start(middle, heading_deg);
    sketch.end_at(
        [middle[0] - 0.8, middle[1] - 0.8],
        [middle[0] + 0.8, middle[1] + 0.8],
    );
}

fn table(sketch: &mut Sketch) {
    let (west, south) = (0.7, 1.0);
    let (length, depth) = (sketch.number(1.3, 1.7), sketch.number(0.9, 1.1));
    sketch.legs(&corners([west, south], [west + length, south + depth]), 0.06);
    for side in [south, south + depth] {
        for place in [0.28, 0.72] {
            let (x, drawn_m) = (west + place * length, sketch.number(0.0, 0.15));
            let outward = if side == south { -1.0 } else { 1.0 };
            let y = side + outward * drawn_m;
            sketch.legs(&corners([x - 0.19, y - 0.19], [x + 0.19, y + 0.19]), 0.035);
        }
    }
    // One head of the table is taken, too.
    let x = if sketch.chance(0.5) { west } else { west + length };
    let y = south + 0.5 * depth;
    sketch.legs(&corners([x - 0.19, y - 0.19], [x + 0.19, y + 0.19]), 0.035);
    let heading_deg = any_heading(sketch);
    sketch.start([west + 0.5 * length, south + 0.5 * depth], heading_deg);
    sketch.end_at(
        [west - 0.1, south - 0.1],
        [west + length + 0.1, south + depth + 0.1],
    );
}

fn threshold(sketch: &mut Sketch) {
    let (east, north) = (sketch.number(1.2, 1.6), sketch.number(1.2, 1.8));
    let door_m = sketch.number(0.65, 0.8);
    let start = sketch.number(0.05, north - door_m - 0.1);
    sketch.wall([[0.0, north], [east + 0.05, north]]);
    sketch.wall([[east, 0.0], [east, start]]);
    sketch.wall([[east, start + door_m], [east, north]]);
    let height_m = sketch.number(0.011, 0.0148);
    sketch.threshold([[east, start], [east, start + door_m]], 0.08, height_m);
    let heading_deg = any_heading(sketch);
    sketch.start([0.4 * east, 0.5 * north], heading_deg);
    sketch.end_at([0.0, 0.0], [east + 0.2, north + 0.1]);
}

fn toilet(sketch: &mut Sketch) {
    // The bowl stands at the west wall in a niche; the robot beside it, its nose in the corner.
    let (beside_m, other_m) = (gap(sketch), sketch.number(0.1, 0.3));
    let (south, north) = (1.0, 1.0 + beside_m + 0.36 + other_m);
    let depth = sketch.number(0.8, 1.1);
    sketch.block([0.0, south - 0.1], [depth, south]);
    sketch.block([0.0, north], [depth, north + 0.1]);
    let bowl: Vec<Point> = (0..16)
        .map(|corner| {
            let (sin, cos) = libm::sincos(TAU / 16.0 * f64::from(corner));
            [0.3 + 0.3 * cos, south + beside_m + 0.18 + 0.18 * sin]
        })
        .collect();
    sketch.solid(&bowl);
    sketch.start([0.2, south + 0.5 * beside_m], 180.0);
    sketch.end_at([0.0, south - 0.1], [depth + 0.1, north + 0.1]);
}

fn hook(sketch: &mut Sketch) {
    // A dead end in the west, round a corner.
    let (first_m, second_m) = (gap(sketch) + 0.03, gap(sketch) + 0.03);
    let depth = sketch.number(0.6, 1.0);
    let (x0, y0) = (0.4, 0.6);
    sketch.block([x0 - 0.1, y0 - 0.1], [x0 + depth + second_m + 0.1, y0]);
    sketch.block([x0 - 0.1, y0], [x0, y0 + first_m + 0.1]);
    sketch.block([x0, y0 + first_m], [x0 + depth, y0 + first_m + 0.1]);
    sketch.block(
        [x0 + depth + second_m, y0],
        [x0 + depth + second_m + 0.1, y0 + first_m + 0.5],
    );
    sketch.block([x0 + depth - 0.1, y0 + first_m], [x0 + depth, y0 + first_m + 0.5]);
    sketch.start([x0 + 0.2, y0 + 0.5 * first_m], 180.0);
    sketch.end_at(
        [x0 - 0.1, y0 - 0.1],
        [x0 + depth + second_m + 0.1, y0 + first_m + 0.6],
    );
}

fn wedge(sketch: &mut Sketch) {
    let half_rad = sketch.number(10.0, 22.0) * PI / 180.0;
    let east = 2.2;
    let rise = east * libm::tan(half_rad);
    sketch.solid(&[[0.0, 1.5], [east, 1.5 - rise], [east, 0.0], [0.0, 0.0]]);
    sketch.solid(&[[0.0, 1.5], [east, 1.5 + rise], [east, 3.0], [0.0, 3.0]]);
    // Where the body just fits.
    let touches = 0.5 * BODY_M / libm::sin(half_rad);
    sketch.start([touches + 0.1, 1.5], 180.0);
    sketch.end_at([0.0, 0.0], [touches + 0.75, 3.0]);
}
