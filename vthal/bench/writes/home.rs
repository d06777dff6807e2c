//! What people say of the home: virtual walls and names of rooms, each change a new version of the map.

use brain::{Cell, CellKnowledge, Raster, StoredMap};
use rvac_api::{NoGoShape, RequestBody, Topic, Update};

use crate::store::{Change, Desk, Kept, Store, replaced};

/// Virtual walls at a time.
const WALLS_MAX: usize = 6;

pub(crate) struct Home;

impl Home {
    /// A room of 4 by 3 metres with the dock in it.
    pub(crate) fn first_version() -> Vec<u8> {
        let floor = Raster::filled(Cell { x: -40, y: -40 }, 160, 120, CellKnowledge::Free);
        StoredMap::from_raster(&floor, Some(brain::Pose2::IDENTITY)).encode()
    }
}

impl Store for Home {
    fn name(&self) -> &'static str {
        "maps"
    }

    /// The robot stands on its dock, so that the daemon takes the map up.
    fn get_ready(&self, desk: &mut Desk) -> anyhow::Result<()> {
        desk.wait("that it takes up the map", |update| match update {
            Update::Log(entry) if entry.text.contains("takes up the map of the home that was kept") => {
                Some(())
            }
            _ => None,
        })
    }

    fn read(&self, desk: &mut Desk) -> anyhow::Result<Kept> {
        desk.look_at(Topic::Home)?;
        let home = desk.wait("the home", |update| match update {
            Update::Home(home) => Some(home),
            _ => None,
        })?;
        home.no_go
            .iter()
            .map(|view| Ok((view.number.to_string(), serde_json::to_string(&view.shape)?)))
            .collect()
    }

    fn change(&self, kept: &Kept, number: u64) -> Change {
        let oldest = kept.keys().filter_map(|key| key.parse::<u16>().ok()).min();
        match oldest {
            Some(of) if kept.len() >= WALLS_MAX || number.is_multiple_of(3) => Change {
                after: replaced(kept, Some(&of.to_string()), None),
                request: RequestBody::RemoveNoGo { number: of },
            },
            _ => {
                let shape = wall(number);
                Change {
                    after: replaced(kept, None, serde_json::to_string(&shape).ok()),
                    request: RequestBody::AddNoGo { shape },
                }
            }
        }
    }
}

/// A short wall at a place that tells it from others, clear of the dock. Half and quarter metres are told without rounding.
fn wall(number: u64) -> NoGoShape {
    let step = |steps: u64| f64::from(u32::try_from(steps).unwrap_or(0)) * 0.125;
    let (x_m, y_m) = (0.75 + step(number % 13), -0.75 + step(number / 13 % 9));
    NoGoShape::Wall([[x_m, y_m], [x_m, y_m + 0.25 + step(number / 117 % 4)]])
}
