//! How rooms are cleaned: what people say of it, and how hard brushes and suction run where the robot is.

use brain::{BehaviorState, Command, Reason, RoomPower};
use rvac_api::{CleaningPower, RoomSettings};
use rvac_units::Throttle;

use super::Core;
use super::orders::Asker;
use super::refusal::Refusal;
use crate::Outputs;
use crate::device::CleanerPower;

impl Core {
    pub(super) fn set_room(
        &mut self,
        now_us: u64,
        (asker, (room, settings)): (Asker, (u16, Option<RoomSettings>)),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let settings = settings.map(to_brain).transpose()?;
        let brain = self.known_home()?.brain();
        let command = Command::SetRoom { room, settings };
        brain.admit(&command).map_err(|reason| match reason {
            Reason::NoSuchRoom => Refusal::no_such_room(room, brain),
            _ => Refusal::from(reason),
        })?;
        self.edit(now_us, (asker, command, "says how a room is cleaned"), outputs);
        Ok(())
    }

    /// A person who drives says how hard brushes and suction run; in a job the room does in which the robot is, and where it
    /// has no settings they run as hard as they can.
    pub(super) fn cleaner_power(&self) -> CleanerPower {
        let Some(mind) = &self.mind else {
            return CleanerPower::FULL;
        };
        let brain = mind.brain();
        if brain.status().state == BehaviorState::Manual {
            return self.driver_power;
        }
        let words = brain.map().annotations();
        let settings = brain.room().and_then(|room| words.settings(room));
        settings.map_or(CleanerPower::FULL, |settings| in_room(settings.power()))
    }
}

fn in_room(power: RoomPower) -> CleanerPower {
    let throttle = |percent: u8| Throttle::saturating_from_millionths(10_000 * i32::from(percent));
    CleanerPower {
        brush_main: throttle(power.main_brush),
        brush_sides: throttle(power.side_brushes),
        vacuum: throttle(power.suction),
    }
}

fn to_brain(settings: RoomSettings) -> Result<brain::RoomSettings, Refusal> {
    let CleaningPower {
        suction,
        main_brush,
        side_brushes,
    } = settings.power;
    // NaN becomes 0, and what is too much stays too much.
    let percent = |share: f64| (100.0 * share).round().clamp(0.0, 255.0) as u8;
    let is_share = |share: &f64| (0.0..=1.0).contains(share);
    let power = RoomPower {
        suction: percent(suction),
        main_brush: percent(main_brush),
        side_brushes: percent(side_brushes),
    };
    let wrong = || {
        let text = format!(
            "{} passes with suction {suction}, main brush {main_brush} and side brushes {side_brushes} cannot be: 1 to 3 \
             passes, each share from 0 to 1, and one of them above 0.",
            settings.passes
        );
        Refusal::because(Reason::BadSettings, text)
    };
    if ![suction, main_brush, side_brushes].iter().all(is_share) {
        return Err(wrong());
    }
    brain::RoomSettings::new(settings.passes, power).map_err(|_| wrong())
}

/// As clients are told of it.
pub(crate) fn to_api(settings: &brain::RoomSettings) -> RoomSettings {
    let share = |percent: u8| f64::from(percent) / 100.0;
    let power = settings.power();
    RoomSettings {
        passes: settings.passes(),
        power: CleaningPower {
            suction: share(power.suction),
            main_brush: share(power.main_brush),
            side_brushes: share(power.side_brushes),
        },
    }
}
