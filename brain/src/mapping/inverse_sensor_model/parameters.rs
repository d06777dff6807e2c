//! Parameters of the inverse sensor model: how much evidence a sighting adds to a cell.

use crate::mapping::CELL_M;

/// Evidence of body and infrared beams.
pub(super) struct OccupancyParameters {
    /// Step of a cell under the body: few sightings outweigh all earlier infrared.
    pub(super) body_step: i8,
    /// Most by which the body is drawn smaller than it is, metres.
    pub(super) shrink_max_m: f64,
    /// The rim of the body so wide says nothing of a known obstacle, metres: the error of the pose. Deeper, the obstacle is not there.
    pub(super) body_sure_m: f64,
    /// Step of a cell that a beam passes.
    pub(super) passed_step: i8,
    /// Step along a beam that sees nothing: dark things are invisible at the end of the range.
    pub(super) nothing_step: i8,
    /// A beam that sees nothing counts for this share of its range.
    pub(super) nothing_share: f64,
    /// Step of an obstacle that touches the rim; half of it at `hit_half_m` beyond the rim.
    pub(super) hit_step: f64,
    /// As `hit_step`, metres. The error of a distance grows with it, because the albedo of a wall is unknown. The evidence falls
    /// with the square of the error; otherwise distant readings would build a crooked front before the wall.
    pub(super) hit_half_m: f64,
    /// Limit of occupancy in both directions.
    pub(super) limit: i8,
    /// A hit up to this distance behind a known obstacle counts against it, metres: as far as a hit is associated with one.
    pub(super) refuting_m: f64,
    /// By this share of what it counts for the obstacle that it confirms. A surface lies where the share of hits on it and before it is
    /// as large against those behind it: at a third of them.
    pub(super) refuting_share: f64,
    /// Levels below this are noise, 0..1.
    pub(super) level_min: f64,
    /// A beam may meet the obstacle this far before the measured distance, metres: rounding to cells. A rim of cells that is
    /// never seen as free keeps the robot off its walls.
    pub(super) margin_m: f64,
}

pub(super) const OCCUPANCY: OccupancyParameters = OccupancyParameters {
    body_step: -30,
    shrink_max_m: CELL_M,
    body_sure_m: 2.0 * CELL_M,
    passed_step: -3,
    nothing_step: -1,
    nothing_share: 0.6,
    hit_step: 30.0,
    hit_half_m: 0.07,
    limit: 100,
    refuting_m: 0.1,
    refuting_share: 0.5,
    level_min: 0.045,
    margin_m: CELL_M,
};

/// Evidence of contacts and cliffs.
pub(super) struct ContactParameters {
    /// Evidence of a contact that infrared locates on the bumper.
    pub(super) located: u8,
    /// Evidence of a contact on a short arc of the bumper.
    pub(super) narrow: u8,
    /// Evidence of a contact anywhere on half of the bumper. Most of these cells are free, so a cell needs two such contacts.
    pub(super) vague: u8,
    /// Limit of contact and cliff evidence.
    pub(super) limit: u8,
    /// Longest arc of the bumper that locates a contact, metres.
    pub(super) short_arc_m: f64,
    /// A sensor locates contacts within this angle, radians: half of the angle between two sensors.
    pub(super) spread_rad: f64,
    /// Least level of a sensor that sees the touched thing, 0..1.
    pub(super) level_min: f64,
}

pub(super) const CONTACT: ContactParameters = ContactParameters {
    located: 4,
    narrow: 2,
    vague: 1,
    limit: 8,
    short_arc_m: 0.08,
    spread_rad: 0.26,
    level_min: 0.35,
};

/// Evidence of hard floor and carpet. The motor load comes from the floor under most of the brush. The ends of the brush give
/// less evidence than the middle of the next lane.
pub(super) struct SurfaceParameters {
    /// This share of the brush in its middle gives most evidence.
    pub(super) inner_share: f64,
    /// Step of a cell under the middle.
    pub(super) inner_step: i8,
    /// Step of a cell under the ends.
    pub(super) outer_step: i8,
}

pub(super) const SURFACE: SurfaceParameters = SurfaceParameters {
    inner_share: 0.5,
    inner_step: 6,
    outer_step: 2,
};
