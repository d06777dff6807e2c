//! Outputs of the firmware to the simulated pins.

/// Outputs of the firmware. They stay until the next [`super::World::step`] is called with others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuation {
    /// Left wheel bridge.
    pub wheel_left: Bridge,
    /// Right wheel bridge.
    pub wheel_right: Bridge,
    /// Main brush drive, -1 to 1.
    pub brush_main: f64,
    /// Side brushes run.
    pub brush_sides: bool,
    /// Suction runs.
    pub vacuum: bool,
    /// The emitters of the cliff sensors shine. Off, the sensors read the light of the room only (self-test).
    pub cliff_emitter: bool,
    /// The robot sends its code to the dock, which gives full current only then.
    pub dock_signal: bool,
    /// Current that the robot's own charging switch lets into the pack while it is docked, ampere, mean of the last 20
    /// ms; `None` = there is no switch, and the dock alone decides.
    pub charge_a: Option<f64>,
}

/// Drive of one wheel's full bridge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bridge {
    /// -1 to 1, forward positive; what lies outside saturates, NaN is 0.
    pub pwm: f64,
    /// Slow decay: the motor is shorted in the off-time of the PWM, so it brakes at 0 and has a small dead band.
    /// Without, it coasts at 0 and has a large dead band.
    pub brake: bool,
}
