//! The monitor of the simulations beside a robot on the bench. It shares nothing with cordlib: it reads the bytes on the wire,
//! the inputs and the motors.

use cordlib::board::Board;
use monitor::{Drives, Monitor, Pins, Sensed, Sides, Violation};
use rvac_protocol::message::{Bumpers, Cliffs, WheelDrops};

use super::parts::Memory;

fn sides(board: &Board<Memory>) -> Sides {
    let (bumpers, drops, missing) = (board.bumpers.0, board.wheel_drops.0, board.cliffs.missing);
    Sides {
        bumpers: [bumpers.left, bumpers.right],
        cliffs: [missing.left, missing.middle, missing.right],
        wheel_drops: [drops.left, drops.right],
        buttons: board.buttons.down,
    }
}

/// The monitor and its clock, which shows what the board's does, without its wrap.
pub struct Judge {
    monitor: Monitor,
    now_ms: u64,
}

impl Judge {
    /// From power-on.
    pub fn new(start: u32) -> Self {
        Self {
            monitor: Monitor::new(),
            now_ms: u64::from(start),
        }
    }

    /// Bytes on their way to the robot.
    pub fn hear(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.monitor.heard(self.now_ms, Some(*byte));
        }
    }

    /// Bytes of the robot.
    pub fn overhear(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.monitor.said(self.now_ms, *byte);
        }
    }

    /// One pass later.
    pub fn look(&mut self, board: &Board<Memory>, rims_m_per_s: [f64; 2]) {
        self.now_ms += 1;
        let rims_mm_per_s = rims_m_per_s.map(|rim| (rim * 1_000.0) as i32);
        let counts = board.encoders.0;
        let pins = Pins {
            bumper: board.bumpers.0 != Bumpers::default(),
            cliff: board.cliffs.missing != Cliffs::default(),
            wheel_drop: board.wheel_drops.0 != WheelDrops::default(),
            docked: board.dock_contacts.0,
            button: board.buttons.down != 0,
            counts: [counts.left, counts.right],
            rims_mm_per_s,
            speed_mm_per_s: i32::midpoint(rims_mm_per_s[0], rims_mm_per_s[1]),
            sides: Some(sides(board)),
            sensed: Sensed {
                currents_ma: Some([board.currents.0.wheel_left.0, board.currents.0.wheel_right.0]),
                ..Sensed::default()
            },
            ..Pins::default()
        };
        let wheels = [board.wheels.left, board.wheels.right].map(|drive| drive.duty().millionths());
        let cleaners = [&board.brush_main, &board.brush_sides, &board.vacuum];
        let drives = Drives {
            wheels,
            cleaners: cleaners.map(|motor| motor.duty.millionths()),
        };
        self.monitor.judge(self.now_ms, &pins, &drives);
    }

    /// What it has seen.
    pub fn violations(&self) -> &[Violation] {
        self.monitor.violations()
    }
}
