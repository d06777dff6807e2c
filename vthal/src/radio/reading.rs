//! What a radio says of one beacon, and what is wrong with lines that say nothing.

use std::fmt;

use serde::Deserialize;

/// Longest name of a beacon, bytes: a network address as text, or a word or two.
const NAME_MAX: usize = 32;
/// Longest distance that a line may report, metres; no radio for homes reaches farther.
const RANGE_MAX_M: f64 = 200.0;
/// Largest deviation that a line may report, metres; a range with a larger one is useless.
const SIGMA_MAX_M: f64 = 10.0;

/// Received powers that a line may report, dBm: thermal noise of a narrow receiver, and the most that any radio tolerates. A strength reported
/// as a positive number of some scale is none of these.
const STRENGTH_MIN_DBM: f64 = -130.0;
const STRENGTH_MAX_DBM: f64 = 0.0;

/// Name of a beacon: printable letters without blanks.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct BeaconName(String);

/// A text that is no name of a beacon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a beacon's name has 1 to {NAME_MAX} printable letters of ASCII and no blanks")]
pub struct NoName;

impl BeaconName {
    /// Checks the text.
    ///
    /// # Errors
    /// [`NoName`].
    pub fn new(text: &str) -> Result<Self, NoName> {
        let fits = (1..=NAME_MAX).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_graphic());
        fits.then(|| Self(text.to_owned())).ok_or(NoName)
    }

    /// The text.
    pub(super) fn as_str(&self) -> &str {
        &self.0
    }
}

impl TryFrom<String> for BeaconName {
    type Error = NoName;

    fn try_from(text: String) -> Result<Self, NoName> {
        Self::new(&text)
    }
}

impl fmt::Display for BeaconName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// What was measured of a beacon.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    pub(super) beacon: BeaconName,
    pub(super) measured: Measured,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Measured {
    /// Distance and its deviation, metres, if the radio measures them.
    Range(f64, Option<f64>),
    /// Received power, dBm.
    Strength(f64),
}

impl Reading {
    /// A distance. Checks the numbers; written so that NaN is refused.
    pub(super) fn range(beacon: BeaconName, range_m: f64, sigma_m: Option<f64>) -> Result<Self, LineError> {
        if !(0.0..=RANGE_MAX_M).contains(&range_m) {
            return Err(LineError::Range(range_m));
        }
        if let Some(sigma_m) = sigma_m.filter(|sigma_m| !(*sigma_m > 0.0 && *sigma_m <= SIGMA_MAX_M)) {
            return Err(LineError::Sigma(sigma_m));
        }
        Ok(Self {
            beacon,
            measured: Measured::Range(range_m, sigma_m),
        })
    }

    /// A strength. Checks the number; written so that NaN is refused.
    pub(super) fn strength(beacon: BeaconName, dbm: f64) -> Result<Self, LineError> {
        if !(STRENGTH_MIN_DBM..=STRENGTH_MAX_DBM).contains(&dbm) {
            return Err(LineError::Strength(dbm));
        }
        Ok(Self {
            beacon,
            measured: Measured::Strength(dbm),
        })
    }
}

/// Why a line counts for nothing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum LineError {
    #[error("it is longer than {0} bytes")]
    TooLong(usize),
    #[error("it is not text; is the baud rate right?")]
    NotText,
    #[error("{0}")]
    Json(String),
    #[error("{0:?}: {NoName}")]
    Name(String),
    #[error("{0} m is no distance from 0 to {RANGE_MAX_M} m")]
    Range(f64),
    #[error("{0} m is no deviation above 0 and up to {SIGMA_MAX_M} m")]
    Sigma(f64),
    #[error("{0} dBm is no received power from {STRENGTH_MIN_DBM} to {STRENGTH_MAX_DBM} dBm")]
    Strength(f64),
    #[error("tell range_m or rssi_dbm of a beacon: one of the two")]
    RangeOrStrength,
    #[error("sigma_m belongs to range_m")]
    SigmaOfStrength,
    #[error("{0:?} is no number of anchors that fits the line")]
    Count(String),
    #[error("what it says of anchor {0} is broken")]
    Anchor(usize),
}
