//! Virtual walls and the place of the dock, each change of them a new version of the map.

use brain::{Cell, CellKnowledge, Raster, StoredMap};
use rvac_api::{HomeView, NoGoShape, RequestBody, Topic, Update};

use crate::life::{Kept, replaced};
use crate::store::{Change, Desk, Store};

/// Where the pose of the dock is kept among the walls' numbers.
const DOCK: &str = "dock";
/// Virtual walls at a time.
const WALLS_MAX: usize = 6;

pub(crate) struct Home;

/// A room of 4 by 3 metres with the dock in it.
pub(crate) fn first_version() -> Vec<u8> {
    let floor = Raster::filled(Cell { x: -40, y: -40 }, 160, 120, CellKnowledge::Free);
    vthal_core::stored_map::encode(&StoredMap::from_raster(&floor, Some(brain::Pose2::IDENTITY)))
}

/// Waits until the daemon has taken the map up: the robot stands on its dock.
pub(crate) fn is_taken_up(desk: &mut Desk) -> anyhow::Result<()> {
    desk.wait("that it takes up the map", |update| match update {
        Update::Log(entry) if entry.text.contains("takes up the map of the home that was kept") => Some(()),
        _ => None,
    })
}

/// The home as it is now.
pub(crate) fn look_at(desk: &mut Desk) -> anyhow::Result<HomeView> {
    desk.look_at(Topic::Home)?;
    desk.wait("the home", |update| match update {
        Update::Home(home) => Some(home),
        _ => None,
    })
}

impl Store for Home {
    fn name(&self) -> &'static str {
        "maps"
    }

    fn get_ready(&self, desk: &mut Desk) -> anyhow::Result<()> {
        is_taken_up(desk)
    }

    fn read(&self, desk: &mut Desk) -> anyhow::Result<Kept> {
        let home = look_at(desk)?;
        let dock = home.dock.map(|dock| [dock.x, dock.y, dock.heading]);
        let dock = dock.map(|pose| Ok((DOCK.to_owned(), serde_json::to_string(&pose)?)));
        let walls = home.no_go.into_iter();
        walls
            .map(|view| Ok((view.number.to_string(), serde_json::to_string(&view.shape)?)))
            .chain(dock)
            .collect()
    }

    fn change(&self, kept: &Kept, number: u64) -> Change {
        if number.is_multiple_of(4) {
            return dock_moved(kept, number);
        }
        let oldest = kept.keys().filter_map(|key| key.parse::<u16>().ok()).min();
        match oldest {
            Some(of) if kept.len() > WALLS_MAX || number.is_multiple_of(3) => Change {
                after: replaced(kept, Some(&of.to_string()), None),
                request: RequestBody::RemoveNoGo { number: of },
            },
            _ => {
                let shape = wall(number);
                Change {
                    after: replaced(kept, None, serde_json::to_string(&shape).ok()),
                    request: RequestBody::AddNoGo { shape, name: None },
                }
            }
        }
    }
}

/// The dock at a place that tells it from others, beside all walls. Quarters are told without rounding.
fn dock_moved(kept: &Kept, number: u64) -> Change {
    let quarters = |steps: u64| f64::from(u32::try_from(steps).unwrap_or(0)) * 0.25;
    let [x, y, heading] = [
        quarters(number % 4) - 0.75,
        quarters(number / 4 % 5) - 0.5,
        quarters(number / 20 % 7),
    ];
    Change {
        after: replaced(kept, Some(DOCK), serde_json::to_string(&[x, y, heading]).ok()),
        request: RequestBody::MoveDock { x, y, heading },
    }
}

/// A short wall at a place that tells it from others, clear of the dock. Half and quarter metres are told without rounding.
fn wall(number: u64) -> NoGoShape {
    let step = |steps: u64| f64::from(u32::try_from(steps).unwrap_or(0)) * 0.125;
    let (x_m, y_m) = (0.75 + step(number % 13), -0.75 + step(number / 13 % 9));
    NoGoShape::Wall([[x_m, y_m], [x_m, y_m + 0.25 + step(number / 117 % 4)]])
}
