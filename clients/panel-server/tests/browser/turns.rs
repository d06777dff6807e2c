//! Whose turn it is: browsers share the processor, so few are open at a time, and only one while something is measured.

use tokio::sync::{Semaphore, SemaphorePermit};

/// Tests that may have a browser open at the same time. Most of their time is spent in waiting for a robot.
const AT_ONCE: u32 = 3;

static PLACES: Semaphore = Semaphore::const_new(AT_ONCE as usize);

/// What else may go on meanwhile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Company {
    /// Nothing: times are measured, or the emulated chip needs a core for itself.
    None,
    /// Other tests.
    Others,
}

/// Lasts until it is dropped.
pub(crate) type Turn = SemaphorePermit<'static>;

/// Waits, in the order of those who asked, until there is room.
pub(crate) async fn turn(company: Company) -> Turn {
    let places = match company {
        Company::None => AT_ONCE,
        Company::Others => 1,
    };
    PLACES.acquire_many(places).await.expect("nobody closes it")
}
