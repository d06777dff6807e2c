//! What a panic leaves behind. In a binary of its own, for it silences the messages of panics.

use crate::rig;
use crate::rig::{Rig, motor};
use rvac_protocol::message::Motor;

/// Calls into the board that the passes after the start of the injection make at least.
const CALLS: u32 = 230;

/// A panic anywhere in a pass, at every call into the board in turn: the handler's one call leaves everything off.
#[test]
fn a_panic_at_any_call_leaves_all_motors_off() {
    std::panic::set_hook(Box::new(|_| {}));
    let mut panics = 0;
    for call in 0..CALLS {
        let mut rig = Rig::driving(0);
        rig.repeated.push(motor(Motor::Vacuum, 1.0));
        rig.run(300);
        assert!(!rig.wheels_off() && !rig.cleaners_off());
        rig.cord.board_mut().bumpers.0.left = call % 2 == 0;
        rig::parts::panic_at_call(call);
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            for tick in 1..=20 {
                rig.cord.board_mut().clock.0 = rig.now().after(tick).0;
                rig.cord.step();
            }
        }));
        rig::parts::never_panic();
        panics += u32::from(outcome.is_err());
        rig.cord.board_mut().all_off();
        assert!(rig.wheels_off() && rig.cleaners_off(), "call {call}");
    }
    drop(std::panic::take_hook());
    assert_eq!(panics, CALLS, "calls that panicked");
}
