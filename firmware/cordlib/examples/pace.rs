//! What one idle pass of the main loop costs on this machine. Run it with `--release`.

use std::time::Instant;

#[path = "../tests/all/rig/parts.rs"]
#[allow(dead_code, unreachable_pub, reason = "the parts serve tests as well")]
mod parts;

use cordlib::{Cord, Parameters};

const PASSES: u32 = 5_000_000;
/// What the line to the host takes at a time: all that a pass says.
const LINE_BYTES: usize = 1_000;

fn main() {
    let board = parts::board(LINE_BYTES);
    let mut cord = Cord::new(board, Parameters::for_machine("pace", "0", parts::LIMITS));
    let start = Instant::now();
    for tick in 1..=PASSES {
        cord.board_mut().clock.0 = tick;
        cord.step();
        cord.board_mut().link.to_host.clear();
    }
    let each_ns = start.elapsed().as_secs_f64() * 1e9 / f64::from(PASSES);
    println!(
        "idle pass: {each_ns:.1} ns; Cord of this board: {} bytes",
        size_of_val(&cord)
    );
}
