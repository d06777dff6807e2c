//! A slow network between browser and server: few bytes a second down, and late both ways.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::{Duration, Instant};

/// Bytes that go on as one, and how many of them wait in the network.
const CHUNK: usize = 4096;
const CHUNKS: usize = 8;

/// The network; its threads end with the connections.
#[derive(Debug)]
pub(crate) struct SlowWire {
    pub(crate) address: String,
    bytes_per_s: Arc<AtomicU64>,
}

impl SlowWire {
    /// In front of the server at this address; as fast as can be, and only late.
    pub(crate) fn before(server: &str, late: Duration) -> Self {
        let server = server.trim_start_matches("http://").trim_end_matches('/');
        let server: SocketAddr = server.parse().unwrap();
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let own = listener.local_addr().unwrap();
        let bytes_per_s = Arc::new(AtomicU64::new(u64::MAX));
        let rate = Arc::clone(&bytes_per_s);
        std::thread::spawn(move || {
            for client in listener.incoming().map_while(Result::ok) {
                let Ok(upstream) = TcpStream::connect(server) else {
                    continue;
                };
                let (from, to) = (client.try_clone().unwrap(), upstream.try_clone().unwrap());
                let called = (format!(":{}", own.port()), format!(":{}", server.port()));
                let unlimited = Arc::new(AtomicU64::new(u64::MAX));
                carry(from, to, late, (unlimited, Some(called)));
                carry(upstream, client, late, (Arc::clone(&rate), None));
            }
        });
        Self {
            address: format!("http://{own}/"),
            bytes_per_s,
        }
    }

    /// From now on only so many bytes a second come to the browser.
    pub(crate) fn slow_down(&self, bytes_per_s: u64) {
        self.bytes_per_s.store(bytes_per_s, Ordering::Relaxed);
    }
}

/// How fast, and what is said for what in it.
type Delivery = (Arc<AtomicU64>, Option<(String, String)>);

fn carry(mut from: TcpStream, to: TcpStream, late: Duration, (rate, renames): Delivery) {
    let (sender, chunks) = sync_channel(CHUNKS);
    std::thread::spawn(move || {
        let mut bytes = vec![0; CHUNK];
        while let Ok(count) = from.read(&mut bytes) {
            let chunk = renamed(&bytes[..count], renames.as_ref());
            if count == 0 || sender.send((Instant::now() + late, chunk)).is_err() {
                return;
            }
        }
    });
    std::thread::spawn(move || deliver(to, &chunks, &rate));
}

/// The server must be called by its own port.
fn renamed(bytes: &[u8], renames: Option<&(String, String)>) -> Vec<u8> {
    let Some((own, servers)) = renames.filter(|_| bytes.starts_with(b"GET ") || bytes.starts_with(b"POST "))
    else {
        return bytes.to_vec();
    };
    String::from_utf8_lossy(bytes).replace(own, servers).into_bytes()
}

fn deliver(mut to: TcpStream, chunks: &Receiver<(Instant, Vec<u8>)>, rate: &AtomicU64) {
    for (due, chunk) in chunks {
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
        if to.write_all(&chunk).is_err() {
            return;
        }
        let bytes_per_s = rate.load(Ordering::Relaxed);
        std::thread::sleep(Duration::from_secs_f64(chunk.len() as f64 / bytes_per_s as f64));
    }
    to.shutdown(std::net::Shutdown::Both).ok(); // The other side may have closed it.
}
