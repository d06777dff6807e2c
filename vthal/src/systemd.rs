//! What the daemon tells systemd, if that started it: that it is ready, and that its loop still turns.

use std::time::Duration;

use sd_notify::NotifyState;
use tokio::sync::mpsc;
use tokio::task::spawn_local;
use tokio::time::{MissedTickBehavior, interval};

use crate::event::Event;

/// The socket for clients is open.
pub(crate) fn tell_ready() {
    tell(NotifyState::Ready);
}

/// The loop handled an event: the daemon lives.
pub(crate) fn tell_alive() {
    tell(NotifyState::Watchdog);
}

/// The daemon is about to end as ordered.
pub(crate) fn tell_stopping() {
    tell(NotifyState::Stopping);
}

/// Without systemd there is nobody to tell, which is no error.
fn tell(state: NotifyState<'_>) {
    if let Err(error) = sd_notify::notify(&[state]) {
        tracing::debug!(part = "vthal", "systemd could not be told: {error}");
    }
}

/// Has the loop show its life twice in the time that systemd's watchdog gives it; nothing without a watchdog.
///
/// The sign goes through the loop's own queue: a loop that hangs, or that never gets to its events, gives none.
pub(crate) fn watch(events: &mpsc::Sender<Event>) {
    let Some(period) = period(sd_notify::watchdog_enabled()) else {
        return;
    };
    let events = events.clone();
    spawn_local(async move {
        let mut ticks = interval(period);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            ticks.tick().await;
            if events.send(Event::WatchdogDue).await.is_err() {
                return;
            }
        }
    });
}

/// Half of the watchdog's time. A time of nothing would be a loop that does nothing else.
fn period(watchdog: Option<Duration>) -> Option<Duration> {
    watchdog
        .map(|time| time / 2)
        .filter(|period| *period >= Duration::from_millis(1))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::period;

    #[test]
    fn the_sign_comes_twice_in_the_watchdogs_time() {
        assert_eq!(
            period(Some(Duration::from_secs(20))),
            Some(Duration::from_secs(10))
        );
        assert_eq!(period(Some(Duration::from_micros(3))), None);
        assert_eq!(period(None), None);
    }
}
