//! A serial line by software; one program, so that it is linked once.

mod line;
mod rate;
mod receive;
mod send;
