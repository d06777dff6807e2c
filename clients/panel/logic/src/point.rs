//! Points of the map and of the screen, as types of their own so that neither is taken for the other.

use rvac_api::Pose;

/// A point of the map in metres; y points up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapPoint {
    /// Metres to the right.
    pub x: f64,
    /// Metres up.
    pub y: f64,
}

impl MapPoint {
    /// At these metres.
    #[must_use]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Where a pose is.
    #[must_use]
    pub const fn of(pose: &Pose) -> Self {
        Self { x: pose.x, y: pose.y }
    }
}

impl From<[f64; 2]> for MapPoint {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y }
    }
}

impl From<MapPoint> for [f64; 2] {
    fn from(point: MapPoint) -> Self {
        [point.x, point.y]
    }
}

/// A point of the screen in pixels; y points down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Pixels to the right.
    pub x: f64,
    /// Pixels down.
    pub y: f64,
}

impl Pixel {
    /// At these pixels.
    #[must_use]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }
}
