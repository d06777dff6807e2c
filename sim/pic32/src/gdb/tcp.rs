//! The socket of the debugger.

use super::{DebugTarget, Session};
use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};

/// Waits for a debugger, and answers it until it leaves. While the program runs, the socket is looked at between
/// moments.
///
/// # Errors
/// What the operating system says about the socket.
pub fn serve(listener: &TcpListener, target: &mut dyn DebugTarget) -> std::io::Result<()> {
    let (mut stream, _) = listener.accept()?;
    stream.set_nodelay(true)?;
    let mut session = Session::new();
    while !session.is_over() {
        let Some(bytes) = received(&mut stream, session.is_running())? else {
            return Ok(());
        };
        session.receive(&bytes, target);
        session.run(target);
        stream.set_nonblocking(false)?;
        stream.write_all(&session.take_output())?;
    }
    Ok(())
}

/// Bytes of the debugger, nothing at the end of the connection. While the program runs, reading does not block.
fn received(stream: &mut TcpStream, is_running: bool) -> std::io::Result<Option<Vec<u8>>> {
    stream.set_nonblocking(is_running)?;
    let mut buffer = [0; 4096];
    match stream.read(&mut buffer) {
        Ok(0) => Ok(None),
        Ok(length) => Ok(Some(buffer.get(..length).unwrap_or_default().to_vec())),
        Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(Some(Vec::new())),
        Err(error) => Err(error),
    }
}
