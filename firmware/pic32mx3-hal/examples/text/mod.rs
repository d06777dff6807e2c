//! What the examples write with `write!`.

use embedded_io::Write;

/// Lets `write!` write to a UART.
pub(crate) struct Text<W>(pub(crate) W);

impl<W: Write> core::fmt::Write for Text<W> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.0.write_all(text.as_bytes()).map_err(|_| core::fmt::Error)
    }
}
