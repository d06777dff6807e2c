//! Who the robot is to browsers: a certificate authority of its own, and a certificate by it that is renewed in time.
//!
//! The authority is made once and stays, so that devices which trust it go on doing so; it can vouch for nothing but this
//! robot's names and for addresses of home networks.

mod addresses;
mod authority;
mod leaf;

pub(crate) use addresses::own_addresses;
pub(crate) use authority::Authority;
pub use authority::IdentityError;
pub(crate) use leaf::{Leaf, Subjects, reckoned_now_s};
