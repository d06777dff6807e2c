//! The main loop. `cord_event_init` runs it without end, as in 2016; with `cord_init` and `cord_step` the caller runs
//! it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use cord::Cord;
use cord::board::{Absent, Board, Emitters, HardwareFault};

use crate::board::{
    CORD_MOTOR_BRUSH_MAIN, CORD_MOTOR_BRUSH_SIDES, CORD_MOTOR_VACUUM, CliffView, Foreign, ForeignMotor,
};
use crate::callbacks::callbacks;
use crate::machine::machine;

static CORD: Mutex<Option<Cord<Foreign>>> = Mutex::new(None);
static LEAVING: AtomicBool = AtomicBool::new(false);
static STEPPING: AtomicBool = AtomicBool::new(false);

/// The robot; `None` before it is initialised and while a callback of the main loop runs, because callbacks must not
/// re-enter it.
pub(crate) fn with_cord<T>(action: impl FnOnce(&mut Cord<Foreign>) -> T) -> Option<T> {
    free().and_then(|mut cord| cord.as_mut().map(action))
}

fn free() -> Option<MutexGuard<'static, Option<Cord<Foreign>>>> {
    match CORD.try_lock() {
        Ok(cord) => Some(cord),
        Err(TryLockError::Poisoned(poisoned)) => Some(PoisonError::into_inner(poisoned)),
        Err(TryLockError::WouldBlock) => None,
    }
}

fn board() -> Board<Foreign> {
    Board {
        clock: Foreign,
        link: Foreign,
        wheels: Foreign,
        reset: Foreign,
        watchdog: Foreign,
        kept: Foreign,
        checks: Foreign,
        encoders: Foreign,
        bumpers: Foreign,
        cliffs: CliffView {
            emitters: Emitters::On,
        },
        wheel_drops: Foreign,
        proximity: Absent,
        gyro: Foreign,
        currents: Foreign,
        brush_main: ForeignMotor(CORD_MOTOR_BRUSH_MAIN),
        brush_sides: ForeignMotor(CORD_MOTOR_BRUSH_SIDES),
        vacuum: ForeignMotor(CORD_MOTOR_VACUUM),
        charger: Foreign,
        dock_contacts: Foreign,
        dock_beams: Absent,
        dust_box: Absent,
        beeper: Foreign,
        lights: Foreign,
        buttons: Foreign,
        probe: Absent,
    }
}

/// Calls the setup callback, switches all motors off and starts again, as after a reset: what is latched stays. Returns 1, or 0 when called
/// from inside a callback of the main loop.
#[unsafe(no_mangle)]
pub extern "C" fn cord_init() -> i32 {
    if let Some(setup) = callbacks().setup {
        setup();
    }
    let Some(mut cord) = free() else {
        return 0;
    };
    let parameters = machine().parameters();
    *cord = Some(Cord::new(board(), parameters));
    1
}

/// Calls the step callback, then does one pass of the main loop. Returns 1, or 0 before cord_init and inside of
/// callbacks.
#[unsafe(no_mangle)]
pub extern "C" fn cord_step() -> i32 {
    if STEPPING.swap(true, Ordering::Acquire) {
        return 0;
    }
    if let Some(step) = callbacks().step {
        step();
    }
    let stepped = with_cord(Cord::step).is_some();
    STEPPING.store(false, Ordering::Release);
    i32::from(stepped)
}

/// Initialises and runs the main loop until cord_event_exit is called from one of its callbacks; on a robot without
/// end.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_init() {
    LEAVING.store(false, Ordering::Relaxed);
    if cord_init() == 0 {
        return;
    }
    while !LEAVING.load(Ordering::Relaxed) {
        if cord_step() == 0 {
            break;
        }
    }
    with_cord(|cord| cord.board_mut().all_off());
}

/// Ends cord_event_init after the present pass, with all motors off.
#[unsafe(no_mangle)]
pub extern "C" fn cord_event_exit() {
    LEAVING.store(true, Ordering::Relaxed);
}

/// Switches everything off at once and latches "internal": for the fault handlers of the chip. A fault whose cause stands
/// is reported by cord_event_hardware_fault. Called from inside a
/// callback it switches the motors off without the latch.
#[unsafe(no_mangle)]
pub extern "C" fn cord_hardware_fault() {
    if with_cord(|cord| cord.hardware_fault(HardwareFault::Internal)).is_none() {
        board().all_off();
    }
}
