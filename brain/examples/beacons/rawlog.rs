//! Reads beacon ranges and odometry out of a recording of MRPT (`rawlog`), unpacked.
//!
//! The format is a sequence of objects, each with its class's name, a version and its fields; it is not self-describing, so
//! a reader of all of it would have to know every class. This one looks for the names of the two classes that it needs and
//! reads their first fields: `CObservationBeaconRanges` of version 3, `CActionRobotMovement2D` of version 6.

use brain::Pose2;

const RANGES: &[u8] = b"CObservationBeaconRanges";
const MOVEMENT: &[u8] = b"CActionRobotMovement2D";
const POSE: &[u8] = b"CPose2D";
const POINT: &[u8] = b"CPoint3D";

/// What happened, in the order of the recording.
pub(crate) enum Entry {
    /// Number of the beacon and metres.
    Ranges(Vec<(u16, f64)>),
    /// From the pose before to the one after.
    Moved(Pose2),
}

/// The bytes of a recording.
pub(crate) struct Rawlog<'a> {
    bytes: &'a [u8],
}

impl<'a> Rawlog<'a> {
    /// Checks that the bytes can be such a recording.
    pub(crate) fn new(bytes: &'a [u8]) -> Result<Self, String> {
        match bytes {
            [0x1f, 0x8b, ..] => Err("the recording is packed; unpack it with zcat first".to_owned()),
            _ if position(bytes, RANGES).is_none() => Err("the recording holds no beacon ranges".to_owned()),
            _ => Ok(Self { bytes }),
        }
    }

    /// All that is understood.
    pub(crate) fn entries(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        let mut rest = self.bytes;
        while let Some(start) = position(rest, b"C") {
            rest = rest.get(start..).unwrap_or_default();
            let entry = if let Some(fields) = rest.strip_prefix(RANGES) {
                ranges(fields).map(Entry::Ranges)
            } else if let Some(fields) = rest.strip_prefix(MOVEMENT) {
                movement(fields).map(Entry::Moved)
            } else {
                None
            };
            entries.extend(entry);
            rest = rest.get(1..).unwrap_or_default();
        }
        entries
    }
}

/// Version, least and greatest range, deviation, then the ranges.
fn ranges(fields: &[u8]) -> Option<Vec<(u16, f64)>> {
    let (version, rest) = fields.split_first()?;
    let (_, rest) = rest.split_at_checked(12)?;
    let (count, mut rest) = rest.split_first_chunk()?;
    if *version != 3 {
        return None;
    }
    (0..u32::from_le_bytes(*count).min(100))
        .map(|_| {
            // Where the antenna sits: flag, name, version, three numbers, end.
            let point = rest.get(1..)?.strip_prefix(POINT)?;
            let (_, fields) = point.split_at_checked(1 + 3 * 8 + 1)?;
            let (range, fields) = fields.split_first_chunk()?;
            let (number, fields) = fields.split_first_chunk()?;
            rest = fields;
            let number = u16::try_from(i32::from_le_bytes(*number)).ok()?;
            Some((number, f64::from(f32::from_le_bytes(*range))))
        })
        .collect()
}

/// The first pose among the fields is the odometry's own reading.
fn movement(fields: &[u8]) -> Option<Pose2> {
    let start = position(fields.get(..64)?, POSE)?;
    // The name is followed by a version.
    let numbers = fields.get(start + POSE.len() + 1..)?;
    let (x, numbers) = numbers.split_first_chunk()?;
    let (y, numbers) = numbers.split_first_chunk()?;
    let (heading, _) = numbers.split_first_chunk()?;
    Some(Pose2 {
        x_m: f64::from_le_bytes(*x),
        y_m: f64::from_le_bytes(*y),
        heading_rad: f64::from_le_bytes(*heading),
    })
}

fn position(bytes: &[u8], wanted: &[u8]) -> Option<usize> {
    bytes.windows(wanted.len()).position(|window| window == wanted)
}
