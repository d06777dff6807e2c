//! The recorded form of a brain's answers.

use brain::action::Arm;
use brain::{Actions, Motion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::recording::schemas::list;

/// [`Actions`], written and never read back: a replay compares what is written.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Answered<'a> {
    #[schemars(with = "Value")]
    motion: AnsweredMotion,
    cleaners: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    arm: Option<AnsweredArm>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(schema_with = "list")]
    tones: Vec<(u32, u16)>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    decisions: Vec<AnsweredDecision<'a>>,
}

/// The names of the decisions in [`Answered`].
#[derive(Debug, Deserialize)]
pub struct AnsweredNames {
    /// In their order.
    #[serde(default)]
    pub decisions: Vec<DecisionNames>,
}

/// The names of a decision.
#[derive(Debug, Deserialize)]
pub struct DecisionNames {
    /// What was decided.
    pub what: String,
    /// Why.
    pub reason: String,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
enum AnsweredMotion {
    Rest,
    Halt,
    Drive { v: f64, w: f64 },
}

#[derive(Debug, Serialize, JsonSchema)]
struct AnsweredArm {
    undock: bool,
}

#[derive(Debug, Serialize, JsonSchema)]
struct AnsweredDecision<'a> {
    what: &'a str,
    reason: &'a str,
    value: f64,
}

impl<'a> From<&'a Actions> for Answered<'a> {
    fn from(actions: &'a Actions) -> Self {
        Self {
            motion: match actions.motion {
                Motion::Rest => AnsweredMotion::Rest,
                Motion::Halt => AnsweredMotion::Halt,
                Motion::Drive {
                    speed_m_per_s,
                    turn_rad_per_s,
                } => AnsweredMotion::Drive {
                    v: speed_m_per_s,
                    w: turn_rad_per_s,
                },
            },
            cleaners: actions.cleaners,
            arm: actions.arm.map(|Arm { undock }| AnsweredArm { undock }),
            tones: actions
                .tones
                .iter()
                .map(|tone| (tone.pitch_hz, tone.duration_ms))
                .collect(),
            decisions: actions
                .decisions
                .iter()
                .map(|decision| AnsweredDecision {
                    what: decision.kind.name(),
                    reason: decision.cause.name(),
                    value: decision.value,
                })
                .collect(),
        }
    }
}
