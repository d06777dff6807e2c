//! The Relax's firmware under faults, in its emulated chip: the rules that this hardware can have.
//!
//! The chip has no clock monitor, no converter, no charger, no buttons and no traps, so S14, S16's voltages, S17 to S20, S22
//! and S28 are not its own. S15 cannot act before S11: a wheel that moves less than 20 mm in 2 s is without a count for 300 ms. S12 sees
//! nothing: with counts of 5 mm in periods of 10 ms no speed that the motors reach is surely too fast.

mod catalog;
mod flash;
mod scene;
mod testbed;
mod trial;

pub use catalog::trials;
pub use flash::flipped_flash;
pub use scene::RelaxScene;
pub use testbed::RelaxTestbed;
pub use trial::{RelaxCampaign, RelaxTrial};
