//! What this machine has, and what it does not know of its motors.

use rvac_protocol::message::{Capabilities, MotorGaps, MotorSet};

use crate::board::{Board, CleaningMotor, CurrentSense, Parts};
use crate::parameters::Parameters;

/// The parts of this machine: what the parameters list, as far as the board's types support it.
pub(crate) fn fitted<P: Parts>(parameters: &Parameters) -> Capabilities {
    let can = Board::<P>::capabilities();
    let Some(has) = parameters.fitted else {
        return can;
    };
    Capabilities {
        encoders: has.encoders && can.encoders,
        gyro: has.gyro && can.gyro,
        bumpers: has.bumpers.min(can.bumpers),
        cliffs: has.cliffs.min(can.cliffs),
        wheel_drops: has.wheel_drops.min(can.wheel_drops),
        proximity: has.proximity.min(can.proximity),
        dock_receivers: has.dock_receivers.min(can.dock_receivers),
        buttons: has.buttons.min(can.buttons),
        leds: has.leds.min(can.leds),
        beeper: has.beeper && can.beeper,
        brush_main: has.brush_main && can.brush_main,
        brush_sides: has.brush_sides && can.brush_sides,
        vacuum: has.vacuum && can.vacuum,
        currents: has.currents && can.currents,
        battery: has.battery && can.battery,
        charger: has.charger && can.charger,
        probe: has.probe && can.probe,
    }
}

/// The motors whose stall nothing notices (S11). A wheel without a calibrated encoder is guarded by its current only, a main
/// brush by its pulses or its current; side brushes and suction have neither.
#[inline(never)]
pub(crate) fn gaps<P: Parts>(board: &mut Board<P>, fitted: &Capabilities) -> MotorGaps {
    let has_brush_current = fitted.currents && P::Currents::BRUSH_MAIN;
    let is_unmeasured = fitted.brush_main && !has_brush_current;
    MotorGaps {
        unguarded: MotorSet {
            wheels: !fitted.encoders && !fitted.currents,
            brush_main: is_unmeasured && board.brush_main.pulses().is_none(),
            brush_sides: fitted.brush_sides,
            vacuum: fitted.vacuum,
        },
        unmeasured: MotorSet {
            brush_main: is_unmeasured && fitted.currents,
            ..MotorSet::default()
        },
    }
}
