//! Nobody listened to the robot for a while, and somebody carried it meanwhile, in whichever way the gap came about: it does not move before
//! it has announced itself, and does not believe the place where it was. A daemon that was away for so long drops the job (the tests of its
//! checkpoints).

use rvac_sim::board_faults::{CarriedGap, Gap};
use scenarios::scene;

const SEED: u64 = 3;

#[test]
fn a_robot_that_was_carried_while_nobody_listened_announces_itself_and_looks_where_it_is() {
    let scene = scene("two-room-flat", "nominal");
    let mut moved = 0;
    for (gap, minutes) in [
        (Gap::Link, 20),
        (Gap::Link, 61),
        (Gap::Suspended, 20),
        (Gap::Microcontroller, 20),
    ] {
        let gap = CarriedGap {
            gap,
            ms: minutes * 60_000,
        };
        let resumed = gap.resume(&scene, SEED).expect("it works before");
        assert!(!resumed.is_rash(), "{gap:?}: {resumed:?}");
        assert_eq!(resumed.violations, 0, "{gap:?}: {resumed:?}");
        moved += u32::from(resumed.moved);
    }
    assert!(moved > 0, "what never moves proves nothing");
}
