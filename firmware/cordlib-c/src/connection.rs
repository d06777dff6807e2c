//! The two byte queues between the firmware's serial driver and the main loop.

use cord::board::Received;

use crate::inputs::{QUEUE_BYTES, inputs};

/// Puts one received byte into the input queue. Returns 1, or 0 if the queue was full: then the byte is lost, and the
/// main loop is informed.
#[unsafe(no_mangle)]
pub extern "C" fn cord_connection_input_put(byte: u8) -> i32 {
    put(Received::Byte(byte))
}

/// The receiver saw a byte with a wrong stop bit. Returns as cord_connection_input_put.
#[unsafe(no_mangle)]
pub extern "C" fn cord_connection_input_framing_error() -> i32 {
    put(Received::FramingError)
}

/// The receiver lost bytes. Returns as cord_connection_input_put.
#[unsafe(no_mangle)]
pub extern "C" fn cord_connection_input_overrun() -> i32 {
    put(Received::Overrun)
}

/// Takes the next byte to send, 0 to 255, or -1 if there is none.
#[unsafe(no_mangle)]
pub extern "C" fn cord_connection_output_pull() -> i32 {
    inputs().to_send.pop_front().map_or(-1, i32::from)
}

/// Bytes that wait to be sent.
#[unsafe(no_mangle)]
pub extern "C" fn cord_connection_output_length() -> i32 {
    i32::try_from(inputs().to_send.len()).unwrap_or(i32::MAX)
}

fn put(received: Received) -> i32 {
    let queue = &mut inputs().received;
    if queue.len() < QUEUE_BYTES {
        queue.push_back(received);
        return 1;
    }
    if let Some(newest) = queue.back_mut() {
        *newest = Received::Overrun;
    }
    0
}
