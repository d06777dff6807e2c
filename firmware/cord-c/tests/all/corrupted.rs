//! Damaged packets move nothing.

use crate::compiled::place;
use cord_c::corruption::corrupt;
use cord_c::host::HostedCord;

/// `bench-cord` takes more.
const PACKETS: u64 = 20_000;
const SEED: u64 = 7;

#[test]
fn damaged_packets_move_nothing() {
    let cord = HostedCord::start(&place("robot")).expect("the cord starts");
    let found = corrupt(cord, PACKETS, SEED).expect("no sanitizer complains");
    assert!(found.is_right(), "{found:?}");
    assert_eq!(found.packets, PACKETS);
}
