//! Archives that are whole, and those that are not.

use brain::{Cell, CellKnowledge, Raster, RoomName, StoredMap};
use proptest::prelude::*;
use rvac_api::ARCHIVE_BYTES_MAX;
use vthal_core::stored_map;

use super::{ArchiveError, ArchivedFloor, MAGIC, VERSION, decode, encode, sum};

fn map(width: usize) -> Vec<u8> {
    let floor = Raster::filled(Cell { x: 1, y: 2 }, width, 4, CellKnowledge::Free);
    stored_map::encode(&StoredMap::from_raster(&floor, None))
}

/// A map as the first version of its format has it.
fn old_map() -> Vec<u8> {
    b"RVACMAP\x01\x00\x02\x04\x03\x02\x01\x01\x00\x06\x00\xA9\x8B\xE5\x2E".to_vec()
}

fn floors() -> Vec<ArchivedFloor> {
    let floor = |name: Option<&str>, map| ArchivedFloor {
        name: name.map(|name| RoomName::new(name).expect("is a name")),
        map,
    };
    vec![
        floor(Some("Pööning"), map(4)),
        floor(None, old_map()),
        floor(Some("Cellar"), map(300)),
    ]
}

/// An archive with this content and the right checksum.
fn with_checksum(mut body: Vec<u8>) -> Vec<u8> {
    body.extend(sum(&body).to_le_bytes());
    body
}

fn headed(rest: &[u8]) -> Vec<u8> {
    with_checksum([MAGIC.as_slice(), &[VERSION], rest].concat())
}

fn reason(bytes: &[u8]) -> &'static str {
    decode(bytes).expect_err("is refused").name()
}

#[test]
fn what_is_written_is_read_and_maps_of_older_versions_stay_as_they_are() {
    let archive = encode(&floors()).expect("is small");
    assert_eq!(decode(&archive), Ok(floors()));
}

#[test]
fn a_cut_and_a_flipped_bit_anywhere_are_found() {
    let archive = encode(&floors()).expect("is small");
    for end in 0..archive.len() {
        assert!(decode(&archive[..end]).is_err(), "cut after {end} bytes");
    }
    for bit in 0..8 * archive.len() {
        let mut flipped = archive.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(decode(&flipped).is_err(), "bit {bit}");
    }
}

#[test]
fn each_fault_has_its_reason_and_its_remedy() {
    let archive = encode(&floors()).expect("is small");
    assert_eq!(reason(b"{\"version\":1}"), "no-archive");
    assert_eq!(reason(b""), "no-archive");
    let mut newer = archive.clone();
    newer[MAGIC.len()] = VERSION + 1;
    assert_eq!(decode(&newer), Err(ArchiveError::TooNew(VERSION + 1)));
    assert_eq!(reason(&archive[..archive.len() - 1]), "archive-damaged");
    let nothing = headed(&[0]);
    assert_eq!(decode(&nothing), Err(ArchiveError::Wrong(10)), "no floors at all");
    let trailing = headed(&[&[1, 0, map(4).len() as u8, 0, 0, 0], map(4).as_slice(), b"x"].concat());
    assert_eq!(reason(&trailing), "archive-damaged");
    let endless = headed(&[1, 0, 0xFF, 0xFF, 0xFF, 0xFF, 1]);
    assert_eq!(reason(&endless), "archive-damaged");
    let name = headed(&[1, 1, b'\n', 0, 0, 0, 0]);
    assert_eq!(decode(&name), Err(ArchiveError::Wrong(11)), "a name of one line");
    let spaced = headed(
        &[
            &[1, 2, b' ', b'A', map(4).len() as u8, 0, 0, 0],
            map(4).as_slice(),
        ]
        .concat(),
    );
    assert_eq!(
        decode(&spaced),
        Err(ArchiveError::Wrong(11)),
        "nothing around a name"
    );
}

#[test]
fn a_map_that_cannot_be_read_is_named() {
    let mut broken = floors();
    broken[2].map[9] ^= 1;
    let archive = encode(&broken).expect("is small");
    let error = decode(&archive).expect_err("is refused");
    assert_eq!(error.name(), "archive-map-wrong");
    let text = error.to_string();
    assert!(
        text.contains("floor 3 of the archive (Cellar)") && text.contains("checksum"),
        "{text}"
    );
}

#[test]
fn an_archive_that_nobody_would_take_is_not_written() {
    let large = ArchivedFloor {
        name: None,
        map: vec![0; ARCHIVE_BYTES_MAX as usize],
    };
    assert!(matches!(encode(&[large]), Err(ArchiveError::TooLarge(_))));
    let bytes = vec![0; ARCHIVE_BYTES_MAX as usize + 1];
    assert_eq!(reason(&bytes), "archive-too-large");
}

proptest! {
    /// All bytes give either an error sentence or an archive that is written back to the same bytes.
    #[test]
    fn any_bytes_are_refused_or_read(bytes in prop::collection::vec(any::<u8>(), 0..300), is_headed: bool) {
        let bytes = if is_headed { headed(&bytes) } else { bytes };
        if let Ok(floors) = decode(&bytes) {
            prop_assert_eq!(encode(&floors), Ok(bytes));
        }
    }

    /// The same for archives that were changed and given the right checksum.
    #[test]
    fn changed_archives_are_refused_or_read(place in 9_usize..400, value: u8) {
        let mut body = encode(&floors()).expect("is small");
        body.truncate(body.len() - 4);
        let place = place % body.len();
        if place > MAGIC.len() {
            body[place] = value;
        }
        let bytes = with_checksum(body);
        if let Ok(floors) = decode(&bytes) {
            prop_assert_eq!(encode(&floors), Ok(bytes));
        }
    }
}
