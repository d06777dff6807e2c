//! The time zone of the system, followed by a thread of its own: it looks at files, and a disk may be slow.

use std::io;
use std::path::Path;

use system_zone::{LOOK_EVERY, SystemZone, ZoneWatch};
use tokio::sync::mpsc::Sender;
use vthal_core::schedule::{Zone, ZoneReading};

use crate::event::Event;

/// The zone that the system says now, and the thread that follows it. It ends when the daemon's event queue closes.
///
/// # Errors
/// When the system gives no thread.
pub(crate) fn start(events: Sender<Event>) -> io::Result<ZoneReading> {
    let variable = std::env::var_os("TZ").map(|text| text.to_string_lossy().into_owned());
    let watch = ZoneWatch::start(Path::new("/"), variable, |name| Zone::named(name).is_some());
    let reading = reading(watch.zone());
    std::thread::Builder::new()
        .name("zone".to_owned())
        .spawn(move || follow(watch, &events))?;
    Ok(reading)
}

fn follow(mut watch: ZoneWatch, events: &Sender<Event>) {
    while !events.is_closed() {
        std::thread::sleep(LOOK_EVERY);
        if let Some(zone) = watch.look()
            && events.blocking_send(Event::Zone(reading(zone))).is_err()
        {
            return;
        }
    }
}

fn reading(zone: &SystemZone) -> ZoneReading {
    ZoneReading::new(&zone.name, zone.tried(), zone.wrong_variable.as_deref())
}
