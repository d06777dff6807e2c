//! The decisions of the board's parts, without access to registers. They are also compiled and tested on a computer.

pub mod beam;
pub mod bridge;
pub mod calibration_record;
pub mod clock_check;
pub mod display;
pub mod dock_code;
pub mod edges;
pub mod envelope;
pub mod floor_light;
pub mod guarded;
pub mod gyro_frame;
pub mod image_check;
pub mod image_sums;
pub mod interrupt_rate;
pub mod ladder;
pub mod lamps;
pub mod life;
#[cfg(any(feature = "link-i2c", test))]
pub mod link_registers;
pub mod pack;
pub mod proximity;
pub mod quadrature;
pub mod renewal;
pub mod reset_log;
pub mod runs;
pub mod thermistor;
pub mod tone;
#[cfg(any(feature = "link-spi", test))]
pub mod under_way;
