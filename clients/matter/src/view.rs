//! The robot as Matter sees it.

use bridge::Knowledge;
use rvac_api::{Activity, BatteryReading, FloorView, RoomView, Status, Trouble, explain};

use crate::progress::RoomProgress;
use crate::text::{DETAILS_BYTES_MAX, NAME_BYTES_MAX, cut};

/// `OperationalState` of a robot that charges; our states know no difference between it and one that has charged.
pub(crate) const CHARGING: u8 = 0x41;
/// `OperationalState` of a robot that waits for a person.
pub(crate) const ERROR: u8 = 0x03;
/// `OperationalState` of a robot that works.
pub(crate) const RUNNING: u8 = 0x01;
/// `OperationalState` of a robot whose job waits.
pub(crate) const PAUSED: u8 = 0x02;
/// As a robot describes itself.
const BEEPER: &str = "beeper";
/// Below these shares of a full pack its level is a warning, and critical.
const LOW: f64 = 0.2;
const CRITICAL: f64 = 0.1;

/// What all attributes stand on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct View {
    /// A cleaning job is there, be it that it waits or charges in between.
    pub(crate) cleans: bool,
    /// `OperationalState`.
    pub(crate) state: u8,
    /// What a person must help with; there is one if and only if the state is [`ERROR`].
    pub(crate) fault: Option<Fault>,
    pub(crate) battery: Option<Battery>,
    /// Rooms by their identities.
    pub(crate) areas: Vec<Area>,
    /// The floor that the rooms are on.
    pub(crate) map: Option<Area>,
    /// The room in which it works.
    pub(crate) here: Option<u16>,
    /// The rooms of the running or last job.
    pub(crate) progress: Vec<RoomProgress>,
    /// It can be heard when it is looked for.
    pub(crate) beeps: bool,
}

/// What a person must help with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    /// `ErrorStateID`.
    pub(crate) id: u8,
    pub(crate) details: String,
}

/// Something that has a number and a name: a room or a floor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) id: u16,
    pub(crate) name: String,
}

/// How full the pack is, and what becomes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Battery {
    /// 0 to 200.
    pub(crate) half_percent: u8,
    pub(crate) level: Level,
    pub(crate) flow: Flow,
    /// Something is the matter with the pack itself.
    pub(crate) is_faulty: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    Good,
    Warning,
    Critical,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    Charging,
    Full,
    None,
}

impl View {
    /// Of what is known. A daemon that is away is a robot that does not answer.
    pub(crate) fn of(known: &Knowledge) -> Self {
        let away = Status {
            state: Activity::Disconnected.name().to_owned(),
            reason: "no-daemon".to_owned(),
            ..Status::default()
        };
        let status = known.status.as_ref().unwrap_or(&away);
        let activity = Activity::from_name(&status.state);
        let reading = known.device.as_ref().and_then(|device| device.battery.as_ref());
        let battery = reading.map(Battery::of);
        let charges = activity == Some(Activity::Docked)
            && battery.is_some_and(|battery| battery.flow == Flow::Charging);
        // A state that is newer than this program is none that needs help.
        let stopped = Activity::Idle.words().matter_state;
        let state = activity.map_or(stopped, |activity| activity.words().matter_state);
        let rooms = known.home.iter().flat_map(|home| &home.rooms);
        let areas: Vec<Area> = rooms.map(Area::of_room).collect();
        let robot = known.robot.as_ref();
        let sweeps = matches!(activity, Some(Activity::Cleaning | Activity::Spot));
        let here = status.room.as_ref().map(|room| room.id).filter(|_| sweeps);
        Self {
            cleans: sweeps || status.strategy.is_some(),
            state: if charges { CHARGING } else { state },
            fault: (state == ERROR).then(|| Fault::of(status)),
            battery,
            map: floor(known),
            here: here.filter(|here| areas.iter().any(|area| area.id == *here)),
            areas,
            progress: Vec::new(),
            beeps: robot.is_some_and(|robot| robot.parts.iter().any(|part| part == BEEPER)),
        }
    }

    pub(crate) fn has_area(&self, id: u16) -> bool {
        self.areas.iter().any(|area| area.id == id)
    }
}

impl Fault {
    fn of(status: &Status) -> Self {
        let (code, trouble) = Trouble::of_status(status).unwrap_or((&status.reason, Trouble::Electronics));
        let text = explain(code).map_or(code, |told| told.cause);
        Self {
            id: trouble.words().matter_error,
            details: cut(text, DETAILS_BYTES_MAX),
        }
    }
}

impl Area {
    fn of_room(room: &RoomView) -> Self {
        let name = room.name.clone().unwrap_or_else(|| format!("Room {}", room.id));
        Self {
            id: room.id,
            name: cut(&name, NAME_BYTES_MAX),
        }
    }

    fn of_floor(floor: &FloorView) -> Self {
        Self {
            id: floor.number,
            name: cut(&floor.title(), DETAILS_BYTES_MAX),
        }
    }
}

/// The floor on which the robot is; the only one there is, if nobody has said.
fn floor(known: &Knowledge) -> Option<Area> {
    let floors = known.floors.as_ref()?;
    let there_are = || floors.floors.iter().filter(|floor| !floor.removed);
    let here = there_are().find(|floor| Some(floor.number) == floors.here);
    let only = there_are().next().filter(|_| there_are().count() == 1);
    here.or(only).map(Area::of_floor)
}

impl Battery {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is held within a range before, and NaN becomes 0"
    )]
    fn of(reading: &BatteryReading) -> Self {
        Self {
            half_percent: (reading.charge * 200.0).round().clamp(0.0, 200.0) as u8,
            level: match reading.charge {
                charge if charge < CRITICAL => Level::Critical,
                charge if charge < LOW => Level::Warning,
                _ => Level::Good,
            },
            flow: match reading.state.as_str() {
                "charging" => Flow::Charging,
                "full" => Flow::Full,
                _ => Flow::None,
            },
            is_faulty: reading.state == "fault",
        }
    }
}

#[cfg(test)]
mod tests {
    use bridge::Knowledge;
    use rvac_api::{
        Activity, BatteryReading, DeviceTable, HomeView, RoomHere, RoomView, Status, Update, explanations,
    };

    use super::{Area, ERROR, Flow, Level, View};

    fn known(state: &str, reason: &str) -> Knowledge {
        let mut known = Knowledge::default();
        known.take(&Update::Status(Status {
            state: state.to_owned(),
            reason: reason.to_owned(),
            ..Status::default()
        }));
        known
    }

    fn charge(known: &mut Knowledge, charge: f64, state: &str) {
        known.take(&Update::Device(DeviceTable {
            battery: Some(BatteryReading {
                charge,
                voltage_v: 14.0,
                current_a: 1.0,
                temperature_c: None,
                state: state.to_owned(),
                charger: None,
            }),
            ..DeviceTable::default()
        }));
    }

    #[test]
    fn whatever_the_state_and_its_reason_there_is_an_error_if_and_only_if_the_state_is_one() {
        let of_tomorrow = [("of-tomorrow", "")];
        let codes = || explanations().map(|(code, _)| code).chain(["of-tomorrow"]);
        for activity in Activity::ALL {
            for code in codes() {
                let view = View::of(&known(activity.name(), code));
                assert_eq!(view.fault.is_some(), view.state == ERROR, "{activity:?} {code}");
                let fits = |fault: &super::Fault| fault.id != 0 && fault.details.len() <= 64;
                assert!(view.fault.as_ref().is_none_or(fits), "{activity:?} {code}");
            }
        }
        for (state, reason) in of_tomorrow {
            assert_eq!(View::of(&known(state, reason)).state, 0);
        }
    }

    #[test]
    fn a_daemon_that_is_away_is_an_error() {
        let fault = View::of(&Knowledge::default()).fault.expect("an error");
        assert_eq!(fault.id, 0x02);
        let stuck = View::of(&known("stuck", "slip")).fault.expect("an error");
        assert_eq!(stuck.id, 0x41);
    }

    #[test]
    fn a_job_that_waits_or_charges_in_between_is_still_a_job() {
        let with_job = |state: &str, strategy: Option<&str>| {
            let mut known = Knowledge::default();
            known.take(&Update::Status(Status {
                state: state.to_owned(),
                strategy: strategy.map(str::to_owned),
                ..Status::default()
            }));
            View::of(&known).cleans
        };
        for state in ["cleaning", "paused", "docking", "docked", "stuck"] {
            assert!(with_job(state, Some("systematic")), "{state}");
        }
        for state in ["idle", "docking", "docked", "manual"] {
            assert!(!with_job(state, None), "{state}");
        }
        assert!(with_job("spot", None));
    }

    #[test]
    fn a_docked_robot_charges_or_has_charged() {
        let mut docked = known("docked", "docked");
        charge(&mut docked, 0.15, "charging");
        let view = View::of(&docked);
        let battery = view.battery.expect("a battery");
        assert_eq!((view.state, battery.half_percent), (0x41, 30));
        assert_eq!((battery.level, battery.flow), (Level::Warning, Flow::Charging));
        charge(&mut docked, f64::NAN, "full");
        let view = View::of(&docked);
        assert_eq!(
            (view.state, view.battery.expect("a battery").half_percent),
            (0x42, 0)
        );
    }

    #[test]
    fn rooms_are_areas_and_the_robot_is_in_one_of_them_while_it_works() {
        let mut known = known("cleaning", "command");
        let room = |id, name: Option<&str>| RoomView {
            id,
            area_m2: 9.0,
            x: 0.0,
            y: 0.0,
            name: name.map(str::to_owned),
            settings: None,
        };
        known.take(&Update::Home(HomeView {
            rooms: vec![room(1, Some("Kitchen")), room(4, None)],
            ..HomeView::default()
        }));
        let view = View::of(&known);
        let area = |id, name: &str| Area {
            id,
            name: name.to_owned(),
        };
        assert_eq!(view.areas, [area(1, "Kitchen"), area(4, "Room 4")]);
        let mut at = |state: &str, id| {
            known.take(&Update::Status(Status {
                state: state.to_owned(),
                room: Some(RoomHere { id, name: None }),
                ..Status::default()
            }));
            View::of(&known).here
        };
        assert_eq!(
            [at("cleaning", 4), at("cleaning", 9), at("docking", 4)],
            [Some(4), None, None]
        );
    }
}
