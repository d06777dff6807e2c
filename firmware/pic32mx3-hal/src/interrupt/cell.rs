//! What belongs to one handler.

use super::vector::Handled;
use crate::cpu;
use core::cell::UnsafeCell;
use core::fmt;
use core::marker::PhantomData;
use core::sync::atomic::{AtomicBool, Ordering, compiler_fence};

/// Shows that the handler of vector `V` runs. There is one at a time.
pub struct Context<V: Handled> {
    vector: PhantomData<V>,
    /// Neither sent nor shared across contexts.
    stays: PhantomData<*const ()>,
}

impl<V: Handled> Context<V> {
    /// For [`interrupt!`](crate::interrupt!).
    ///
    /// # Safety
    /// Only within the handler of `V`, once each time it runs.
    #[doc(hidden)]
    #[must_use]
    pub const unsafe fn new() -> Self {
        Self {
            vector: PhantomData,
            stays: PhantomData,
        }
    }
}

impl<V: Handled> fmt::Debug for Context<V> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Context")
    }
}

/// A place in a `static` for what the main program gives to the handler of vector `V` for good: drivers, pins, state.
///
/// ```
/// use pic32mx3_hal::interrupt::{Context, HandlerCell, vector};
/// use pic32mx3_hal::interrupt;
///
/// static COUNTED: HandlerCell<vector::TIMER_1, u32> = HandlerCell::empty();
///
/// fn on_timer(context: &mut Context<vector::TIMER_1>) {
///     if let Some(counted) = COUNTED.get(context) {
///         *counted = counted.wrapping_add(1);
///     }
/// }
/// interrupt!(TIMER_1, on_timer);
///
/// // In the main program, before the source is enabled.
/// assert_eq!(COUNTED.hand_over(0), Ok(()));
/// ```
pub struct HandlerCell<V: Handled, T> {
    full: AtomicBool,
    value: UnsafeCell<Option<T>>,
    vector: PhantomData<fn(V)>,
}

// SAFETY: the value is written once, before `full` is set; from then on only the holder of the one `Context` of the vector
// reaches it, one reference at a time.
unsafe impl<V: Handled, T: Send> Sync for HandlerCell<V, T> {}

impl<V: Handled, T> HandlerCell<V, T> {
    /// A cell that nothing was given to.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            full: AtomicBool::new(false),
            value: UnsafeCell::new(None),
            vector: PhantomData,
        }
    }

    /// Gives a value to the handler.
    ///
    /// # Errors
    /// The value comes back when one was given before.
    pub fn hand_over(&self, value: T) -> Result<(), T> {
        cpu::without_interrupts(|| {
            if self.full.load(Ordering::Relaxed) {
                return Err(value);
            }
            // SAFETY: interrupts are off and the cell was empty, so there is no reference into it.
            unsafe { *self.value.get() = Some(value) };
            compiler_fence(Ordering::Release);
            self.full.store(true, Ordering::Relaxed);
            Ok(())
        })
    }

    /// What was given; `None` when nothing was.
    #[inline(always)]
    pub fn get<'a>(&'a self, _context: &'a mut Context<V>) -> Option<&'a mut T> {
        // One core: the order that the handler sees is that of the program, so the compiler alone must keep it.
        let full = self.full.load(Ordering::Relaxed);
        compiler_fence(Ordering::Acquire);
        if !full {
            return None;
        }
        // SAFETY: see `Sync`; the borrow of the context keeps a second reference from being made meanwhile.
        unsafe { (*self.value.get()).as_mut() }
    }
}

impl<V: Handled, T> fmt::Debug for HandlerCell<V, T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("HandlerCell")
            .field("full", &self.full)
            .finish_non_exhaustive()
    }
}
