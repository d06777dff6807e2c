//! Archives in pieces, in order and out of it.

use std::fs;
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use brain::{Cell, CellKnowledge, Raster, StoredMap};
use proptest::prelude::*;
use rvac_api::{ARCHIVE_BYTES_MAX, ARCHIVE_PIECE_BYTES, ARCHIVE_UPLOAD_BYTES, Update};
use vthal_core::{ArchiveOrder, ArchiveTask, ClientId};

use super::{ArchiveDesk, ArchiveOutcome, DeskError};
use crate::floor_folder::FloorFolder;

struct Scratch {
    floors: FloorFolder,
    desk: ArchiveDesk,
    now: Instant,
}

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("vthal-archive-{name}-{}", std::process::id()));
        fs::remove_dir_all(&path).ok();
        Self {
            floors: FloorFolder::new(path),
            desk: ArchiveDesk::default(),
            now: Instant::now(),
        }
    }

    fn ask(&mut self, client: u64, task: ArchiveTask) -> Result<ArchiveOutcome, DeskError> {
        let order = ArchiveOrder {
            client: ClientId(client),
            id: None,
            task,
        };
        self.desk.obey(order, &self.floors, self.now).outcome
    }

    /// Hands over a piece of an archive from a client and returns the answer in one word.
    fn hand(&mut self, client: u64, [from, size]: [u64; 2], bytes: &[u8]) -> &'static str {
        let task = ArchiveTask::Import {
            from,
            size,
            data: STANDARD.encode(bytes),
        };
        match self.ask(client, task) {
            Ok(ArchiveOutcome::Waits) => "waits",
            Ok(ArchiveOutcome::TakenIn(..)) => "taken in",
            Ok(ArchiveOutcome::Piece(_)) => "a piece",
            Err(error) => error.name(),
        }
    }

    fn hand_all(&mut self, client: u64, archive: &[u8]) -> &'static str {
        let size = archive.len() as u64;
        let mut answer = "nothing";
        for (place, piece) in archive.chunks(ARCHIVE_UPLOAD_BYTES as usize).enumerate() {
            answer = self.hand(client, [place as u64 * ARCHIVE_UPLOAD_BYTES, size], piece);
        }
        answer
    }

    /// An archive, asked for piece by piece.
    fn archive(&mut self) -> Vec<u8> {
        let mut got = Vec::new();
        loop {
            let from = got.len() as u64;
            let task = ArchiveTask::Export { floor: None, from };
            let Ok(ArchiveOutcome::Piece(piece)) = self.ask(1, task) else {
                panic!("no piece")
            };
            let Update::FloorArchive { size, data, .. } = *piece else {
                panic!("another update")
            };
            let bytes = STANDARD.decode(data).expect("base 64");
            if bytes.is_empty() {
                assert_eq!(size, from);
                return got;
            }
            got.extend(bytes);
        }
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        fs::remove_dir_all(self.floors.path()).ok();
    }
}

/// A map of many bytes: no two cells side by side are equal.
fn large_map() -> StoredMap {
    let mut floor = Raster::filled(Cell { x: 0, y: 0 }, 300, 200, CellKnowledge::Free);
    for (place, kind) in floor.values_mut().iter_mut().enumerate() {
        if place % 2 == 0 {
            *kind = CellKnowledge::Occupied;
        }
    }
    StoredMap::from_raster(&floor, None)
}

fn giver(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.floors.maps(1).save(&large_map()).expect("saves");
    scratch
}

#[test]
fn an_archive_goes_out_and_in_piece_by_piece() {
    let mut giver = giver("giver");
    let archive = giver.archive();
    assert!(
        archive.len() as u64 > ARCHIVE_PIECE_BYTES,
        "{} bytes",
        archive.len()
    );
    let mut taker = Scratch::new("taker");
    assert_eq!(taker.hand_all(1, &archive), "taken in");
    assert_eq!(taker.floors.maps(2).newest().0, Some(large_map()));
    assert_eq!(taker.hand_all(1, &archive), "taken in", "and again, beside it");
    assert_eq!(taker.floors.load().0.len(), 3);
}

#[test]
fn without_a_map_there_is_no_archive() {
    let mut scratch = Scratch::new("none");
    let task = ArchiveTask::Export { floor: None, from: 0 };
    assert_eq!(scratch.ask(1, task).expect_err("is none").name(), "no-map");
}

#[test]
fn pieces_out_of_order_are_refused_and_end_the_upload() {
    let archive = giver("order-giver").archive();
    let size = archive.len() as u64;
    let piece = &archive[..ARCHIVE_UPLOAD_BYTES as usize];
    let mut scratch = Scratch::new("order");
    assert_eq!(
        scratch.hand(1, [ARCHIVE_UPLOAD_BYTES, size], piece),
        "archive-piece"
    );
    let wrong: [(u64, u64, &[u8]); 5] = [
        (0, size, piece),
        (ARCHIVE_UPLOAD_BYTES + 1, size, piece),
        (ARCHIVE_UPLOAD_BYTES, size + 1, piece),
        (ARCHIVE_UPLOAD_BYTES, size, &[]),
        (
            ARCHIVE_UPLOAD_BYTES,
            size,
            &archive[..=ARCHIVE_UPLOAD_BYTES as usize],
        ),
    ];
    for (from, said, bytes) in wrong {
        assert_eq!(scratch.hand(1, [0, size], piece), "waits");
        let answer = scratch.hand(1, [from, said], bytes);
        // The first piece once more starts again.
        let expected = if from == 0 { "waits" } else { "archive-piece" };
        assert_eq!(answer, expected, "{from} {said}");
        if from > 0 {
            let next = scratch.hand(1, [ARCHIVE_UPLOAD_BYTES, size], piece);
            assert_eq!(next, "archive-piece", "it is over");
        }
    }
    assert_eq!(scratch.hand(1, [0, 5], b"sixsix"), "archive-piece");
    assert_eq!(
        scratch.hand(1, [0, ARCHIVE_BYTES_MAX + 1], b"x"),
        "archive-too-large"
    );
    assert!(!scratch.floors.path().exists(), "nothing was written");
}

#[test]
fn one_archive_comes_at_a_time_and_one_that_stopped_gives_way() {
    let archive = giver("busy-giver").archive();
    let size = archive.len() as u64;
    let piece = &archive[..ARCHIVE_UPLOAD_BYTES as usize];
    let mut scratch = Scratch::new("busy");
    assert_eq!(scratch.hand(1, [0, size], piece), "waits");
    assert_eq!(scratch.hand(2, [0, size], piece), "archive-busy");
    scratch.now += Duration::from_secs(31);
    assert_eq!(
        scratch.hand(2, [ARCHIVE_UPLOAD_BYTES, size], piece),
        "archive-piece"
    );
    assert_eq!(scratch.hand_all(2, &archive), "taken in");
    assert_eq!(
        scratch.hand(1, [ARCHIVE_UPLOAD_BYTES, size], piece),
        "archive-piece"
    );
}

#[test]
fn a_damaged_archive_changes_nothing() {
    let mut archive = giver("damaged-giver").archive();
    let middle = archive.len() / 2;
    archive[middle] ^= 1;
    let mut scratch = Scratch::new("damaged");
    assert_eq!(scratch.hand_all(1, &archive), "archive-damaged");
    assert!(!scratch.floors.path().exists());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// No pieces that anybody makes up change what is kept.
    #[test]
    fn made_up_pieces_change_nothing(
        pieces in prop::collection::vec((0_u64..3, 0_u64..40, 0_u64..40, "[A-Za-z0-9+/=]{0,40}"), 0..12),
    ) {
        let mut scratch = Scratch::new("made-up");
        for (client, from, size, data) in pieces {
            let task = ArchiveTask::Import { from, size, data };
            let outcome = scratch.ask(client, task);
            prop_assert!(!matches!(outcome, Ok(ArchiveOutcome::TakenIn(..))));
        }
        prop_assert!(!scratch.floors.path().exists());
    }
}
