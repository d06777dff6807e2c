//! What people change in a home from day to day.
//!
//! A home is the TOML of its file, or of the generator: a change edits that text, so both kinds of home change alike. A day on which
//! the dock or most of the floor could not be reached is drawn again.

mod draw;
mod furniture;
mod people;
mod rug;
mod shape;

use std::collections::BTreeSet;

use anyhow::Context;
use home::{Home, Pcg, RobotModel};
use serde::Serialize;
use toml::{Table, Value};

use draw::Draw;

/// Day on which the sofa is moved for good, and day on which a rug is laid.
const SOFA_DAY: u32 = 10;
const RUG_DAY: u32 = 15;
/// One day in so many has a shut door.
const DOOR_DAYS: u32 = 3;
/// Draws of a day before it stays as it was.
const ATTEMPTS: u32 = 20;
/// Share of the floor where the body fits that must hang together, unless a door is shut.
const CONNECTED_MIN: f64 = 0.9;
/// A shut door leaves at least this share of the floor.
const LEFT_MIN: f64 = 0.5;
/// Streams of random numbers, each for all days.
const SOFA_STREAM: u64 = 101;
const RUG_STREAM: u64 = 102;
const DAY_STREAM: u64 = 1_000;

/// A thing that people do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum HomeChange {
    /// Chairs, boxes and toys stand 0.1 to 1 m from their places, elsewhere each day from the second on.
    Chairs,
    /// A door is shut on one day in three.
    Doors,
    /// The sofa stands 0.2 to 1 m beside its place from day 10 on.
    Sofa,
    /// A rug lies on the floor from day 15 on.
    Rug,
    /// People stand in the robot's path, people and a pet walk, from the second day on.
    People,
}

/// A home, and what people do in it.
#[derive(Clone, Debug)]
pub struct ChangingHome {
    name: String,
    plan: Table,
    changes: BTreeSet<HomeChange>,
}

impl ChangingHome {
    /// From the text of a home TOML.
    ///
    /// # Errors
    /// When the text is no TOML.
    pub fn new(name: &str, text: &str, changes: &BTreeSet<HomeChange>) -> anyhow::Result<Self> {
        let plan = text
            .parse()
            .with_context(|| format!("`{name}` is no home .toml, and only these change"))?;
        Ok(Self {
            name: name.to_owned(),
            plan,
            changes: changes.clone(),
        })
    }

    /// The home on a day, counted from 1.
    ///
    /// # Errors
    /// When the home cannot be read.
    pub fn on_day(&self, day: u32, seed: u64, model: &RobotModel) -> anyhow::Result<Home> {
        let read = |plan: &Table| Home::from_floorplan(&self.name, &plan.to_string(), model);
        let lasting = self.lasting(day, seed, read);
        let whole = read(&lasting)?;
        for attempt in 0..ATTEMPTS {
            let stream = DAY_STREAM + u64::from(day) * u64::from(ATTEMPTS) + u64::from(attempt);
            let mut draw = Draw(Pcg::new(seed, stream));
            let (today, shuts) = self.passing(&lasting, day, &mut draw);
            if let Ok(home) = read(&today)
                && is_good(&home, &whole, shuts)
            {
                return Ok(home);
            }
        }
        Ok(whole)
    }

    /// With what was changed for good up to a day.
    fn lasting<E>(&self, day: u32, seed: u64, read: impl Fn(&Table) -> Result<Home, E>) -> Table {
        let is_whole = |plan: &Table| read(plan).is_ok_and(|home| home.connected_share() >= CONNECTED_MIN);
        let mut plan = self.plan.clone();
        if day >= SOFA_DAY && self.changes.contains(&HomeChange::Sofa) {
            let mut draw = Draw(Pcg::new(seed, SOFA_STREAM));
            furniture::move_sofa(&mut plan, &mut draw, is_whole);
        }
        if day >= RUG_DAY && self.changes.contains(&HomeChange::Rug) {
            rug::lay(&mut plan, &mut Draw(Pcg::new(seed, RUG_STREAM)));
        }
        plan
    }

    /// With what is so on this day only; whether a door is shut.
    fn passing(&self, lasting: &Table, day: u32, draw: &mut Draw) -> (Table, Doors) {
        let mut plan = lasting.clone();
        let mut doors = Doors::AsInFile;
        if day > 1 {
            if self.changes.contains(&HomeChange::Chairs) {
                furniture::move_chairs(&mut plan, draw);
            }
            if self.changes.contains(&HomeChange::Doors) && day.is_multiple_of(DOOR_DAYS) {
                doors = shut_a_door(&mut plan, draw);
            }
            if self.changes.contains(&HomeChange::People) {
                people::invite(&mut plan, draw);
            }
        }
        (plan, doors)
    }
}

/// The doors of a day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Doors {
    AsInFile,
    OneShut,
}

fn is_good(today: &Home, whole: &Home, doors: Doors) -> bool {
    let is_large_enough = today.reachable_area_m2() >= LEFT_MIN * whole.reachable_area_m2();
    match doors {
        Doors::AsInFile => today.connected_share() >= CONNECTED_MIN && is_large_enough,
        Doors::OneShut => is_large_enough,
    }
}

fn shut_a_door(plan: &mut Table, draw: &mut Draw) -> Doors {
    let open = |door: &&mut Value| {
        door.get("state")
            .is_none_or(|state| state.as_str() == Some("open"))
    };
    let doors = plan.get_mut("door").and_then(Value::as_array_mut);
    let mut doors: Vec<&mut Value> = doors.into_iter().flatten().filter(open).collect();
    let index = draw.below(doors.len());
    let Some(door) = doors.get_mut(index).and_then(|door| door.as_table_mut()) else {
        return Doors::AsInFile;
    };
    door.insert("state".to_owned(), "closed".into());
    door.remove("schedule");
    Doors::OneShut
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::{ChangingHome, HomeChange};
    use home::generate::GeneratedHome;
    use home::{Home, RobotModel};

    const ALL: [HomeChange; 5] = [
        HomeChange::Chairs,
        HomeChange::Doors,
        HomeChange::Sofa,
        HomeChange::Rug,
        HomeChange::People,
    ];

    fn model() -> RobotModel {
        RobotModel::by_name("sr8730").unwrap()
    }

    fn flat(changes: &[HomeChange]) -> ChangingHome {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../homes/two-room-flat.toml");
        let text = std::fs::read_to_string(path).unwrap();
        ChangingHome::new("flat", &text, &BTreeSet::from_iter(changes.iter().copied())).unwrap()
    }

    fn different_cells(one: &Home, other: &Home) -> usize {
        let pairs = one.grid().cells.iter().zip(&other.grid().cells);
        pairs.filter(|(one, other)| one != other).count()
    }

    #[test]
    fn without_changes_every_day_is_like_the_first() {
        let home = flat(&[]);
        let first = home.on_day(1, 7, &model()).unwrap();
        for day in [2, 3, 10, 15, 30] {
            assert_eq!(
                different_cells(&first, &home.on_day(day, 7, &model()).unwrap()),
                0
            );
        }
    }

    #[test]
    fn chairs_are_elsewhere_each_day_and_the_same_for_the_same_seed() {
        let home = flat(&[HomeChange::Chairs]);
        let day = |day, seed| home.on_day(day, seed, &model()).unwrap();
        assert_eq!(
            different_cells(&day(1, 7), &flat(&[]).on_day(1, 7, &model()).unwrap()),
            0
        );
        assert!(different_cells(&day(1, 7), &day(2, 7)) > 0);
        assert!(different_cells(&day(2, 7), &day(3, 7)) > 0);
        assert!(different_cells(&day(2, 7), &day(2, 8)) > 0);
        assert_eq!(different_cells(&day(2, 7), &day(2, 7)), 0);
    }

    #[test]
    fn a_sofa_moves_for_good_and_a_rug_stays() {
        for (change, first_day) in [(HomeChange::Sofa, 10), (HomeChange::Rug, 15)] {
            let home = flat(&[change]);
            let day = |day| home.on_day(day, 7, &model()).unwrap();
            assert_eq!(different_cells(&day(1), &day(first_day - 1)), 0, "{change:?}");
            assert!(different_cells(&day(1), &day(first_day)) > 100, "{change:?}");
            assert_eq!(different_cells(&day(first_day), &day(30)), 0, "{change:?}");
        }
    }

    #[test]
    fn a_door_is_shut_on_some_days_and_the_rest_can_be_reached() {
        let home = flat(&[HomeChange::Doors]);
        let reachable_m2 = |day| home.on_day(day, 7, &model()).unwrap().reachable_area_m2();
        let shut: Vec<u32> = (1..=9)
            .filter(|day| reachable_m2(*day) < 0.8 * reachable_m2(1))
            .collect();
        assert_eq!(shut, [3, 6, 9]);
    }

    #[test]
    fn generated_homes_change_and_stay_whole() {
        for number in [1, 3] {
            let text = GeneratedHome::number(number).floorplan(&model()).unwrap();
            let home = ChangingHome::new("generated", &text, &BTreeSet::from(ALL)).unwrap();
            let first = home.on_day(1, 1, &model()).unwrap();
            for day in [2, 9, 16] {
                let today = home.on_day(day, 1, &model()).unwrap();
                assert!(different_cells(&first, &today) > 0, "home {number}, day {day}");
                assert!(today.reachable_area_m2() > 0.5 * first.reachable_area_m2());
            }
        }
    }
}
