//! Furniture of each kind of room.

use super::furnisher::{Furnisher, LEG_M, Where};
use super::shape::{Rect, RoomSide, WallFrame};
use super::sizes::{
    ARMCHAIR, BED_NARROW, BED_WIDE, BOX, COFFEE_TABLE, COUNTER_DEPTH_M, DESK, DINING_TABLE, DOG_BED, DRESSER,
    FLOOR_LAMP, FRIDGE, GARBAGE_CAN, HAMPER, HOUSE_PLANT, SHELF, SIDE_TABLE, SOFA, STOOL, Size, TOILET,
    TV_STAND, WASHING_MACHINE,
};
use super::things::{PlacedLine, RoomKind};

/// Clear floor in front of furniture with doors or drawers.
const DRAWERS_M: f64 = 0.5;

/// Furnishes one room.
pub(super) fn furnish(room: &mut Furnisher<'_>, kind: RoomKind) {
    match kind {
        RoomKind::Living => living(room),
        RoomKind::Studio => studio(room),
        RoomKind::Kitchen => kitchen(room),
        RoomKind::Bedroom => bedroom(room),
        RoomKind::Child => child(room),
        RoomKind::Office => office(room),
        RoomKind::Bath => bath(room),
        RoomKind::Toilet => toilet(room),
        RoomKind::Corridor => corridor(room),
        RoomKind::Storage => storage(room),
    }
}

fn living(room: &mut Furnisher<'_>) {
    let sofa_side = sofa_group(room);
    television(room, sofa_side.map(RoomSide::opposite));
    if room.room.area_m2() > 20.0 {
        dining(room);
    }
    if room.draw.chance(0.6) {
        boxy(room, Boxy::new("Armchair", ARMCHAIR), 0.4, Where::Wall);
    }
    boxy(room, Boxy::new("Shelf", SHELF), DRAWERS_M, Where::Wall);
    if room.draw.chance(0.5) {
        boxy(room, Boxy::new("Sideboard", DRESSER), DRAWERS_M, Where::Wall);
    }
    plant(room);
    lamp(room);
    clutter(room, 2);
}

fn studio(room: &mut Furnisher<'_>) {
    counter(room, 1.8);
    bed(room, BED_NARROW);
    let side = sofa_group(room);
    television(room, side.map(RoomSide::opposite));
    dining(room);
    boxy(room, Boxy::new("Wardrobe", DRESSER), DRAWERS_M, Where::Corner);
    lamp(room);
    clutter(room, 1);
}

fn kitchen(room: &mut Furnisher<'_>) {
    counter(room, 2.0);
    boxy(room, Boxy::new("Fridge", FRIDGE), DRAWERS_M, Where::Corner);
    if room.room.area_m2() > 8.5 {
        dining(room);
    }
    boxy(room, Boxy::new("Dustbin", GARBAGE_CAN), 0.0, Where::Wall);
}

fn bedroom(room: &mut Furnisher<'_>) {
    bed(room, BED_WIDE);
    let wardrobe = wardrobe(room);
    if let Some(line) = wardrobe.filter(|_| room.draw.chance(0.3)) {
        room.things.mirrors.push(line);
    }
    if room.draw.chance(0.6) {
        boxy(
            room,
            Boxy::new("Chest of drawers", DRESSER),
            DRAWERS_M,
            Where::Wall,
        );
    }
    if room.draw.chance(0.5) {
        single_chair(room);
    }
    clutter(room, 1);
}

fn child(room: &mut Furnisher<'_>) {
    bed(room, BED_NARROW);
    desk(room);
    boxy(room, Boxy::new("Shelf", SHELF), DRAWERS_M, Where::Wall);
    loose_rug(room, (1.4, 1.0));
    clutter(room, 3);
}

fn office(room: &mut Furnisher<'_>) {
    desk(room);
    boxy(room, Boxy::new("Shelf", SHELF), DRAWERS_M, Where::Wall);
    boxy(room, Boxy::new("Shelf", SHELF), DRAWERS_M, Where::Wall);
    if room.draw.chance(0.4) {
        boxy(room, Boxy::new("Armchair", ARMCHAIR), 0.4, Where::Corner);
    }
    plant(room);
    clutter(room, 1);
}

fn bath(room: &mut Furnisher<'_>) {
    let tub = if room.draw.chance(0.6) {
        (0.75, 1.7)
    } else {
        (0.9, 0.9)
    };
    if let Some((frame, _)) = room.at_wall(tub, 0.0, Where::Corner) {
        let rect = frame.rect([0.0, 0.0], [tub.0, tub.1]);
        room.solid("Bath or shower tray", &rect);
    }
    pedestal(room);
    basin(room);
    if room.draw.chance(0.5) {
        boxy(
            room,
            Boxy::new("Washing machine", WASHING_MACHINE),
            0.4,
            Where::Corner,
        );
    }
    if room.draw.chance(0.5) {
        boxy(room, Boxy::new("Hamper", HAMPER), 0.0, Where::Wall);
    }
    loose_rug(room, (0.8, 0.5));
}

fn toilet(room: &mut Furnisher<'_>) {
    pedestal(room);
}

fn corridor(room: &mut Furnisher<'_>) {
    let width = room.room.width().min(room.room.depth());
    if width > 1.3 {
        boxy(
            room,
            Boxy::new("Shoe cabinet", &[(0.8, 0.24), (1.1, 0.24), (0.6, 0.3)]),
            0.6,
            Where::Wall,
        );
    }
    if room.draw.chance(0.5) {
        let inner = room.room.grown(-0.3);
        let runner = Rect::new(inner.low, [inner.low[0] + 0.6 * inner.width(), inner.high[1]]);
        if runner.depth() > 0.4 {
            room.rug(&runner);
        }
    }
    if room.draw.chance(0.3) {
        let side = if room.draw.chance(0.5) {
            RoomSide::South
        } else {
            RoomSide::North
        };
        if let Some((frame, _)) = room.at_wall((0.5, 0.04), 0.5, Where::At(side)) {
            let rect = frame.rect([0.0, 0.0], [0.5, 0.04]);
            room.solid("Standing mirror", &rect);
            room.things.mirrors.push(PlacedLine {
                ends: [frame.point(0.0, 0.04), frame.point(0.5, 0.04)],
                thickness_m: 0.06,
            });
        }
    }
}

fn storage(room: &mut Furnisher<'_>) {
    boxy(room, Boxy::new("Shelf", SHELF), 0.4, Where::Corner);
    boxy(room, Boxy::new("Shelf", SHELF), 0.4, Where::Wall);
    clutter(room, 2);
}

/// A sofa with a low table and often a rug in front of it; gives the wall.
fn sofa_group(room: &mut Furnisher<'_>) -> Option<RoomSide> {
    let (width, depth) = room.draw.pick(SOFA);
    let table = room.draw.pick(COFFEE_TABLE);
    let gap = room.draw.length(0.36, 0.5);
    let reach = depth + gap + table.1;
    let (frame, side) = room.at_wall((width, reach), 0.5, Where::Wall)?;
    let start = 0.5 * (width - table.0);
    if room.draw.chance(0.65) {
        let aside = room.draw.length(0.1, 0.4);
        let rug = frame.rect(
            [start - aside, depth + 0.06],
            [start + table.0 + aside, reach + 0.24],
        );
        room.rug(&clipped(&rug, &room.room));
    }
    let body = frame.rect([0.0, 0.0], [width, depth]);
    if room.draw.chance(0.6) {
        room.solid("Sofa", &body);
    } else {
        room.on_legs("Sofa on legs", &body, LEG_M);
    }
    let top = frame.rect([start, depth + gap], [start + table.0, reach]);
    if room.draw.chance(0.75) {
        room.on_legs("Coffee table", &top, LEG_M);
    } else {
        room.solid("Coffee table", &top);
    }
    Some(side)
}

fn television(room: &mut Furnisher<'_>, side: Option<RoomSide>) {
    let size = room.draw.pick(TV_STAND);
    let place = side.map_or(Where::Wall, Where::At);
    if let Some((frame, _)) = room.at_wall(size, DRAWERS_M, place) {
        let rect = frame.rect([0.0, 0.0], [size.0, size.1]);
        room.solid("Television stand", &rect);
        if room.draw.chance(0.4) {
            room.things.cables.push(PlacedLine {
                ends: [frame.point(size.0 + 0.02, 0.06), frame.point(size.0 + 0.4, 0.2)],
                thickness_m: 0.02,
            });
        }
    }
}

/// A table with chairs at two sides, free or with one end at a wall.
fn dining(room: &mut Furnisher<'_>) {
    let small = room.room.area_m2() < 14.0;
    let size = if small {
        DINING_TABLE[0]
    } else {
        room.draw.pick(DINING_TABLE)
    };
    let reach = 0.55;
    let group = (size.0, size.1 + 2.0 * reach);
    let frame = if small { None } else { room.freely(group) };
    let Some(frame) = frame.or_else(|| {
        // One narrow end at the wall: the frame's x must run into the room.
        room.at_wall((group.1, group.0), 0.3, Where::Wall)
            .map(|(frame, _)| WallFrame {
                origin: frame.point(group.1, 0.0),
                along: frame.into,
                into: [-frame.along[0], -frame.along[1]],
            })
    }) else {
        return;
    };
    if !small && room.draw.chance(0.3) {
        let rug = frame.rect([-0.3, 0.1], [size.0 + 0.3, group.1 - 0.1]);
        room.rug(&clipped(&rug, &room.room));
    }
    let top = frame.rect([0.0, reach], [size.0, reach + size.1]);
    room.on_legs("Dining table", &top, 0.07);
    let pairs = if size.0 > 1.6 {
        3
    } else if size.0 > 1.2 {
        2
    } else {
        1
    };
    for number in 0..pairs {
        let x = size.0 * (f64::from(number) + 0.5) / f64::from(pairs);
        room.chair(&frame, [x, reach], [0.0, -1.0]);
        room.chair(&frame, [x, reach + size.1], [0.0, 1.0]);
    }
}

/// A bed with its head at a wall and night tables beside it.
fn bed(room: &mut Furnisher<'_>, sizes: &[Size]) {
    let size = room.draw.pick(sizes);
    let table = SIDE_TABLE[0];
    let tables = if size.0 > 1.3 { 2.0 } else { 1.0 };
    let group = (size.0 + tables * (table.0 + 0.04), size.1);
    let placed = room.at_wall(group, 0.5, Where::Wall);
    let Some((frame, _)) = placed.or_else(|| room.at_wall(group, 0.35, Where::Corner)) else {
        return;
    };
    let start = if tables > 1.0 { table.0 + 0.04 } else { 0.0 };
    let body = frame.rect([start, 0.0], [start + size.0, size.1]);
    if room.draw.chance(0.5) {
        room.on_legs("Bed", &body, 0.08);
    } else {
        room.solid("Box bed", &body);
    }
    let after = frame.rect([group.0 - table.0, 0.0], [group.0, table.1]);
    room.solid("Night table", &after);
    if tables > 1.0 {
        let before = frame.rect([0.0, 0.0], [table.0, table.1]);
        room.on_legs("Night table", &before, 0.03);
    }
}

/// A wardrobe; gives the line of its doors.
fn wardrobe(room: &mut Furnisher<'_>) -> Option<PlacedLine> {
    let size = (room.draw.length(1.2, 2.2), 0.6);
    let (frame, _) = room.at_wall(size, 0.55, Where::Corner)?;
    let rect = frame.rect([0.0, 0.0], [size.0, size.1]);
    room.solid("Wardrobe", &rect);
    Some(PlacedLine {
        ends: [frame.point(0.2, size.1), frame.point(size.0 - 0.2, size.1)],
        thickness_m: 0.06,
    })
}

/// A desk on legs or on a pedestal of drawers, with an office chair on five castors.
fn desk(room: &mut Furnisher<'_>) {
    let size = room.draw.pick(DESK);
    let Some((frame, _)) = room.at_wall(size, 0.8, Where::Wall) else {
        return;
    };
    let rect = frame.rect([0.0, 0.0], [size.0, size.1]);
    room.on_legs("Desk", &rect, LEG_M);
    if room.draw.chance(0.4) {
        let drawers = frame.rect([0.06, 0.06], [0.48, size.1 - 0.06]);
        room.solid("Drawers below the desk", &drawers);
    }
    let at = frame.point(0.62 * size.0, size.1 + 0.1 + room.moved.number(0.0, 0.35));
    let turn = room.moved.number(0.0, 1.2);
    let legs = (0..5)
        .map(|number| {
            let (sin, cos) = libm::sincos(turn + f64::from(number) * core::f64::consts::TAU / 5.0);
            [at[0] + 0.29 * cos, at[1] + 0.29 * sin]
        })
        .chain([at])
        .collect();
    room.legs("Office chair", legs, LEG_M);
    if room.draw.chance(0.5) {
        room.things.cables.push(PlacedLine {
            ends: [
                frame.point(0.5 * size.0, 0.02),
                frame.point(0.5 * size.0 + 0.3, 0.5),
            ],
            thickness_m: 0.02,
        });
    }
}

/// A kitchen counter along most of a wall.
fn counter(room: &mut Furnisher<'_>, shortest_m: f64) {
    for _ in 0..8 {
        let side = RoomSide::ALL[room.draw.below(4)];
        let longest_m = WallFrame::length_of(&room.room, side);
        let size = (room.draw.length(shortest_m, longest_m.min(3.6)), COUNTER_DEPTH_M);
        if let Some((frame, _)) = room.at_wall(size, 0.7, Where::At(side)) {
            let rect = frame.rect([0.0, 0.0], [size.0, size.1]);
            room.solid("Kitchen counter", &rect);
            return;
        }
    }
}

fn pedestal(room: &mut Furnisher<'_>) {
    let (width, depth) = room.draw.pick(TOILET);
    // The box of the database includes the open lid; the foot is narrower.
    if let Some((frame, _)) = room.at_wall((width, 0.75 * depth), 0.4, Where::Wall) {
        let rect = frame.rect([0.5 * width - 0.18, 0.0], [0.5 * width + 0.18, 0.72 * depth]);
        room.solid("Toilet", &rect);
    }
}

fn basin(room: &mut Furnisher<'_>) {
    let width = room.draw.length(0.5, 0.9);
    if let Some((frame, _)) = room.at_wall((width, 0.44), 0.5, Where::Wall) {
        if room.draw.chance(0.5) {
            let rect = frame.rect([0.0, 0.0], [width, 0.44]);
            room.solid("Washbasin with cupboard", &rect);
        } else {
            room.legs(
                "Foot of the washbasin",
                vec![frame.point(0.5 * width, 0.14)],
                0.18,
            );
        }
    }
}

/// A piece that is a box, and its usual sizes.
#[derive(Clone, Copy, Debug)]
struct Boxy {
    name: &'static str,
    sizes: &'static [Size],
}

impl Boxy {
    const fn new(name: &'static str, sizes: &'static [Size]) -> Self {
        Self { name, sizes }
    }
}

fn boxy(room: &mut Furnisher<'_>, piece: Boxy, front_m: f64, place: Where) {
    let size = room.draw.pick(piece.sizes);
    if let Some((frame, _)) = room.at_wall(size, front_m, place) {
        let rect = frame.rect([0.0, 0.0], [size.0, size.1]);
        room.solid(piece.name, &rect);
    }
}

fn single_chair(room: &mut Furnisher<'_>) {
    if let Some((frame, _)) = room.at_wall((0.5, 0.5), 0.3, Where::Wall) {
        room.chair(&frame, [0.25, 0.25], [0.0, 0.3]);
    }
}

fn plant(room: &mut Furnisher<'_>) {
    let size = room.draw.pick(HOUSE_PLANT);
    if let Some((frame, _)) = room.at_wall(size, 0.0, Where::Corner) {
        room.legs(
            "Flower pot",
            vec![frame.point(0.5 * size.0, 0.5 * size.1)],
            0.8 * size.1,
        );
    }
}

fn lamp(room: &mut Furnisher<'_>) {
    let size = room.draw.pick(FLOOR_LAMP);
    if let Some((frame, _)) = room.at_wall(size, 0.0, Where::Corner) {
        room.legs(
            "Foot of a floor lamp",
            vec![frame.point(0.5 * size.0, 0.5 * size.1)],
            0.5 * size.0,
        );
    }
}

fn loose_rug(room: &mut Furnisher<'_>, (width, depth): Size) {
    let inner = room.room.grown(-0.2);
    if room.draw.chance(0.6) && inner.width() > width && inner.depth() > depth {
        let x = room.draw.length(inner.low[0], inner.high[0] - width);
        let y = room.draw.length(inner.low[1], inner.high[1] - depth);
        room.rug(&Rect::new([x, y], [x + width, y + depth]));
    }
}

/// What lies about today.
fn clutter(room: &mut Furnisher<'_>, most: usize) {
    let kinds: [(&'static str, &[Size]); 4] = [
        ("Box", BOX),
        ("Stool", STOOL),
        ("Bag or toy", &[(0.2, 0.2), (0.3, 0.3)]),
        ("Bed of the dog", DOG_BED),
    ];
    for _ in 0..room.moved.below(most + 1) {
        let (name, sizes) = kinds[room.moved.below(if most > 1 { 4 } else { 3 })];
        let size = room.moved.pick(sizes);
        let Some([x, y]) = room.put_down(size.0.max(size.1)) else {
            continue;
        };
        let rect = Rect::new(
            [x - 0.5 * size.0, y - 0.5 * size.1],
            [x + 0.5 * size.0, y + 0.5 * size.1],
        );
        if name == "Stool" {
            room.on_legs(name, &rect, 0.035);
        } else {
            room.solid(name, &rect);
        }
    }
}

fn clipped(rect: &Rect, room: &Rect) -> Rect {
    let inside = |point: [f64; 2]| {
        [
            point[0].clamp(room.low[0], room.high[0]),
            point[1].clamp(room.low[1], room.high[1]),
        ]
    };
    Rect::new(inside(rect.low), inside(rect.high))
}
