//! Parameters of the room segmentation.

/// What separates two rooms.
pub(super) struct SegmentationParameters {
    /// Half of the widest passage that separates two rooms, metres.
    pub(super) passage_half_max_m: f64,
    /// Least ratio of a room's width to that of the passage into it.
    pub(super) width_ratio_min: f64,
    /// A smaller basin merges when it meets another one, square metres.
    pub(super) core_min_m2: f64,
    /// Least area of a room, square metres.
    pub(super) room_min_m2: f64,
    /// Largest area of furniture, square metres.
    pub(super) furniture_max_m2: f64,
}

pub(super) const SEGMENTATION: SegmentationParameters = SegmentationParameters {
    passage_half_max_m: 0.55,
    width_ratio_min: 1.25,
    core_min_m2: 0.2,
    room_min_m2: 1.0,
    furniture_max_m2: 1.2,
};
