//! Brushes and suction.

use rvac_units::Throttle;

/// One cleaning motor. A motor with a plain switch runs for duties above 0.5 and only forward.
pub trait CleaningMotor {
    /// Whether the machine has it.
    const PRESENT: bool;

    /// Sets the duty, forward positive. Called when it changes, and every 10 ms while it does not: a board may switch off by
    /// itself when the calls stop.
    fn set(&mut self, duty: Throttle);

    /// Total of the pulses of its rotation sensor, wrapping; `None` without such a sensor.
    fn pulses(&mut self) -> Option<u32> {
        None
    }
}
