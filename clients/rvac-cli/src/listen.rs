//! What arrives on the serial line, on a thread of its own.

use std::io::ErrorKind;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use serial2::SerialPort;

/// Reads the line to its end; what arrives becomes an event made by `received`, the end one made by `lost`.
pub(crate) fn listen<Event: Send + 'static>(
    serial: Arc<SerialPort>,
    events: Sender<Event>,
    received: fn(Vec<u8>) -> Event,
    lost: fn(std::io::Error) -> Event,
) {
    std::thread::spawn(move || {
        let mut chunk = [0; 512];
        loop {
            let (event, over) = match serial.read(&mut chunk) {
                Ok(0) => (lost(ErrorKind::UnexpectedEof.into()), true),
                Ok(count) => (received(chunk[..count].to_vec()), false),
                Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                    continue;
                }
                Err(error) => (lost(error), true),
            };
            if events.send(event).is_err() || over {
                return;
            }
        }
    });
}
