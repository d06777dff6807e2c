//! How rooms are cleaned: what people say of it, and how hard brushes and suction run where the robot is.

use brain::{BehaviorState, Brain, EditError, Pattern, RoomPower};
use rvac_api::{CleaningPattern, CleaningPower, RoomSettings};
use rvac_units::Throttle;

use crate::api_forms;
use crate::device::CleanerPower;
use crate::refusal::Refusal;

/// A person who drives says how hard brushes and suction run; in a job the job does or the room in which the robot is, and
/// where neither says anything they run as hard as they can.
pub(crate) fn cleaner_power(brain: &Brain, of_driver: CleanerPower) -> CleanerPower {
    if brain.status().state == BehaviorState::Manual {
        return of_driver;
    }
    in_room(brain.power_here())
}

fn in_room(power: RoomPower) -> CleanerPower {
    let throttle = |percent: u8| Throttle::saturating_from_millionths(10_000 * i32::from(percent));
    CleanerPower {
        brush_main: throttle(power.main_brush),
        brush_sides: throttle(power.side_brushes),
        vacuum: throttle(power.suction),
    }
}

pub(crate) fn to_brain(settings: RoomSettings) -> Result<brain::RoomSettings, Refusal> {
    let power = to_power(&settings.power)?;
    let known = brain::RoomSettings::new(settings.passes, power).map_err(|reason| {
        let text = format!(
            "{} passes cannot be: a room is cleaned 1 to 3 times.",
            settings.passes
        );
        Refusal::because(reason, text)
    })?;
    Ok(known.with_pattern(to_pattern(settings.pattern)))
}

/// Shares as whole percent.
pub(crate) fn to_power(power: &CleaningPower) -> Result<RoomPower, Refusal> {
    let CleaningPower {
        suction,
        main_brush,
        side_brushes,
    } = *power;
    let shares = [suction, main_brush, side_brushes];
    let is_share = |share: &f64| (0.0..=1.0).contains(share);
    if !shares.iter().all(is_share) || shares.iter().all(|share| percent(*share) == 0) {
        let text = format!(
            "Suction {suction}, main brush {main_brush} and side brushes {side_brushes} cannot be: each share is from 0 to 1, \
             and one of them above 0."
        );
        return Err(Refusal::because(EditError::BadSettings, text));
    }
    Ok(RoomPower {
        suction: percent(suction),
        main_brush: percent(main_brush),
        side_brushes: percent(side_brushes),
    })
}

fn percent(share: f64) -> u8 {
    (100.0 * share).round().clamp(0.0, 100.0) as u8
}

pub(crate) const fn to_pattern(pattern: CleaningPattern) -> Pattern {
    match pattern {
        CleaningPattern::Lines => Pattern::Lines,
        CleaningPattern::Contour => Pattern::Contour,
    }
}

/// As clients receive it.
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
        pattern: api_forms::pattern(settings.pattern()),
    }
}
