//! When people are told. Updates and the time go in, notices come out: no I/O, no clock.

use std::time::Duration;

use bridge::Knowledge;
use rvac_api::{Activity, Status, Trouble, Update, explain};
use serde::{Deserialize, Serialize};

/// A robot that does not answer for so long has a fault; shorter breaks heal by themselves.
const SILENCE: Duration = Duration::from_secs(60);
/// Below this charge a robot that does not charge is in need of it; above the other it may be said again.
const CHARGE_LOW: f64 = 0.15;
const CHARGE_FINE: f64 = 0.3;

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Occasion {
    /// A run is over.
    Ended,
    /// The robot waits to be freed.
    Stuck,
    /// There is little charge.
    Battery,
    /// The robot waits for somebody to remove a fault, or does not answer.
    Fault,
}

impl Occasion {
    pub(crate) const ALL: [Self; 4] = [Self::Ended, Self::Stuck, Self::Battery, Self::Fault];

    /// A person must do something.
    pub(crate) const fn is_urgent(self) -> bool {
        !matches!(self, Self::Ended)
    }
}

/// What people are told.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Notice {
    pub(crate) event: Occasion,
    /// A few words.
    pub(crate) title: String,
    /// What happened, and what to do.
    pub(crate) text: String,
    /// Named reason.
    pub(crate) reason: String,
}

/// Looks at what the daemon says.
#[derive(Debug, Default)]
pub(crate) struct Watcher {
    pub(crate) known: Knowledge,
    /// Of the last status; `None` after a start, so that nothing old is told.
    activity: Option<Activity>,
    silent_since: Option<Duration>,
    silence_is_told: bool,
    charge_is_told: bool,
}

impl Watcher {
    /// Takes an update.
    pub(crate) fn update(&mut self, update: &Update, now: Duration) -> Option<Notice> {
        if let Update::RunKept(run) = update {
            let minutes = (run.duration_s / 60.0).round();
            return Some(Notice {
                event: Occasion::Ended,
                title: "A run is over".to_owned(),
                text: format!("{} {:.1} m² in {minutes} min.", run.text, run.swept_m2),
                reason: run.reason.clone(),
            });
        }
        self.known.take(update);
        match update {
            Update::Status(status) => self.status(status, now),
            Update::Device(_) => self.charge(),
            _ => None,
        }
    }

    /// The daemon is gone.
    pub(crate) fn daemon_went(&mut self, now: Duration) {
        self.known.forget_state();
        self.activity = Some(Activity::Disconnected);
        self.silent_since.get_or_insert(now);
    }

    /// Time has passed.
    pub(crate) fn wake(&mut self, now: Duration) -> Option<Notice> {
        let since = self.silent_since?;
        if self.silence_is_told || now < since + SILENCE {
            return None;
        }
        self.silence_is_told = true;
        let reason = self
            .known
            .status
            .as_ref()
            .map_or("no-daemon", |status| &status.reason);
        Some(notice(Occasion::Fault, "It does not answer", reason))
    }

    fn status(&mut self, status: &Status, now: Duration) -> Option<Notice> {
        let activity = Activity::from_name(&status.state);
        let before = self.activity;
        self.activity = activity.or(before);
        if activity == Some(Activity::Disconnected) {
            self.silent_since.get_or_insert(now);
            return None;
        }
        self.silent_since = None;
        self.silence_is_told = false;
        if before.is_none() || before == activity {
            return None;
        }
        match activity {
            Some(Activity::Stuck) => Some(notice(Occasion::Stuck, "It is stuck", &status.reason)),
            Some(Activity::Error) => {
                let trouble = Trouble::of(&status.reason);
                let is_power = matches!(trouble, Some(Trouble::BatteryLow | Trouble::Battery));
                let event = if is_power {
                    Occasion::Battery
                } else {
                    Occasion::Fault
                };
                Some(notice(event, "It has a fault", &status.reason))
            }
            _ => None,
        }
    }

    fn charge(&mut self) -> Option<Notice> {
        let battery = self.known.device.as_ref()?.battery.as_ref()?;
        let charges = battery.state == "charging";
        if charges || battery.charge > CHARGE_FINE {
            self.charge_is_told = false;
        }
        if charges || battery.charge >= CHARGE_LOW || self.charge_is_told {
            return None;
        }
        self.charge_is_told = true;
        Some(notice(Occasion::Battery, "Its battery is low", "battery-low"))
    }
}

fn notice(event: Occasion, title: &str, reason: &str) -> Notice {
    Notice {
        event,
        title: title.to_owned(),
        text: explain(reason).map_or_else(|| reason.to_owned(), rvac_api::Explanation::text),
        reason: reason.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use rvac_api::{BatteryReading, DeviceTable, Status, Update};

    use super::{Occasion, SILENCE, Watcher};

    fn status(state: &str, reason: &str) -> Update {
        Update::Status(Status {
            state: state.to_owned(),
            reason: reason.to_owned(),
            ..Status::default()
        })
    }

    fn charge(charge: f64, state: &str) -> Update {
        Update::Device(DeviceTable {
            battery: Some(BatteryReading {
                charge,
                voltage_v: 14.0,
                current_a: 0.0,
                temperature_c: None,
                state: state.to_owned(),
                charger: None,
            }),
            ..DeviceTable::default()
        })
    }

    #[test]
    fn each_thing_is_told_once_and_nothing_old() {
        let mut watcher = Watcher::default();
        let mut told = |update: &Update| watcher.update(update, Duration::ZERO).map(|notice| notice.event);
        assert_eq!(told(&status("stuck", "slip")), None, "it was so before the start");
        assert_eq!(told(&status("cleaning", "command")), None);
        assert_eq!(told(&status("stuck", "slip")), Some(Occasion::Stuck));
        assert_eq!(told(&status("stuck", "slip")), None);
        assert_eq!(told(&status("error", "wheel-stall")), Some(Occasion::Fault));
        assert_eq!(told(&charge(0.1, "discharging")), Some(Occasion::Battery));
        assert_eq!(told(&charge(0.1, "discharging")), None);
        assert_eq!(told(&charge(0.1, "charging")), None);
        assert_eq!(
            told(&charge(0.14, "discharging")),
            Some(Occasion::Battery),
            "it has charged in between"
        );
    }

    #[test]
    fn a_short_silence_is_none() {
        let mut watcher = Watcher::default();
        watcher.update(&status("idle", "command"), Duration::ZERO);
        watcher.daemon_went(Duration::from_secs(1));
        assert_eq!(watcher.wake(SILENCE), None);
        let told = watcher.wake(Duration::from_secs(2) + SILENCE).expect("a notice");
        assert_eq!((told.event, told.reason.as_str()), (Occasion::Fault, "no-daemon"));
        assert_eq!(watcher.wake(2 * SILENCE), None, "once");
    }
}
