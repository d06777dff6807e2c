//! One figure of a robot description with its unit and its source.

use serde::Deserialize;

/// How far a figure can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Confidence {
    /// Documented by a maker or measured.
    Known,
    /// Derived from something known.
    Estimated,
    /// Chosen so that the simulator has something to work with; measure before use on a real robot.
    Placeholder,
}

/// `{ value = 0.175, unit = "m", confidence = "placeholder", source = "..." }`
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Figure {
    pub(crate) value: f64,
    pub(crate) unit: String,
    #[expect(
        dead_code,
        reason = "required in the file for people; the simulator does not weigh it"
    )]
    pub(crate) confidence: Confidence,
    #[expect(dead_code, reason = "required in the file for people")]
    pub(crate) source: String,
}

/// A list of figures with one pedigree.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FigureList {
    pub(crate) values: Vec<f64>,
    pub(crate) unit: String,
    #[expect(
        dead_code,
        reason = "required in the file for people; the simulator does not weigh it"
    )]
    pub(crate) confidence: Confidence,
    #[expect(dead_code, reason = "required in the file for people")]
    pub(crate) source: String,
}
