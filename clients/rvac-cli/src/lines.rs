//! What is typed, line by line, on a thread of its own.

use std::io::BufRead as _;
use std::sync::mpsc::Sender;

/// Reads the input to its end; every line, trimmed, becomes an event made by `event`, the end one made by `end`.
pub(crate) fn read_input<Event: Send + 'static>(
    events: Sender<Event>,
    event: fn(String) -> Event,
    end: fn() -> Event,
) {
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines() {
            let Ok(line) = line else { break };
            // The other side is gone when the program ends first.
            if events.send(event(line.trim().to_owned())).is_err() {
                return;
            }
        }
        events.send(end()).ok();
    });
}
