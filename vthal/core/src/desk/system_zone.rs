//! The time zone of the system: schedules that have none of their own follow it, and people read what becomes of it.

use rvac_api::LogLevel;

use super::audience::Teller;
use super::journal::LogSource;
use super::readiness::Readiness;
use super::schedules::ScheduleDesk;
use crate::schedule::{Zone, ZoneReading};

/// Name of the line that says from which zone to which.
const CHANGED: &str = "zone-changed";
/// Of the line that says why there is none.
const UNKNOWN: &str = "zone-unknown";
/// Of the line about a `TZ` that names none.
const WRONG_VARIABLE: &str = "zone-variable-unknown";

/// What the system has said last.
#[derive(Debug, Default)]
pub(crate) struct SystemZoneDesk {
    read: Option<ZoneReading>,
}

impl SystemZoneDesk {
    /// The system says this now. The first reading is the zone of the start; each other one that names a zone is a change, and one
    /// that names none leaves schedules where they are.
    pub(crate) fn take(
        &mut self,
        reading: ZoneReading,
        (schedules, readiness): (&mut ScheduleDesk, &Readiness<'_>),
        teller: &mut Teller<'_>,
    ) {
        let before = self.read.replace(reading.clone());
        if before.as_ref() == Some(&reading) {
            return;
        }
        let news = match reading.zone() {
            Ok(zone) => taken_up(zone, before.as_ref(), schedules).map(|text| (LogLevel::Info, text)),
            Err(why) => Some((LogLevel::Warn, unnamed(&why, schedules.zone_name()))),
        };
        let is_known = before.is_some_and(|before| before.wrong_variable == reading.wrong_variable);
        let complaint = reading
            .variable_complaint()
            .filter(|_| !is_known)
            .map(|complaint| {
                let zone = schedules.zone_name();
                let text = format!("{complaint} ({WRONG_VARIABLE}); schedules are in {zone}");
                (LogLevel::Warn, text)
            });
        for (level, text) in [complaint, news].into_iter().flatten() {
            teller.log(level, LogSource::Vthal, text);
        }
        schedules.tell(readiness, teller);
    }
}

/// Takes up a zone; says what people should know of that.
fn taken_up(zone: Zone, before: Option<&ZoneReading>, schedules: &mut ScheduleDesk) -> Option<String> {
    let name = zone.name().to_owned();
    let old = schedules.set_system_zone(zone, before.is_some());
    let stay = schedules.own_zone().map_or_else(String::new, |own| {
        format!("; schedules stay in {own}, which is set with them")
    });
    let was_named = before?.name.is_ok();
    if old != name {
        return Some(format!(
            "the system's time zone changed from {old} to {name} ({CHANGED}){stay}"
        ));
    }
    (!was_named).then(|| format!("the system says its time zone again, {name}{stay}"))
}

fn unnamed(why: &str, zone: &str) -> String {
    format!(
        "the system does not say its time zone ({UNKNOWN}): {why}; schedules are in {zone}. Set it with timedatectl set-timezone, \
         or choose a zone with the schedules"
    )
}
