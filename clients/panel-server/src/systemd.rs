//! What the server tells systemd, if that started it: that it is ready, and that it still answers.

use std::future::pending;

use sd_notify::NotifyState;
use tokio::time::{MissedTickBehavior, interval};

/// The server listens.
pub(crate) fn tell_ready() {
    tell(NotifyState::Ready);
}

/// The server ends as ordered.
pub(crate) fn tell_stopping() {
    tell(NotifyState::Stopping);
}

/// Shows twice in the time of systemd's watchdog that the runtime, which serves everybody on one thread, still turns. Never ends.
pub(crate) async fn show_life() {
    match sd_notify::watchdog_enabled() {
        Some(time) if !(time / 2).is_zero() => {
            let mut ticks = interval(time / 2);
            ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
            loop {
                ticks.tick().await;
                tell(NotifyState::Watchdog);
            }
        }
        _ => pending().await,
    }
}

/// Without systemd there is nobody to tell, which is no error.
fn tell(state: NotifyState<'_>) {
    if let Err(error) = sd_notify::notify(&[state]) {
        tracing::debug!("systemd could not be told: {error}");
    }
}
