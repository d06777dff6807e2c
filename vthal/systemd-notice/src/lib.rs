//! What a service tells systemd, if that started it: that it is ready, that it still lives, that it ends as ordered.
#![forbid(unsafe_code)]

use std::future::pending;
use std::time::Duration;

use sd_notify::NotifyState;
use tokio::time::{Interval, MissedTickBehavior, interval};

/// The service serves from now on.
pub fn tell_ready() {
    tell(NotifyState::Ready);
}

/// The service lives.
pub fn tell_alive() {
    tell(NotifyState::Watchdog);
}

/// The service ends as ordered.
pub fn tell_stopping() {
    tell(NotifyState::Stopping);
}

/// Without systemd there is nobody to tell, which is no error.
fn tell(state: NotifyState<'_>) {
    if let Err(error) = sd_notify::notify(&[state]) {
        tracing::debug!("systemd could not be told: {error}");
    }
}

/// Ticks twice in the time that systemd's watchdog gives; `None` without a watchdog. Within a runtime of tokio.
#[must_use]
pub fn watchdog_ticks() -> Option<Interval> {
    let mut ticks = interval(period(sd_notify::watchdog_enabled())?);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    Some(ticks)
}

/// Shows at each of these ticks that the runtime still turns: for services that do everything on one thread. Never ends.
pub async fn show_life() {
    let Some(mut ticks) = watchdog_ticks() else {
        return pending().await;
    };
    loop {
        ticks.tick().await;
        tell_alive();
    }
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
