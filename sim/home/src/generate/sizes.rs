//! Sizes of things on the floors of homes: width along the wall and depth into the room, metres.
//!
//! Facts taken from the asset database of ProcTHOR (allenai/procthor, Apache-2.0), which holds bounding boxes of 1,653
//! household objects: of each kind up to six sizes, one from each sixth of the kind ordered by area, rounded to centimetres;
//! sofas deeper and desks higher than usual were left out, and of house plants the small ones. Kitchen counters are 0.61 m
//! deep there. Legs are our own: the database has boxes only.

/// Width along the wall and depth into the room, metres.
pub(super) type Size = (f64, f64);

pub(super) const ARMCHAIR: &[Size] = &[
    (0.75, 0.69),
    (0.62, 1.04),
    (1.06, 0.74),
    (0.89, 0.94),
    (1.14, 0.98),
    (1.40, 0.99),
];
pub(super) const BED_WIDE: &[Size] = &[(1.47, 2.07), (1.52, 2.41), (1.79, 2.43)];
pub(super) const BED_NARROW: &[Size] = &[(1.01, 2.01), (1.08, 2.36), (1.16, 2.43)];
pub(super) const BOX: &[Size] = &[
    (0.28, 0.26),
    (0.40, 0.31),
    (0.37, 0.41),
    (0.42, 0.44),
    (0.50, 0.42),
    (0.57, 0.52),
];
pub(super) const COFFEE_TABLE: &[Size] = &[
    (0.79, 0.47),
    (1.21, 0.50),
    (1.17, 0.75),
    (0.94, 1.02),
    (1.14, 1.12),
];
pub(super) const DESK: &[Size] = &[
    (1.02, 0.55),
    (1.24, 0.62),
    (1.39, 0.67),
    (1.55, 0.74),
    (1.77, 0.85),
];
pub(super) const DINING_TABLE: &[Size] = &[
    (0.92, 0.68),
    (1.31, 0.75),
    (1.45, 0.80),
    (1.74, 0.93),
    (1.79, 1.00),
];
pub(super) const DOG_BED: &[Size] = &[(0.73, 0.73), (0.99, 0.83), (1.18, 1.18)];
pub(super) const DRESSER: &[Size] = &[
    (0.77, 0.29),
    (1.03, 0.41),
    (1.03, 0.58),
    (1.67, 0.53),
    (2.29, 0.70),
];
/// Round foot or plate: diameter of the foot is about half of the shade that the database's box holds.
pub(super) const FLOOR_LAMP: &[Size] = &[(0.40, 0.40), (0.49, 0.49), (0.52, 0.52), (0.57, 0.57)];
pub(super) const FRIDGE: &[Size] = &[(0.79, 0.68), (0.85, 0.71), (0.95, 0.71), (1.05, 0.80)];
pub(super) const GARBAGE_CAN: &[Size] = &[(0.37, 0.32), (0.43, 0.32), (0.50, 0.34), (0.54, 0.48)];
pub(super) const HOUSE_PLANT: &[Size] = &[
    (0.25, 0.25),
    (0.33, 0.30),
    (0.37, 0.39),
    (0.47, 0.43),
    (0.53, 0.54),
];
pub(super) const HAMPER: &[Size] = &[(0.45, 0.35), (0.66, 0.51)];
pub(super) const SHELF: &[Size] = &[
    (0.67, 0.30),
    (1.10, 0.24),
    (0.92, 0.34),
    (0.79, 0.48),
    (1.12, 0.42),
];
pub(super) const SIDE_TABLE: &[Size] = &[(0.35, 0.35), (0.56, 0.33), (0.51, 0.50)];
pub(super) const SOFA: &[Size] = &[
    (1.77, 0.80),
    (2.08, 0.81),
    (2.19, 0.83),
    (2.48, 0.93),
    (2.40, 1.08),
];
pub(super) const STOOL: &[Size] = &[(0.31, 0.31), (0.36, 0.37), (0.46, 0.46)];
pub(super) const TV_STAND: &[Size] = &[(0.90, 0.39), (1.24, 0.37), (1.20, 0.60), (1.90, 0.52)];
pub(super) const TOILET: &[Size] = &[(0.54, 0.86), (0.53, 0.97)];
pub(super) const WASHING_MACHINE: &[Size] = &[(0.67, 0.68), (0.69, 0.70)];
/// Depth of a kitchen counter.
pub(super) const COUNTER_DEPTH_M: f64 = 0.61;
