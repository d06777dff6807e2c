//! The watchdog's sign of life goes through the daemon's own loop.

use systemd_notice::watchdog_ticks;
use tokio::sync::mpsc;
use tokio::task::spawn_local;

use crate::event::Event;

/// Has the loop show its life twice in the time that systemd's watchdog gives it; nothing without a watchdog.
///
/// The sign goes through the loop's own queue: a loop that hangs, or that never gets to its events, gives none.
pub(crate) fn watch(events: &mpsc::Sender<Event>) {
    let Some(mut ticks) = watchdog_ticks() else {
        return;
    };
    let events = events.clone();
    spawn_local(async move {
        loop {
            ticks.tick().await;
            if events.send(Event::WatchdogDue).await.is_err() {
                return;
            }
        }
    });
}
