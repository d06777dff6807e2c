//! Who may move the robot, by name.

use super::charge::names;

names! {
    /// State of arming (SPEC.md section 4): what the robot may do, and who holds the permission.
    ArmingState: 5 {
        /// Nothing may move.
        Locked => "locked",
        /// The holder may move, off the dock.
        Armed => "armed",
        /// The holder may also drive off the dock.
        LeavingDock => "leaving-dock",
        /// A person who types may move, slowly.
        Hand => "hand",
        /// The robot backs off a dock whose current nothing else can stop.
        DockEscape => "dock-escape",
    }
}
