//! A daemon with little memory, and an honest client beside those who besiege it.

use std::path::Path;
use std::time::Duration;

use vthal_bench::{Client, Daemon, Scratch};

/// Generous: the machine may be busy with other tests.
pub(crate) const PATIENCE: Duration = Duration::from_secs(20);
/// All the memory that the daemon can ask for in a siege, what its program takes included. A board of a robot has 512 MiB for everything.
const ADDRESS_SPACE_BYTES: u64 = 256 << 20;

/// Starts the daemon in so much memory.
pub(crate) fn start_in_little_memory(scratch: &Scratch) -> Daemon {
    let vthal = Path::new(env!("CARGO_BIN_EXE_vthal"));
    Daemon::start_within(ADDRESS_SPACE_BYTES, vthal, scratch, &["--seed", "1"]).expect("gets ready")
}

/// Presses Stop, and gives after what time that is done.
pub(crate) fn press_stop(client: &mut Client, id: u32) -> Duration {
    client.press_stop(id, PATIENCE).expect("stop is answered")
}
