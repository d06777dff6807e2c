//! What the Relax is doing when a fault happens.

use super::testbed::RelaxTestbed;
use rvac_units::{AngularSpeed, Speed};
use stc90::hosted::{HostedBlueprint, HostedError};

/// Time in which the wheels reach their speed.
const SETTLE_MS: u64 = 1_200;
/// A session that is silent is over after this, and a person may type.
const SILENCE_MS: u64 = 2_300;
/// What a person types to arm, and to drive slowly.
const TYPED_ARM: &str = r#"{"c":"arm"}"#;
const TYPED_DRIVE: &str = r#"{"c":"drive","v":0.05,"w":0,"ttl":1000}"#;

/// What the robot is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelaxScene {
    /// It stands, and nobody has armed it.
    Locked,
    /// It stands, armed.
    Standing,
    /// It drives ahead at 0.15 m/s.
    Driving,
    /// It drives ahead so slowly that no motor is driven hard.
    Creeping,
    /// It drives ahead with brush and suction on.
    Cleaning,
    /// It turns on the spot.
    Turning,
    /// A person without a host drives it by typing.
    ByHand,
}

impl RelaxScene {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Locked,
        Self::Standing,
        Self::Driving,
        Self::Creeping,
        Self::Cleaning,
        Self::Turning,
        Self::ByHand,
    ];

    /// A robot in this state.
    ///
    /// # Errors
    /// When it does not get there.
    pub fn set(self, blueprint: &HostedBlueprint) -> Result<RelaxTestbed, HostedError> {
        let mut testbed = RelaxTestbed::connected(blueprint)?;
        let ahead = |um_per_s| Some((Speed(um_per_s), AngularSpeed(0)));
        match self {
            Self::Locked => {}
            Self::Standing => testbed.pair.arm()?,
            Self::Driving | Self::Cleaning => {
                testbed.pair.arm()?;
                testbed.drive = ahead(150_000);
                testbed.cleans = self == Self::Cleaning;
            }
            Self::Creeping => {
                testbed.pair.arm()?;
                testbed.drive = ahead(55_000);
            }
            Self::Turning => {
                testbed.pair.arm()?;
                testbed.drive = Some((Speed(0), AngularSpeed(900_000)));
            }
            Self::ByHand => {
                testbed.pair.set_speaking(false);
                testbed.run(SILENCE_MS);
                testbed.pair.type_in(TYPED_ARM);
                testbed.run(100);
                testbed.typed = Some(TYPED_DRIVE);
            }
        }
        testbed.run(SETTLE_MS);
        let is_moving = !matches!(self, Self::Locked | Self::Standing);
        if testbed.pair.robot().wheels_driven() != is_moving {
            return Err(HostedError::NotArmed(format!("it is not {self:?}")));
        }
        Ok(testbed)
    }
}
