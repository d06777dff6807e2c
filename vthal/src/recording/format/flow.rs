//! What the charger says, in recordings.

use brain::observation::ChargeFlow;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// [`ChargeFlow`]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FlowName {
    Flowing,
    Withheld,
    Missing,
}

impl From<ChargeFlow> for FlowName {
    fn from(flow: ChargeFlow) -> Self {
        match flow {
            ChargeFlow::Flowing => Self::Flowing,
            ChargeFlow::Withheld => Self::Withheld,
            ChargeFlow::Missing => Self::Missing,
        }
    }
}

impl FlowName {
    /// Back to the brain's own type.
    pub(super) fn to_brain(self) -> ChargeFlow {
        match self {
            Self::Flowing => ChargeFlow::Flowing,
            Self::Withheld => ChargeFlow::Withheld,
            Self::Missing => ChargeFlow::Missing,
        }
    }
}
