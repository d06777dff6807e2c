//! The map as version 2 of the form that Valetudo's clients read. Pixels of 5 cm from the upper left corner; places in centimetres, y downwards.

use std::collections::BTreeMap;

use bridge::{Knowledge, rle};
use rvac_api::{HomeView, NoGoShape, Pose};
use serde_json::{Map, Value, json};

/// Side of a pixel.
const PIXEL_CM: i32 = 5;
const PIXEL_M: f64 = 0.05;
/// No home has more pixels along a side.
const SIDE_MAX: i32 = 4_096;

/// Where the picture lies in our map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    left_m: f64,
    top_m: f64,
    width: i32,
    height: i32,
}

impl Frame {
    /// The frame of a home's map; `None` for one that is none.
    #[must_use]
    pub fn around(home: &HomeView) -> Option<Self> {
        let side = |cells: u32| {
            let pixels = whole((f64::from(cells) * home.cell_m / PIXEL_M).ceil());
            (1..=SIDE_MAX).contains(&pixels).then_some(pixels)
        };
        Some(Self {
            left_m: f64::from(home.x) * home.cell_m,
            top_m: (f64::from(home.y) + f64::from(home.height)) * home.cell_m,
            width: side(home.width)?,
            height: side(home.height)?,
        })
    }

    pub(crate) fn to_cm(self, x_m: f64, y_m: f64) -> [i32; 2] {
        [
            whole((x_m - self.left_m) * 100.0),
            whole((self.top_m - y_m) * 100.0),
        ]
    }

    /// A place of a command, metres in our map.
    #[must_use]
    pub fn to_m(self, x_cm: f64, y_cm: f64) -> [f64; 2] {
        [self.left_m + x_cm / 100.0, self.top_m - y_cm / 100.0]
    }
}

/// What a pixel belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Ground {
    Floor,
    Wall,
    Room(u32),
}

/// Names of the rooms by their identities.
#[must_use]
pub fn segments(home: &HomeView) -> Map<String, Value> {
    let title = |room: &rvac_api::RoomView| room.name.clone().unwrap_or_else(|| format!("room {}", room.id));
    home.rooms
        .iter()
        .map(|room| (room.id.to_string(), title(room).into()))
        .collect()
}

/// A map on which nothing is: what is told before there is one.
#[must_use]
pub fn empty_map() -> Value {
    json!({
        "__class": "ValetudoMap",
        "metaData": {"version": 2, "nonce": nonce(&[]), "totalLayerArea": 0},
        "size": {"x": 0, "y": 0},
        "pixelSize": PIXEL_CM,
        "layers": [],
        "entities": [],
    })
}

/// The map and its frame; `None` while nothing of the home is known: a map without layers is none to its readers.
#[must_use]
pub fn map(known: &Knowledge) -> Option<(Frame, Value)> {
    let home = known.home.as_ref().filter(|home| home.cell_m > 0.0)?;
    let frame = Frame::around(home)?;
    let pixels = pixels(home, frame);
    if pixels.is_empty() {
        return None;
    }
    let total = pixels.values().map(Vec::len).sum::<usize>() * area_of_pixel();
    let names = segments(home);
    let here = known
        .status
        .as_ref()
        .and_then(|status| status.room.as_ref())
        .map(|room| u32::from(room.id));
    let layers: Vec<Value> = pixels
        .iter()
        .map(|(ground, pixels)| layer(*ground, pixels, (&names, here)))
        .collect();
    let mut whole_map = json!({
        "__class": "ValetudoMap",
        "metaData": {"version": 2, "totalLayerArea": total},
        "size": {"x": frame.width * PIXEL_CM, "y": frame.height * PIXEL_CM},
        "pixelSize": PIXEL_CM,
        "layers": layers,
        "entities": entities(known, home, frame),
    });
    // Another nonce for another map, and the same for the same.
    let nonce = nonce(whole_map.to_string().as_bytes());
    if let Some(Value::Object(data)) = whole_map.get_mut("metaData") {
        data.insert("nonce".to_owned(), nonce.into());
    }
    Some((frame, whole_map))
}

fn area_of_pixel() -> usize {
    usize::try_from(PIXEL_CM * PIXEL_CM).unwrap_or(0)
}

/// In the form of a UUID (version 8, whose content is free).
fn nonce(bytes: &[u8]) -> String {
    let mut state = 0xcbf2_9ce4_8422_2325_u64; // FNV-1a
    for byte in bytes {
        state = (state ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    }
    let [high, low] = [state >> 32, state & 0xffff_ffff];
    format!(
        "{high:08x}-{:04x}-8{:03x}-8{:03x}-{low:012x}",
        low >> 16,
        low & 0xfff,
        high & 0xfff
    )
}

/// All pixels of each ground, row by row from the top.
fn pixels(home: &HomeView, frame: Frame) -> BTreeMap<Ground, Vec<[i32; 2]>> {
    let count = home.width as usize * home.height as usize;
    let kinds: Vec<u32> = rle::cells(&home.cells, count).collect();
    let rooms: Vec<u32> = rle::cells(&home.room_cells, count).collect();
    // So many cells along a pixel are looked at, so that no thin wall is lost.
    let samples = whole((PIXEL_M / home.cell_m).ceil()).clamp(1, 8);
    let cell = |along_cm: f64| usize::try_from(whole(along_cm / 100.0 / home.cell_m)).ok();
    let at = |x: i32, y: i32| {
        let mut ground = None;
        for (dx, dy) in (0..samples).flat_map(|dx| (0..samples).map(move |dy| (dx, dy))) {
            let part = |pixel: i32, step: i32| {
                (f64::from(pixel) + (f64::from(step) + 0.5) / f64::from(samples)) * f64::from(PIXEL_CM)
            };
            let column = cell(part(x, dx)).filter(|column| *column < home.width as usize);
            let row = cell(f64::from(home.height) * home.cell_m * 100.0 - part(y, dy));
            let (Some(column), Some(row)) = (column, row) else {
                continue;
            };
            let index = row * home.width as usize + column;
            match (kinds.get(index), rooms.get(index)) {
                (Some(2 | 3), _) => return Some(Ground::Wall),
                (Some(1), Some(0) | None) => ground = ground.or(Some(Ground::Floor)),
                (Some(1), Some(room)) => ground = Some(Ground::Room(*room)),
                _ => {}
            }
        }
        ground
    };
    let mut all: BTreeMap<Ground, Vec<[i32; 2]>> = BTreeMap::new();
    for (y, x) in (0..frame.height).flat_map(|y| (0..frame.width).map(move |x| (y, x))) {
        if let Some(ground) = at(x, y) {
            all.entry(ground).or_default().push([x, y]);
        }
    }
    all
}

fn layer(ground: Ground, pixels: &[[i32; 2]], (names, here): (&Map<String, Value>, Option<u32>)) -> Value {
    let area = pixels.len() * area_of_pixel();
    let (kind, data) = match ground {
        Ground::Floor => ("floor", json!({"area": area})),
        Ground::Wall => ("wall", json!({"area": area})),
        Ground::Room(id) => {
            let id_text = id.to_string();
            let name = names
                .get(&id_text)
                .cloned()
                .unwrap_or_else(|| id_text.clone().into());
            let active = here == Some(id);
            (
                "segment",
                json!({"area": area, "segmentId": id_text, "name": name, "active": active, "material": "generic"}),
            )
        }
    };
    json!({
        "__class": "MapLayer",
        "type": kind,
        "metaData": data,
        "pixels": [],
        "dimensions": {
            "x": extent(pixels.iter().map(|[x, _]| *x)),
            "y": extent(pixels.iter().map(|[_, y]| *y)),
            "pixelCount": pixels.len(),
        },
        "compressedPixels": runs(pixels),
    })
}

fn extent(values: impl Iterator<Item = i32> + Clone) -> Value {
    let (low, high) = (
        values.clone().min().unwrap_or(0),
        values.clone().max().unwrap_or(0),
    );
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| {
        (sum + f64::from(value), count + 1.0)
    });
    let middle = whole((f64::from(low) + f64::from(high)) / 2.0 + 0.5);
    json!({"min": low, "max": high, "mid": middle, "avg": whole(sum / f64::max(count, 1.0) + 0.5)})
}

/// Pixels that stand beside each other in a row, as x, y and how many.
fn runs(pixels: &[[i32; 2]]) -> Vec<i32> {
    let mut runs: Vec<[i32; 3]> = Vec::new();
    for &[x, y] in pixels {
        match runs.last_mut() {
            Some([start, row, count]) if *row == y && *start + *count == x => *count += 1,
            _ => runs.push([x, y, 1]),
        }
    }
    runs.concat()
}

fn entities(known: &Knowledge, home: &HomeView, frame: Frame) -> Vec<Value> {
    let mut entities = Vec::new();
    let mut push = |class: &str, kind: &str, (points, data): (Vec<i32>, Value)| {
        entities.push(json!({"__class": class, "type": kind, "points": points, "metaData": data}));
    };
    let pose = |pose: Pose| {
        (
            frame.to_cm(pose.x, pose.y).to_vec(),
            json!({"angle": angle(pose.heading)}),
        )
    };
    if let Some(dock) = home.dock {
        push("PointMapEntity", "charger_location", pose(dock));
    }
    if let Some(place) = known.place() {
        push("PointMapEntity", "robot_position", pose(place));
    }
    let path = path(&known.map.path_mm, frame);
    if path.len() >= 4 {
        push("PathMapEntity", "path", (path, json!({})));
    }
    for no_go in &home.no_go {
        let data = json!({"id": no_go.number.to_string()});
        let (class, kind) = match &no_go.shape {
            NoGoShape::Wall(_) => ("LineMapEntity", "virtual_wall"),
            NoGoShape::Zone(_) => ("PolygonMapEntity", "no_go_area"),
        };
        push(class, kind, (told_places(&no_go.shape, frame).concat(), data));
    }
    entities
}

/// Degrees clockwise from above.
fn angle(heading_rad: f64) -> i32 {
    whole(90.5 - heading_rad.to_degrees()).rem_euclid(360)
}

/// The ends of a wall; the four corners of a zone, and of one with other numbers of corners those of the rectangle around it, for the
/// form knows no others.
pub(crate) fn told_places(shape: &NoGoShape, frame: Frame) -> Vec<[i32; 2]> {
    let told = |places: &[[f64; 2]]| places.iter().map(|[x, y]| frame.to_cm(*x, *y)).collect();
    let corners: Vec<[i32; 2]> = match shape {
        NoGoShape::Wall(ends) => return told(ends),
        NoGoShape::Zone(corners) => told(corners),
    };
    if corners.len() == 4 {
        return corners;
    }
    let side = |axis: usize| {
        let along = corners.iter().filter_map(move |corner| corner.get(axis).copied());
        (along.clone().min().unwrap_or(0), along.max().unwrap_or(0))
    };
    let ((left, right), (top, bottom)) = (side(0), side(1));
    vec![[left, top], [right, top], [right, bottom], [left, bottom]]
}

/// The path in centimetres, without corners that lie on the line between their neighbours.
fn path(path_mm: &[i32], frame: Frame) -> Vec<i32> {
    let mut corners: Vec<[i32; 2]> = Vec::new();
    for pair in path_mm.chunks_exact(2) {
        let &[x, y] = pair else { continue };
        let next = frame.to_cm(f64::from(x) / 1e3, f64::from(y) / 1e3);
        if corners.last() == Some(&next) {
            continue;
        }
        if let [.., first, middle] = corners.as_slice() {
            let ([ax, ay], [bx, by]) = (*first, *middle);
            let cross =
                i64::from(bx - ax) * i64::from(next[1] - by) - i64::from(by - ay) * i64::from(next[0] - bx);
            let onward =
                i64::from(bx - ax) * i64::from(next[0] - bx) + i64::from(by - ay) * i64::from(next[1] - by);
            if cross == 0 && onward > 0 {
                corners.pop();
            }
        }
        corners.push(next);
    }
    corners.concat()
}

/// The whole number below, within what a home may have.
#[expect(
    clippy::cast_possible_truncation,
    reason = "it is held within a range before, and NaN becomes 0"
)]
fn whole(value: f64) -> i32 {
    value.floor().clamp(-1e6, 1e6) as i32
}

#[cfg(test)]
mod tests {
    use bridge::Knowledge;
    use rvac_api::{HomeView, MapSnapshot, NoGoShape, NoGoView, Pose, RoomView, Update};

    use super::map;

    fn known() -> Knowledge {
        let mut known = Knowledge::default();
        known.take(&Update::Home(HomeView {
            cell_m: 0.05,
            x: -2,
            y: 10,
            width: 4,
            height: 2,
            // Below: wall, room 3, room 3, floor; above: unknown, room 3, floor, floor.
            cells: vec![2, 1, 1, 3, 0, 1, 1, 3],
            room_cells: vec![0, 1, 3, 2, 0, 2, 3, 1, 0, 2],
            rooms: vec![RoomView {
                id: 3,
                area_m2: 1.0,
                x: 0.0,
                y: 0.0,
                name: Some("Kitchen".to_owned()),
                settings: None,
            }],
            dock: Some(Pose {
                x: 0.0,
                y: 0.5,
                heading: 0.0,
                t: 0.0,
            }),
            no_go: vec![NoGoView {
                number: 2,
                shape: NoGoShape::Zone(vec![[0.0, 0.5], [0.05, 0.5], [0.0, 0.55]]),
                name: None,
            }],
            ..HomeView::default()
        }));
        known.take(&Update::Map(MapSnapshot {
            path_mm: vec![-100, 500, -50, 500, 0, 500, 0, 600],
            ..MapSnapshot::default()
        }));
        known
    }

    #[test]
    fn the_map_is_in_pixels_from_the_upper_left_corner() {
        let (frame, told) = map(&known()).expect("a map");
        assert_eq!(told["size"].to_string(), r#"{"x":20,"y":10}"#);
        let layers = told["layers"].as_array().expect("layers");
        let runs: Vec<String> = layers
            .iter()
            .map(|layer| layer["compressedPixels"].to_string())
            .collect();
        assert_eq!(
            runs,
            ["[2,0,2,3,1,1]", "[0,1,1]", "[1,0,1,1,1,2]"],
            "floor, wall, room"
        );
        assert_eq!(layers[2]["metaData"]["name"], "Kitchen");
        assert_eq!(
            layers[2]["dimensions"]["x"].to_string(),
            r#"{"avg":1,"max":2,"mid":2,"min":1}"#
        );
        assert_eq!(told["metaData"]["totalLayerArea"], 7 * 25);
        let entities = told["entities"].as_array().expect("entities");
        assert_eq!(
            entities[0]["points"].to_string(),
            "[10,10]",
            "the dock, at the lower edge"
        );
        assert_eq!(entities[0]["metaData"]["angle"], 90, "it looks to the right");
        let path = entities
            .iter()
            .find(|entity| entity["type"] == "path")
            .expect("a path");
        assert_eq!(path["points"].to_string(), "[0,10,10,10,10,0]");
        let zone = entities
            .iter()
            .find(|entity| entity["type"] == "no_go_area")
            .expect("a zone");
        assert_eq!(zone["points"].as_array().map(Vec::len), Some(8));
        assert!(frame.to_m(10.0, 10.0)[1] - 0.5 < 1e-9);
        assert_eq!(
            map(&known()).expect("a map").1["metaData"]["nonce"],
            told["metaData"]["nonce"]
        );
    }

    #[test]
    fn no_home_gives_no_map_and_none_makes_it_fail() {
        assert!(map(&Knowledge::default()).is_none());
        let mut wild = Knowledge::default();
        wild.take(&Update::Home(HomeView {
            cell_m: f64::NAN,
            width: u32::MAX,
            height: u32::MAX,
            ..HomeView::default()
        }));
        assert!(map(&wild).is_none());
    }
}
