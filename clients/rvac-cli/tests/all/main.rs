//! The program `rvac` as its user starts it; one test program, so that it is linked once.

mod calibrate;
mod daemon;
mod drive;
#[path = "../../../panel-server/tests/folder/mod.rs"]
mod folder;
mod packet;
mod program;
mod term;
mod update;
