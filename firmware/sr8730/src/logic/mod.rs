//! What the board's parts decide, apart from any register: it is compiled and tested on a computer, too.

pub mod beam;
pub mod bridge;
pub mod dock_code;
pub mod envelope;
pub mod floor_light;
pub mod gyro_frame;
pub mod ladder;
pub mod lamps;
pub mod pack;
pub mod proximity;
pub mod quadrature;
pub mod thermistor;
pub mod tone;
