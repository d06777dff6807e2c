//! Floors that are taken along: out of one daemon, into another, and what a crash in the middle leaves. The real binary and
//! real sockets.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use brain::{Cell, CellKnowledge, Raster, StoredMap};
use rvac_api::{ARCHIVE_UPLOAD_BYTES, FloorsView, Update};
use vthal_bench::{Client, Daemon, Scratch};
use vthal_core::stored_map;

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(20);

fn soon() -> Instant {
    Instant::now() + PATIENCE
}

/// A home with a daemon.
struct Home {
    scratch: Scratch,
    daemon: Daemon,
    client: Client,
}

impl Home {
    fn new() -> Self {
        let scratch = Scratch::new().expect("creates");
        let (daemon, client) = live(&scratch);
        Self {
            scratch,
            daemon,
            client,
        }
    }

    /// One with maps of two floors, the second called Attic.
    fn with_two_floors() -> Self {
        let scratch = Scratch::new().expect("creates");
        let maps = scratch.join("state/maps");
        fs::create_dir_all(maps.join("floor-2")).expect("creates");
        fs::write(maps.join("000001.map"), large_map()).expect("writes");
        fs::write(maps.join("floor-2/000007.map"), map(9)).expect("writes");
        let list = r#"{"version":1,"floors":[{"number":1},{"number":2,"name":"Attic"}]}"#;
        fs::write(maps.join("floors.json"), list).expect("writes");
        let (daemon, client) = live(&scratch);
        Self {
            scratch,
            daemon,
            client,
        }
    }

    /// Asks with the number 9; what comes of it, the last update before `done` if there was one.
    fn ask(&mut self, request: &str) -> Result<Option<Update>, String> {
        self.client.send(request).expect("sends");
        let mut told = None;
        let end = self.client.wait_for(soon(), |update| match update {
            Update::Done { id } => *id == 9,
            Update::Failed(failure) => failure.id == Some(9),
            Update::FloorArchive { .. } => {
                told = Some(update.clone());
                false
            }
            _ => false,
        });
        match end.expect("reads") {
            Some(Update::Done { .. }) => Ok(told),
            Some(Update::Failed(failure)) => Err(failure.reason),
            other => panic!("no answer: {other:?}"),
        }
    }

    fn archive(&mut self) -> Vec<u8> {
        let mut archive = Vec::new();
        loop {
            let request = format!(r#"{{"c":"export-floors","from":{},"id":9}}"#, archive.len());
            let Ok(Some(Update::FloorArchive { size, data, .. })) = self.ask(&request) else {
                panic!("no piece")
            };
            archive.extend(STANDARD.decode(data).expect("base 64"));
            if archive.len() as u64 == size {
                return archive;
            }
        }
    }

    /// Hands over so many pieces of an archive.
    fn hand(&mut self, archive: &[u8], pieces: usize) -> Result<(), String> {
        let pieces = archive.chunks(ARCHIVE_UPLOAD_BYTES as usize).take(pieces);
        for (place, piece) in pieces.enumerate() {
            let (from, size) = (place as u64 * ARCHIVE_UPLOAD_BYTES, archive.len());
            let data = STANDARD.encode(piece);
            let request =
                format!(r#"{{"c":"import-floors","from":{from},"size":{size},"data":"{data}","id":9}}"#);
            self.ask(&request)?;
        }
        Ok(())
    }

    fn floors(&mut self) -> FloorsView {
        self.client.send(r#"{"c":"watch","topics":[]}"#).expect("sends");
        self.client
            .send(r#"{"c":"watch","topics":["floors"]}"#)
            .expect("sends");
        let told = self
            .client
            .wait_for(soon(), |update| matches!(update, Update::Floors(_)));
        match told.expect("reads") {
            Some(Update::Floors(floors)) => floors,
            other => panic!("no floors: {other:?}"),
        }
    }

    /// Ends the daemon as a failure of power would, and starts it anew.
    fn kill(self) -> Self {
        self.daemon.kill().expect("kills");
        let (daemon, client) = live(&self.scratch);
        Self {
            daemon,
            client,
            ..self
        }
    }

    /// Every file of the folder of maps.
    fn files(&self) -> BTreeMap<String, Vec<u8>> {
        let mut files = BTreeMap::new();
        gather(&self.scratch.join("state/maps"), &mut files);
        files
    }
}

fn live(scratch: &Scratch) -> (Daemon, Client) {
    let program = Path::new(env!("CARGO_BIN_EXE_vthal"));
    let daemon = Daemon::start(program, scratch, &["--seed", "1"]).expect("gets ready");
    let client = Client::connect(&scratch.join("vthal.sock")).expect("connects");
    (daemon, client)
}

fn gather(folder: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            gather(&path, files);
        } else {
            let bytes = fs::read(&path).expect("reads");
            files.insert(path.display().to_string(), bytes);
        }
    }
}

fn map(width: usize) -> Vec<u8> {
    let floor = Raster::filled(Cell { x: 0, y: 0 }, width, 8, CellKnowledge::Free);
    stored_map::encode(&StoredMap::from_raster(&floor, None))
}

/// One that needs several pieces: no two cells side by side are equal.
fn large_map() -> Vec<u8> {
    let mut floor = Raster::filled(Cell { x: 0, y: 0 }, 200, 200, CellKnowledge::Free);
    let odd = floor.values_mut().iter_mut().step_by(2);
    odd.for_each(|kind| *kind = CellKnowledge::Occupied);
    stored_map::encode(&StoredMap::from_raster(&floor, None))
}

#[test]
fn floors_of_one_home_are_the_same_in_another_one() {
    let mut giver = Home::with_two_floors();
    let archive = giver.archive();
    let mut taker = Home::new();
    let mut damaged = archive.clone();
    damaged[40] ^= 4;
    assert_eq!(
        taker.hand(&damaged, usize::MAX),
        Err("archive-damaged".to_owned())
    );
    assert_eq!(taker.floors().floors.len(), 1, "nothing was taken");
    taker.hand(&archive, usize::MAX).expect("takes");
    let floors = taker.floors().floors;
    let names: Vec<Option<&str>> = floors.iter().map(|floor| floor.name.as_deref()).collect();
    assert_eq!(names, [None, None, Some("Attic")]);
    let maps = taker.scratch.join("state/maps");
    let read = |file: &str| fs::read(maps.join(file)).expect("is there");
    assert_eq!(read("floor-2/000001.map"), large_map());
    assert_eq!(read("floor-3/000001.map"), map(9));
    let mut taker = taker.kill();
    assert_eq!(
        taker.floors().floors,
        floors,
        "what is acknowledged is on the disk"
    );
}

#[test]
fn a_daemon_that_is_killed_in_the_middle_of_an_archive_has_taken_nothing() {
    let mut giver = Home::with_two_floors();
    let archive = giver.archive();
    let pieces = archive.len().div_ceil(ARCHIVE_UPLOAD_BYTES as usize);
    assert!(pieces > 2, "{pieces} pieces");
    let before = giver.files();
    giver.hand(&archive, pieces - 1).expect("takes");
    let mut giver = giver.kill();
    assert_eq!(giver.files(), before);
    assert_eq!(giver.floors().floors.len(), 2);
    giver.hand(&archive, usize::MAX).expect("takes all of it then");
    let mut kept = giver.files();
    kept.retain(|name, _| before.contains_key(name) && !name.ends_with("floors.json"));
    let mut untouched = before;
    untouched.retain(|name, _| !name.ends_with("floors.json"));
    assert_eq!(kept, untouched, "what was there is as it was");
}
