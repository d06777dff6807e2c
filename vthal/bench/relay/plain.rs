//! The plain relay: copies bytes from a terminal to every client.

use std::fs::File;
use std::io::{Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Serves until it is killed.
pub(crate) fn serve(serial: &Path, socket: &Path) -> anyhow::Result<()> {
    let listener = UnixListener::bind(socket)?;
    let mut line = File::options().read(true).write(true).open(serial)?;
    let clients: Arc<Mutex<Vec<UnixStream>>> = Arc::default();
    let accepted = Arc::clone(&clients);
    std::thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            accepted
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .push(stream);
        }
    });
    println!("ready");
    let mut buffer = [0; 4096];
    loop {
        let count = line.read(&mut buffer)?;
        let bytes = buffer.get(..count).unwrap_or_default();
        let mut clients = clients.lock().unwrap_or_else(PoisonError::into_inner);
        clients.retain_mut(|client| client.write_all(bytes).is_ok());
    }
}
