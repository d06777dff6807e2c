//! Bytes of stored maps: what is written is read again, maps of all versions are read, and nothing that is wrong is taken.
//!
//! `version_1.map` to `version_11.map` hold the same map as the writers of these versions kept it.

mod contents;
mod earlier;

use brain::mapping::{MeasuredDock, Numbered, StoredMapParts};
use brain::{KnownBeacon, Pose2, StoredMap, StoredMapError};
use contents::{map, parts};
use proptest::prelude::*;
use vthal_core::stored_map::{DecodeError, decode, encode};

/// The bytes of a body with a checksum that fits, as after a fault of the writer.
fn with_checksum(version: u8, body: &[u8]) -> Vec<u8> {
    let mut bytes = b"RVACMAP".to_vec();
    bytes.push(version);
    bytes.extend(body);
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    bytes
}

fn map_of(parts: StoredMapParts) -> StoredMap {
    StoredMap::from_parts(parts).expect("a good map")
}

#[test]
fn a_map_comes_back_and_its_knowledge_with_it() {
    let docks = [
        (None, None),
        (None, Some(Pose2::IDENTITY)),
        (
            Some(MeasuredDock {
                pose: Pose2::IDENTITY,
                times: 1,
            }),
            Some(Pose2::IDENTITY),
        ),
    ];
    let docks = docks.map(|(measured_dock, reported_dock)| {
        map_of(StoredMapParts {
            measured_dock,
            reported_dock,
            ..parts()
        })
    });
    for map in [map(), StoredMap::default()].into_iter().chain(docks) {
        let back = decode(&encode(&map)).expect("whole");
        assert_eq!(back, map);
        assert_eq!(back.knowledge(), map.knowledge());
    }
}

#[test]
fn every_cut_and_every_flipped_bit_is_refused() {
    let bytes = encode(&map());
    for length in 0..bytes.len() {
        assert!(decode(&bytes[..length]).is_err(), "cut at {length}");
    }
    for bit in 0..8 * bytes.len() {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(decode(&flipped).is_err(), "flipped bit {bit}");
    }
}

/// What is said of the body of [`map`] after a change of it, with a checksum that fits.
fn refused(change: impl Fn(&mut Vec<u8>)) -> DecodeError {
    let bytes = encode(&map());
    let mut body = bytes[8..bytes.len() - 4].to_vec();
    change(&mut body);
    decode(&with_checksum(12, &body)).expect_err("a bad body")
}

#[test]
fn what_is_wrong_is_named() {
    assert_eq!(decode(b"RVACMOP"), Err(DecodeError::NotAMap));
    assert_eq!(decode(b"RVACMAP"), Err(DecodeError::Cut));
    assert_eq!(decode(b"RVACMAP\x0D"), Err(DecodeError::Version(13)));
    let cut = |body: &mut Vec<u8>| body.truncate(body.len() - 1);
    assert_eq!(refused(cut), DecodeError::Cut);
    assert_eq!(refused(|body| body.push(0)), DecodeError::Trailing);
    assert_eq!(refused(|body| *body = vec![0xFF; 40]), DecodeError::Number);
    // The kind of the last place, which is a spot of two coordinates.
    let spot = |body: &mut Vec<u8>| {
        let name = body.windows(4).rposition(|text| text == b"Bowl").expect("a bowl");
        body[name + 4] = 7;
    };
    assert_eq!(refused(spot), DecodeError::Kind);
    let content = DecodeError::from(StoredMapError::Surface);
    assert_eq!(content.to_string(), "it has a kind of floor that cannot be");
}

/// What is said of the parts of [`map`] after a change of them.
fn wrong(change: impl Fn(&mut StoredMapParts)) -> StoredMapError {
    let mut parts = parts();
    change(&mut parts);
    StoredMap::from_parts(parts).expect_err("bad parts")
}

#[test]
fn parts_that_fit_no_map_are_refused() {
    assert!(matches!(
        wrong(|parts| parts.width = u32::MAX),
        StoredMapError::TooLarge { .. }
    ));
    let expected = u64::from(parts().width * parts().height);
    let cells = StoredMapError::Cells {
        expected,
        found: expected + 1,
    };
    assert_eq!(wrong(|parts| parts.cells[0].length += 1), cells);
    assert_eq!(wrong(|parts| parts.rooms[0].length += 1), cells);
    assert_eq!(wrong(|parts| parts.past[0].length += 1), cells);
    assert_eq!(wrong(|parts| parts.past[0].value = 0x40), StoredMapError::Past);
    assert_eq!(
        wrong(|parts| parts.cells[0].value |= 0x300),
        StoredMapError::Surface
    );
    fn twice<T: Clone>(numbered: &mut Numbered<T>) {
        let first = numbered.items[0].clone();
        numbered.items.push(first);
    }
    assert_eq!(wrong(|parts| twice(&mut parts.no_go)), StoredMapError::NoGo);
    assert_eq!(wrong(|parts| parts.no_go.next = 1), StoredMapError::NoGo);
    assert_eq!(wrong(|parts| twice(&mut parts.places)), StoredMapError::Place);
    assert_eq!(wrong(|parts| parts.places.next = 1), StoredMapError::Place);
    assert_eq!(
        wrong(|parts| twice(&mut parts.room_changes)),
        StoredMapError::RoomChange
    );
    assert_eq!(
        wrong(|parts| parts.room_changes.next = 1),
        StoredMapError::RoomChange
    );
    assert_eq!(wrong(|parts| parts.next_room = 3), StoredMapError::RoomChange);
    let name = parts().names[&3].clone();
    let many = |parts: &mut StoredMapParts| parts.names.extend((0..2_000).map(|room| (room, name.clone())));
    assert_eq!(wrong(many), StoredMapError::Name);
    let settings = parts().room_settings[&3];
    let many = |parts: &mut StoredMapParts| {
        parts
            .room_settings
            .extend((0..2_000).map(|room| (room, settings)))
    };
    assert_eq!(wrong(many), StoredMapError::RoomSettings);
    let twice = |parts: &mut StoredMapParts| parts.beacons.push(parts.beacons[0]);
    assert_eq!(wrong(twice), StoredMapError::Beacon);
    let many = |parts: &mut StoredMapParts| {
        let first = parts.beacons[0];
        parts.beacons = (0..9).map(|number| KnownBeacon { number, ..first }).collect();
    };
    assert_eq!(wrong(many), StoredMapError::Beacon);
    for sigma_m in [-0.1, f64::NAN, 1e9] {
        assert_eq!(
            wrong(|parts| parts.beacons[1].sigma_m = sigma_m),
            StoredMapError::Beacon
        );
    }
    assert_eq!(
        wrong(|parts| parts.beacons[1].place.x_m = f64::INFINITY),
        StoredMapError::Beacon
    );
}

proptest! {
    /// Whatever stands between a header and a checksum that fit, nothing panics, and what is taken can be kept again.
    #[test]
    fn any_body_is_taken_or_refused(version in 1_u8..=12, body in proptest::collection::vec(prop_oneof![0_u8..4, any::<u8>()], 0..200)) {
        if let Ok(map) = decode(&with_checksum(version, &body)) {
            prop_assert_eq!(decode(&encode(&map)), Ok(map));
        }
    }

    #[test]
    fn a_map_with_a_few_wrong_bytes_is_taken_or_refused(changes in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>()), 1..4)) {
        let bytes = encode(&map());
        let mut body = bytes[8..bytes.len() - 4].to_vec();
        for (place, byte) in changes {
            let place = place.index(body.len());
            body[place] = byte;
        }
        if let Ok(map) = decode(&with_checksum(12, &body)) {
            prop_assert_eq!(decode(&encode(&map)), Ok(map));
        }
    }
}
