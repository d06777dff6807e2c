//! The simulator's programs and its robots; one program, so that it is linked once.

#![allow(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

mod askew;
mod bench_navigation;
mod bench_sim;
mod docking;
mod echo;
mod flat;
mod folder;
mod lifted;
mod moved_dock;
mod run;
mod serve;
