//! What the board's parts decide, apart from any register: it is compiled and tested on a computer, too.

pub mod bridge;
pub mod quadrature;
pub mod thermistor;
