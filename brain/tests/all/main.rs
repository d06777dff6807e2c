//! The brain from outside; one program, so that it is linked once.

mod beacons;
mod behavior;
mod contours;
mod dock_access;
mod first_run;
mod forbidden;
mod homecoming;
mod identities;
mod laws;
mod mapping;
mod orders;
mod passed;
mod plane;
mod plans;
mod recharge;
mod rooms;
mod script;
mod traps;
