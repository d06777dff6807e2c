//! A proxy between server and daemon: everything goes through unchanged, but that the first whole map has a longer path in it, and that
//! what the map costs is counted.

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use rvac_api::{MapSnapshot, SEPARATOR, Update};

/// Bytes of each whole map and of each part of one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Costs {
    pub(crate) whole: Vec<usize>,
    pub(crate) parts: Vec<usize>,
}

/// The tap; its threads end with the processes on both sides.
#[derive(Debug)]
pub(crate) struct WireTap {
    pub(crate) socket: PathBuf,
    costs: Arc<Mutex<Costs>>,
}

impl WireTap {
    /// Puts `way_mm` before the path of each whole map.
    pub(crate) fn before(daemon: &Path, folder: &Path, way_mm: &[i32]) -> Self {
        let socket = folder.join("tap.sock");
        let listener = UnixListener::bind(&socket).unwrap();
        let costs = Arc::new(Mutex::new(Costs::default()));
        let (daemon, way_mm, counted) = (daemon.to_owned(), way_mm.to_vec(), costs.clone());
        std::thread::spawn(move || {
            for client in listener.incoming().map_while(Result::ok) {
                let Ok(upstream) = UnixStream::connect(&daemon) else {
                    continue;
                };
                let (from_client, to_daemon) = (client.try_clone().unwrap(), upstream.try_clone().unwrap());
                std::thread::spawn(move || pass(from_client, to_daemon, |message| message));
                let (way_mm, counted) = (way_mm.clone(), counted.clone());
                std::thread::spawn(move || {
                    pass(upstream, client, |message| lengthened(message, &way_mm, &counted));
                });
            }
        });
        Self { socket, costs }
    }

    pub(crate) fn costs(&self) -> Costs {
        self.costs.lock().unwrap().clone()
    }
}

fn pass(from: UnixStream, mut to: UnixStream, change: impl Fn(Vec<u8>) -> Vec<u8>) {
    for message in BufReader::new(from).split(SEPARATOR).map_while(Result::ok) {
        let mut message = change(message);
        message.push(SEPARATOR);
        if to.write_all(&message).is_err() {
            return;
        }
    }
}

fn lengthened(message: Vec<u8>, way_mm: &[i32], counted: &Mutex<Costs>) -> Vec<u8> {
    match serde_json::from_slice(&message) {
        Ok(Update::Map(map)) => {
            let longer = MapSnapshot {
                path_mm: [way_mm, &map.path_mm].concat(),
                ..map
            };
            let message = serde_json::to_vec(&Update::Map(longer)).unwrap();
            counted.lock().unwrap().whole.push(message.len());
            message
        }
        Ok(Update::MapDelta(_)) => {
            counted.lock().unwrap().parts.push(message.len());
            message
        }
        _ => message,
    }
}
