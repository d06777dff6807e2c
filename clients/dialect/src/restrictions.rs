//! No-go zones and virtual walls as the dialect sends them: always all of them.

use rvac_api::{HomeView, NoGoShape, RequestBody};
use serde_json::{Value, json};

use crate::body::{BodyError, field, list, place, wrong};
use crate::map::{Frame, told_places};

/// Names of places, in the order of the corners.
const CORNERS: [&str; 4] = ["pA", "pB", "pC", "pD"];
/// A place that comes back differs from the one that was told by no more, for clients round.
const SAME_CM: i32 = 1;

/// All that there are.
#[must_use]
pub fn restrictions(home: &HomeView, frame: Frame) -> Value {
    let mut walls = Vec::new();
    let mut zones = Vec::new();
    for no_go in &home.no_go {
        let places = told_places(&no_go.shape, frame);
        let points: serde_json::Map<String, Value> = CORNERS
            .iter()
            .zip(&places)
            .map(|(name, [x, y])| ((*name).to_owned(), json!({"x": x, "y": y})))
            .collect();
        match no_go.shape {
            NoGoShape::Wall(_) => walls.push(json!({"points": points})),
            NoGoShape::Zone(_) => zones.push(json!({"points": points, "type": "regular"})),
        }
    }
    json!({"virtualWalls": walls, "restrictedZones": zones})
}

/// What must be asked so that there are exactly these. New ones come first: floor that stays forbidden is so all the time.
///
/// # Errors
/// [`BodyError`].
pub fn restriction_changes(
    home: &HomeView,
    frame: Frame,
    body: &Value,
) -> Result<Vec<RequestBody>, BodyError> {
    let mut kept = vec![false; home.no_go.len()];
    let mut asked = Vec::new();
    for shape in wanted(body, frame)? {
        let places = told_places(&shape, frame);
        let there = home
            .no_go
            .iter()
            .zip(&kept)
            .position(|(no_go, kept)| !kept && is_same(&no_go.shape, &shape, (&places, frame)));
        match there.and_then(|there| kept.get_mut(there)) {
            Some(kept) => *kept = true,
            None => asked.push(RequestBody::AddNoGo { shape, name: None }),
        }
    }
    let gone = home.no_go.iter().zip(kept).filter(|(_, kept)| !kept);
    asked.extend(gone.map(|(no_go, _)| RequestBody::RemoveNoGo { number: no_go.number }));
    Ok(asked)
}

fn wanted(body: &Value, frame: Frame) -> Result<Vec<NoGoShape>, BodyError> {
    let mut shapes = Vec::new();
    for wall in list(body, "virtualWalls")? {
        let points = field(wall, "points")?;
        let ends = [place(points, "pA", frame)?, place(points, "pB", frame)?];
        shapes.push(NoGoShape::Wall(ends));
    }
    for zone in list(body, "restrictedZones")? {
        if field(zone, "type")? != "regular" {
            return Err(wrong("type", "regular: this robot has no mop"));
        }
        let points = field(zone, "points")?;
        let corners: Result<Vec<_>, _> = CORNERS
            .into_iter()
            .map(|corner| place(points, corner, frame))
            .collect();
        shapes.push(NoGoShape::Zone(corners?));
    }
    Ok(shapes)
}

/// Whether a shape is one that was told: a zone of many corners was told as the rectangle around it.
fn is_same(ours: &NoGoShape, theirs: &NoGoShape, (places, frame): (&[[i32; 2]], Frame)) -> bool {
    let is_one_kind = matches!(
        (ours, theirs),
        (NoGoShape::Wall(_), NoGoShape::Wall(_)) | (NoGoShape::Zone(_), NoGoShape::Zone(_))
    );
    let told = told_places(ours, frame);
    let is_near = |(a, b): (&[i32; 2], &[i32; 2])| {
        a.iter()
            .zip(b)
            .all(|(a, b)| (i64::from(*a) - i64::from(*b)).abs() <= i64::from(SAME_CM))
    };
    is_one_kind && told.len() == places.len() && told.iter().zip(places).all(is_near)
}

#[cfg(test)]
mod tests {
    use rvac_api::{HomeView, NoGoShape, NoGoView, RequestBody};
    use serde_json::json;

    use super::{restriction_changes, restrictions};
    use crate::Frame;

    fn home() -> HomeView {
        let no_go = |number, shape| NoGoView {
            number,
            shape,
            name: Some("mine".to_owned()),
        };
        HomeView {
            cell_m: 0.05,
            x: -20,
            y: -20,
            width: 100,
            height: 100,
            no_go: vec![
                no_go(4, NoGoShape::Wall([[0.0, 0.0], [1.0, 0.333]])),
                no_go(7, NoGoShape::Zone(vec![[0.0, 0.0], [0.5, 0.0], [0.2, 0.7]])),
                no_go(
                    9,
                    NoGoShape::Zone(vec![[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]]),
                ),
            ],
            ..HomeView::default()
        }
    }

    #[test]
    fn what_comes_back_as_it_was_told_changes_nothing() {
        let home = home();
        let frame = Frame::around(&home).expect("a frame");
        let told = restrictions(&home, frame);
        assert_eq!(told["virtualWalls"].as_array().map(Vec::len), Some(1));
        assert_eq!(told["restrictedZones"].as_array().map(Vec::len), Some(2));
        assert_eq!(restriction_changes(&home, frame, &told), Ok(vec![]));
    }

    #[test]
    fn all_that_is_not_named_goes_after_the_new_has_come() {
        let home = home();
        let frame = Frame::around(&home).expect("a frame");
        let mut told = restrictions(&home, frame);
        told["restrictedZones"].as_array_mut().expect("zones").remove(0);
        told["virtualWalls"][0]["points"]["pB"] = json!({"x": "10", "y": 20});
        let asked = restriction_changes(&home, frame, &told).expect("changes");
        let [RequestBody::AddNoGo { shape, .. }, gone @ ..] = asked.as_slice() else {
            panic!("{asked:?}");
        };
        let NoGoShape::Wall([_, [x, y]]) = shape else {
            panic!("{shape:?}");
        };
        assert!((x + 0.9).abs() < 1e-9 && (y - 3.8).abs() < 1e-9, "{x} {y}");
        let numbers = [4, 7].map(|number| RequestBody::RemoveNoGo { number });
        assert_eq!(gone, numbers);
    }

    #[test]
    fn half_a_body_takes_nothing_away() {
        let home = home();
        let frame = Frame::around(&home).expect("a frame");
        for wrong in [
            json!({}),
            json!({"virtualWalls": []}),
            json!({"virtualWalls": [], "restrictedZones": [{"points": {}, "type": "regular"}]}),
            json!({"virtualWalls": [], "restrictedZones": [{"points": {}, "type": "mop"}]}),
            json!({"virtualWalls": [{"points": {"pA": {"x": 1, "y": 1}, "pB": {"x": 1}}}], "restrictedZones": []}),
        ] {
            assert!(restriction_changes(&home, frame, &wrong).is_err(), "{wrong}");
        }
    }
}
