//! Bodies of versions 1 to 9, which were written by hand in what happens to be postcard's format, but for the poses of the dock.
//!
//! Version 1 ends after the layers; version 2 adds what people have said of the home; version 3 adds to that how they changed
//! its rooms, version 4 how rooms are cleaned, version 5 by which pattern. Version 6 begins with two poses of the dock: where
//! it was measured, how often, and where a person says that it is. In earlier ones it was measured often enough; 0 = no pose follows.
//! Version 7 adds the names of no-go zones and virtual walls, version 8 the zones and spots that are kept. Version 9 keeps the kind
//! of floor in two bits of each cell; in the oldest maps they may hold how much wheels slipped there, which nothing used.

use brain::StoredMapError;

use super::annotations::{NoGo, NoGoShape, Numbered, Pattern, RoomChanges, RoomSettings};
use super::body::{Body, Layers, Pose, StoredDock};
use super::{DecodeError, Reader};

/// Bits of a cell that held something else before version 9.
const FLOOR_BITS: u16 = 0b11 << 8;
/// Number of measurements assumed for a dock of a version before 6: its position does not change any more.
const FELT_OFTEN_ENOUGH: u8 = 6;

/// The body of a version before 10.
pub(super) fn body(reader: &mut Reader<'_>, version: u8) -> Result<Body, DecodeError> {
    let (measured_dock, reported_dock) = (measured_dock(reader, version)?, reported_dock(reader, version)?);
    Ok(Body {
        measured_dock,
        reported_dock,
        layers: layers(reader, version)?,
        no_go: no_go(reader, version)?,
        names: match version {
            1 => Vec::new(),
            _ => reader.take(StoredMapError::Name)?,
        },
        room_changes: match version {
            ..3 => RoomChanges::default(),
            _ => reader.take(StoredMapError::RoomChange)?,
        },
        room_settings: room_settings(reader, version)?,
        places: match version {
            ..8 => Numbered::default(),
            _ => reader.take(StoredMapError::Place)?,
        },
    })
}

fn measured_dock(reader: &mut Reader<'_>, version: u8) -> Result<Option<StoredDock>, DecodeError> {
    let times: u16 = reader.take(DecodeError::Number)?;
    if times == 0 {
        return Ok(None);
    }
    let pose = reader.take(DecodeError::Number)?;
    let times = match version {
        ..6 => FELT_OFTEN_ENOUGH,
        _ => times.try_into().map_err(|_| DecodeError::Number)?,
    };
    Ok(Some(StoredDock { pose, times }))
}

fn reported_dock(reader: &mut Reader<'_>, version: u8) -> Result<Option<Pose>, DecodeError> {
    if version < 6 {
        return Ok(None);
    }
    reader.take(DecodeError::Number)
}

fn layers(reader: &mut Reader<'_>, version: u8) -> Result<Layers, DecodeError> {
    let mut layers: Layers = reader.take(DecodeError::Number)?;
    if version < 9 {
        layers
            .cells
            .iter_mut()
            .for_each(|(value, _)| *value &= !FLOOR_BITS);
    }
    Ok(layers)
}

/// Before version 7 what is forbidden has no names.
fn no_go(reader: &mut Reader<'_>, version: u8) -> Result<Numbered<NoGo>, DecodeError> {
    if version == 1 {
        return Ok(Numbered::default());
    }
    if version >= 7 {
        return reader.take(StoredMapError::NoGo);
    }
    let nameless: Numbered<NoGoShape> = reader.take(StoredMapError::NoGo)?;
    Ok(nameless.map(|shape| NoGo {
        shape,
        name: String::new(),
    }))
}

/// Before version 5 all rooms are swept in lines.
fn room_settings(reader: &mut Reader<'_>, version: u8) -> Result<Vec<(u16, RoomSettings)>, DecodeError> {
    if version < 4 {
        return Ok(Vec::new());
    }
    if version >= 5 {
        return reader.take(StoredMapError::RoomSettings);
    }
    let rooms: Vec<(u16, [u8; 4])> = reader.take(StoredMapError::RoomSettings)?;
    let with_lines = |(room, [passes, suction, main_brush, side_brushes]): (u16, [u8; 4])| {
        let settings = RoomSettings {
            passes,
            suction,
            main_brush,
            side_brushes,
            pattern: Pattern::Lines,
        };
        (room, settings)
    };
    Ok(rooms.into_iter().map(with_lines).collect())
}
