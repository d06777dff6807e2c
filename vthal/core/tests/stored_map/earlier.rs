//! Maps of versions 1 to 11.

use brain::mapping::StoredMapParts;
use brain::{Pattern, RoomName, StoredMap, StoredMapError};
use vthal_core::stored_map::{DecodeError, decode, encode};

use crate::contents::parts_of_version;
use crate::with_checksum;

#[test]
fn the_files_of_all_earlier_versions_are_read() {
    let files: [&[u8]; 11] = [
        include_bytes!("version_1.map"),
        include_bytes!("version_2.map"),
        include_bytes!("version_3.map"),
        include_bytes!("version_4.map"),
        include_bytes!("version_5.map"),
        include_bytes!("version_6.map"),
        include_bytes!("version_7.map"),
        include_bytes!("version_8.map"),
        include_bytes!("version_9.map"),
        include_bytes!("version_10.map"),
        include_bytes!("version_11.map"),
    ];
    for (version, bytes) in (1..).zip(files) {
        let map = decode(bytes).expect("a good map");
        assert_eq!(map.parts(), parts_of_version(version), "version {version}");
        assert_eq!(decode(&encode(&map)), Ok(map));
        for length in 0..bytes.len() {
            assert!(
                decode(&bytes[..length]).is_err(),
                "version {version} cut at {length}"
            );
        }
    }
}

fn read(version: u8, body: &[&[u8]]) -> Result<StoredMapParts, DecodeError> {
    decode(&with_checksum(version, &body.concat())).map(|map| map.parts())
}

fn refused(version: u8, body: &[&[u8]]) -> DecodeError {
    read(version, body).expect_err("a bad body")
}

/// No dock, at the origin, 2 x 3 cells of one kind; room 9 is the next one and there is none yet.
const BEGIN: &[u8] = &[0, 0, 0, 2, 3, 9, 1, 5, 6, 0];
/// The same since version 6.
const BEGIN_6: &[u8] = &[0, 0, 0, 0, 2, 3, 9, 1, 5, 6, 0];

#[test]
fn a_map_of_the_first_version_is_read() {
    let map = decode(&with_checksum(1, BEGIN)).expect("a good map");
    assert_eq!(map.knowledge().values().len(), 6);
    assert!(map.annotations().is_empty());
    assert_eq!(decode(&encode(&map)), Ok(map));
}

#[test]
fn what_is_wrong_is_named() {
    assert_eq!(refused(1, &[&[0, 0, 0]]), DecodeError::Cut);
    let enormous: &[u8] = &[0, 0, 0, 0xFF, 0xFF, 0x7F, 0xFF, 0xFF, 0x7F, 1, 0, 0];
    assert!(matches!(
        refused(1, &[enormous]),
        DecodeError::Content(StoredMapError::TooLarge { .. })
    ));
    let cells = StoredMapError::Cells {
        expected: 6,
        found: 7,
    };
    let seven_of_six: &[u8] = &[0, 0, 0, 2, 3, 1, 1, 5, 7, 0];
    assert_eq!(refused(1, &[seven_of_six]), cells.into());
    assert_eq!(refused(1, &[BEGIN, &[9]]), DecodeError::Trailing);
    assert_eq!(refused(1, &[&[0xFF; 12]]), DecodeError::Number);
}

#[test]
fn no_go_zones_of_the_sixth_version_have_no_names() {
    // Number 1 of 2 is a wall from 0, 0 to 1, 0 micrometres; no names, changes, settings.
    let wall: &[u8] = &[2, 1, 1, 1, 0, 0, 2, 0];
    let end: &[u8] = &[0, 1, 0, 0, 0];
    let name = |parts: StoredMapParts| {
        let (_, no_go) = &parts.no_go.items[0];
        no_go.name().map(RoomName::as_str).map(str::to_owned)
    };
    assert_eq!(read(6, &[BEGIN_6, wall, end]).map(name), Ok(None));
    assert_eq!(
        read(7, &[BEGIN_6, wall, &[1, b'A'], end]).map(name),
        Ok(Some("A".to_owned()))
    );
    assert_eq!(read(7, &[BEGIN_6, wall, &[0], end]).map(name), Ok(None));
    assert_eq!(
        refused(7, &[BEGIN_6, wall, &[1, b' '], end]),
        StoredMapError::Name.into()
    );
    let of_no_kind: &[u8] = &[2, 1, 1, 7, 0, 0, 2, 0];
    assert_eq!(
        refused(6, &[BEGIN_6, of_no_kind, end]),
        StoredMapError::NoGo.into()
    );
}

#[test]
fn bad_places_are_refused() {
    let nothing_said: &[u8] = &[1, 0, 0, 1, 0, 0, 0];
    assert!(read(7, &[BEGIN_6, nothing_said]).is_ok());
    for bad in [
        // Number 3 where the next one is 3; kind 7; a zone of no corners.
        &[3, 1, 3, 1, b'A', 1, 2, 4][..],
        &[3, 1, 2, 1, b'A', 7, 2, 4],
        &[3, 1, 2, 1, b'A', 0, 0],
    ] {
        let error = refused(8, &[BEGIN_6, nothing_said, bad]);
        assert_eq!(error, StoredMapError::Place.into(), "{bad:?}");
    }
    let nameless = refused(8, &[BEGIN_6, nothing_said, &[3, 1, 2, 0, 1, 2, 4]]);
    assert_eq!(nameless, StoredMapError::Name.into());
}

#[test]
fn a_change_of_rooms_that_cannot_be_is_refused() {
    // The next change and then the changes: number, kind, rooms, places.
    let good: [&[u8]; 2] = [&[2, 1, 1, 1, 1, 2, 0, 0, 2, 2, 0], &[1, 0, 0]];
    let bad: [&[u8]; 6] = [
        // Number 1 where the next one is 1; rooms 1 and 1; room 0; room 9, which is yet to come; kind 7; a line without length.
        &[1, 1, 1, 1, 1, 2, 0, 0, 2, 2, 0],
        &[2, 1, 1, 1, 1, 1, 0, 0, 2, 2, 0],
        &[2, 1, 1, 1, 0, 2, 0, 0, 2, 2, 0],
        &[2, 1, 1, 1, 1, 9, 0, 0, 2, 2, 0],
        &[2, 1, 1, 7, 1, 2, 0, 0, 2, 2, 0],
        &[2, 1, 1, 0, 1, 2, 0, 0, 0, 0, 0],
    ];
    let begin = [BEGIN, &[1, 0, 0]].concat();
    for rest in good {
        assert!(read(3, &[&begin, rest]).is_ok(), "{rest:?}");
    }
    for rest in bad {
        let error = refused(3, &[&begin, rest]);
        assert_eq!(error, StoredMapError::RoomChange.into(), "{rest:?}");
    }
    // A join that was taken back.
    let join: &[u8] = &[1, 0, 1, 1, 1, 2, 0, 0, 2, 2];
    assert_eq!(refused(3, &[&begin, join]), StoredMapError::RoomChange.into());
}

#[test]
fn settings_of_the_fourth_version_are_of_lines_and_impossible_ones_are_refused() {
    let begin = [BEGIN, &[1, 0, 0, 1, 0, 0, 1, 3]].concat();
    let settings = |parts: StoredMapParts| {
        (
            parts.room_settings[&3].passes(),
            parts.room_settings[&3].pattern(),
        )
    };
    let room: &[u8] = &[2, 50, 100, 0];
    assert_eq!(read(4, &[&begin, room]).map(settings), Ok((2, Pattern::Lines)));
    assert_eq!(
        read(5, &[&begin, room, &[1]]).map(settings),
        Ok((2, Pattern::Contour))
    );
    for bad in [[4, 50, 100, 0], [1, 101, 0, 0], [1, 0, 0, 0]] {
        let error = refused(4, &[&begin, &bad]);
        assert_eq!(error, StoredMapError::RoomSettings.into(), "{bad:?}");
    }
    assert_eq!(
        refused(5, &[&begin, room, &[2]]),
        StoredMapError::RoomSettings.into()
    );
}

#[test]
fn kinds_of_floor_are_read_since_version_nine_and_what_stood_there_before_is_not() {
    // Six cells with something in the two bits of the floor; nothing that people have said.
    let floor = |version: u8, docks: &[u8], said: &[u8], bits: u16| {
        let value = 0x1400 | bits << 8;
        let low = [(value & 0x7F) as u8 | 0x80, (value >> 7) as u8];
        let parts = read(version, &[docks, &[0, 0, 2, 3, 1, 1], &low, &[6, 0], said])?;
        Ok::<_, DecodeError>(parts.cells[0].value >> 8 & 3)
    };
    for kind in 0..3 {
        assert_eq!(floor(9, &[0, 0], &[0; 9], kind), Ok(kind));
    }
    assert_eq!(floor(9, &[0, 0], &[0; 9], 3), Err(StoredMapError::Surface.into()));
    for slip in 0..4 {
        assert_eq!(floor(1, &[0], &[], slip), Ok(0), "slip of {slip}");
        assert_eq!(floor(2, &[0], &[0; 3], slip), Ok(0), "slip of {slip}");
    }
}

#[test]
fn an_empty_map_stays_empty() {
    assert_eq!(decode(&encode(&StoredMap::default())), Ok(StoredMap::default()));
}
