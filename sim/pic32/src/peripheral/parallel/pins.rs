//! The pins of the parallel port.

use crate::pins::{Pin, Port, known};

/// PMRD.
pub(crate) const READ: Pin = known(Port::D, 5);
/// PMWR.
pub(crate) const WRITE: Pin = known(Port::D, 4);
/// PMCS1, which is PMA14 besides.
pub(crate) const SELECT: Pin = known(Port::D, 11);

/// PMD0 to PMD15.
pub(crate) const DATA: [Pin; 16] = [
    known(Port::E, 0),
    known(Port::E, 1),
    known(Port::E, 2),
    known(Port::E, 3),
    known(Port::E, 4),
    known(Port::E, 5),
    known(Port::E, 6),
    known(Port::E, 7),
    known(Port::G, 0),
    known(Port::G, 1),
    known(Port::F, 1),
    known(Port::F, 0),
    known(Port::D, 12),
    known(Port::D, 13),
    known(Port::D, 6),
    known(Port::D, 7),
];

/// PMA0 to PMA15.
pub(crate) const ADDRESS: [Pin; 16] = [
    known(Port::B, 15),
    known(Port::B, 14),
    known(Port::G, 9),
    known(Port::G, 8),
    known(Port::G, 7),
    known(Port::G, 6),
    known(Port::A, 10),
    known(Port::A, 9),
    known(Port::F, 5),
    known(Port::F, 4),
    known(Port::B, 13),
    known(Port::B, 12),
    known(Port::B, 11),
    known(Port::B, 10),
    SELECT,
    known(Port::D, 10),
];
