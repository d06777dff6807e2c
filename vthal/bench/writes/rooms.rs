//! What people say of rooms: names, and how each is cleaned.

use rvac_api::{CleaningPattern, CleaningPower, RequestBody, RoomNaming, RoomSettings, RoomView};

use crate::home;
use crate::life::{Kept, replaced};
use crate::store::{Change, Desk, Store};

pub(crate) struct Rooms;

impl Store for Rooms {
    fn name(&self) -> &'static str {
        "rooms"
    }

    fn get_ready(&self, desk: &mut Desk) -> anyhow::Result<()> {
        home::is_taken_up(desk)
    }

    fn read(&self, desk: &mut Desk) -> anyhow::Result<Kept> {
        let rooms = home::look_at(desk)?.rooms;
        rooms.iter().flat_map(told).collect()
    }

    fn change(&self, kept: &Kept, number: u64) -> Change {
        let room = kept
            .keys()
            .find_map(|key| key.strip_prefix(NAME)?.parse().ok())
            .unwrap_or(0);
        if number.is_multiple_of(2) {
            let name = Some(format!("Room {number}")).filter(|_| !number.is_multiple_of(8));
            return Change {
                after: replaced(
                    kept,
                    Some(&format!("{NAME}{room}")),
                    name_text(name.as_deref()).ok(),
                ),
                request: RequestBody::NameRoom(RoomNaming { room, name }),
            };
        }
        let settings = (!number.is_multiple_of(7)).then(|| settings(number));
        Change {
            after: replaced(
                kept,
                Some(&format!("{SETTINGS}{room}")),
                serde_json::to_string(&settings).ok(),
            ),
            request: RequestBody::SetRoom {
                room,
                settings,
                was: None,
            },
        }
    }
}

const NAME: &str = "name of ";
const SETTINGS: &str = "settings of ";

fn told(room: &RoomView) -> [anyhow::Result<(String, String)>; 2] {
    let name = name_text(room.name.as_deref());
    let settings = serde_json::to_string(&room.settings);
    [
        name.map(|name| (format!("{NAME}{}", room.id), name)),
        settings
            .map(|settings| (format!("{SETTINGS}{}", room.id), settings))
            .map_err(Into::into),
    ]
}

fn name_text(name: Option<&str>) -> anyhow::Result<String> {
    Ok(serde_json::to_string(&name)?)
}

fn settings(number: u64) -> RoomSettings {
    // Quarters are whole percents, and told without rounding.
    let power = |number: u64| f64::from(u32::try_from(number % 5).unwrap_or(0)) / 4.0;
    RoomSettings {
        passes: u8::try_from(1 + number % 3).unwrap_or(1),
        power: CleaningPower {
            suction: power(number),
            main_brush: power(number / 2),
            side_brushes: power(number / 3),
        },
        pattern: CleaningPattern::ALL[usize::from(number.is_multiple_of(2))],
    }
}
