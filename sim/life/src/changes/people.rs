//! People and a pet, as in generated homes.

use toml::{Table, Value};

use super::draw::Draw;
use super::shape::{Point, contains, point, points, tables, written};

/// People who stand in the robot's path one after another.
const VISITORS: u32 = 8;
/// Who walks.
const WALKERS: [&str; 3] = ["person", "person", "pet"];
/// Goals of a walk.
const GOALS: usize = 4;
const ATTEMPTS: u32 = 100;

/// Adds them to the home.
pub(super) fn invite(plan: &mut Table, draw: &mut Draw) {
    let floor = Floor::of(plan);
    let doors: Vec<Point> = tables(plan, "door").filter_map(middle).collect();
    let mut now_s = 60.0;
    for _ in 0..VISITORS {
        let place = if draw.is_lucky(0.5) {
            draw.pick(&doors)
        } else {
            floor.place(draw)
        };
        let (stays_s, diameter_m) = if draw.is_lucky(0.5) {
            (draw.between(30.0, 120.0), 0.34)
        } else {
            (draw.between(60.0, 300.0), 0.26)
        };
        if let Some([x, y]) = place {
            let mut visitor = Table::new();
            visitor.insert("position".to_owned(), Value::Array(vec![x.into(), y.into()]));
            visitor.insert("diameter-m".to_owned(), diameter_m.into());
            visitor.insert("from-s".to_owned(), now_s.into());
            visitor.insert("until-s".to_owned(), (now_s + stays_s).into());
            add(plan, "visitor", visitor);
        }
        now_s += draw.between(60.0, 400.0);
    }
    for kind in WALKERS {
        let goals: Vec<Point> = (0..GOALS).filter_map(|_| floor.place(draw)).collect();
        let from_s = draw.between(20.0, 300.0);
        if goals.len() == GOALS {
            let mut walker = Table::new();
            walker.insert("kind".to_owned(), kind.into());
            walker.insert("goals".to_owned(), written(&goals));
            walker.insert("rest-s".to_owned(), draw.between(3.0, 40.0).into());
            walker.insert("from-s".to_owned(), from_s.into());
            walker.insert(
                "until-s".to_owned(),
                (from_s + draw.between(900.0, 3_600.0)).into(),
            );
            add(plan, "walker", walker);
        }
    }
}

fn add(plan: &mut Table, kind: &str, table: Table) {
    let all = plan.entry(kind).or_insert_with(|| Value::Array(Vec::new()));
    if let Some(all) = all.as_array_mut() {
        all.push(Value::Table(table));
    }
}

/// Middle of an open door.
fn middle(door: &Table) -> Option<Point> {
    let is_open = door
        .get("state")
        .is_none_or(|state| state.as_str() == Some("open"));
    let (from, to) = (point(door.get("from")?)?, point(door.get("to")?)?);
    is_open.then_some([0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])])
}

/// Where somebody can stand.
struct Floor {
    rooms: Vec<Vec<Point>>,
    solid: Vec<Vec<Point>>,
}

impl Floor {
    fn of(plan: &Table) -> Self {
        let polygons = |kind| tables(plan, kind).map(|table| points(table, "polygon")).collect();
        Self {
            rooms: polygons("room"),
            solid: polygons("furniture"),
        }
    }

    fn place(&self, draw: &mut Draw) -> Option<Point> {
        (0..ATTEMPTS).find_map(|_| {
            let room = self.rooms.get(draw.below(self.rooms.len()))?;
            let low = |axis: usize| room.iter().map(|at| at[axis]).fold(f64::INFINITY, f64::min);
            let high = |axis: usize| room.iter().map(|at| at[axis]).fold(f64::NEG_INFINITY, f64::max);
            let at = [draw.between(low(0), high(0)), draw.between(low(1), high(1))];
            let is_free = contains(room, at) && !self.solid.iter().any(|solid| contains(solid, at));
            is_free.then_some(at)
        })
    }
}
