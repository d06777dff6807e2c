//! Long computations in steps of bounded work, so that no command waits for one.
//!
//! A long computation is an `async` function, because the compiler makes that resumable. There is no executor, no thread and no
//! clock: it counts its own work in a [`StepBudget`] and pauses when the budget of the step is spent. So equal inputs pause at equal
//! points on every machine. Pauses do not change the result.

use core::fmt;
use core::future::poll_fn;
use core::pin::Pin;
use core::task::{Context, Poll, Waker};

/// Work of one step, in visited cells or equivalents: about a millisecond on one core of a desktop.
const STEP_WORK: usize = 600_000;
/// The same for work for which nobody waits: loading and saving a home. Their steps visit tiles, which takes longer for each cell.
const SHORT_STEP_WORK: usize = 120_000;

/// The work budget until the next pause.
#[derive(Debug)]
pub(crate) struct StepBudget {
    left: usize,
    step: usize,
}

impl StepBudget {
    /// Pauses after the work of each step.
    pub(crate) const fn limited() -> Self {
        Self::of(STEP_WORK)
    }

    /// Pauses after less work.
    pub(crate) const fn short() -> Self {
        Self::of(SHORT_STEP_WORK)
    }

    /// Never pauses.
    pub(crate) const fn unlimited() -> Self {
        Self::of(usize::MAX)
    }

    /// Pauses after this much work.
    pub(crate) const fn of(step: usize) -> Self {
        Self { left: step, step }
    }

    /// Counts completed work, and pauses when the budget is spent.
    pub(crate) async fn spend(&mut self, done: usize) {
        self.left = self.left.saturating_sub(done);
        if self.left == 0 {
            self.pause().await;
        }
    }

    /// Pauses now, whatever is left of the budget.
    pub(crate) async fn pause(&mut self) {
        self.left = self.step;
        let mut has_paused = false;
        poll_fn(|_| {
            if core::mem::replace(&mut has_paused, true) {
                Poll::Ready(())
            } else {
                Poll::Pending
            }
        })
        .await;
    }
}

/// A computation in progress.
pub(crate) struct Gradual<T> {
    rest: Pin<Box<dyn Future<Output = T> + Send>>,
}

impl<T> Gradual<T> {
    /// Prepares a computation; nothing is done yet. It must await nothing but [`StepBudget::spend`].
    pub(crate) fn new(computation: impl Future<Output = T> + Send + 'static) -> Self {
        Self {
            rest: Box::pin(computation),
        }
    }

    /// Does the next step. Must not be called again after it returned `Ready`.
    pub(crate) fn go_on(&mut self) -> Poll<T> {
        self.rest.as_mut().poll(&mut Context::from_waker(Waker::noop()))
    }
}

impl<T> fmt::Debug for Gradual<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Gradual")
    }
}

/// Runs a computation to its end.
pub(crate) fn at_once<T>(computation: impl Future<Output = T>) -> T {
    let mut computation = core::pin::pin!(computation);
    loop {
        if let Poll::Ready(result) = computation.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return result;
        }
    }
}

#[cfg(test)]
mod tests {
    use core::task::Poll;

    use super::{Gradual, StepBudget, at_once};

    async fn sum(numbers: u64, mut budget: StepBudget) -> u64 {
        let mut sum = 0;
        for number in 0..numbers {
            sum += number;
            budget.spend(1).await;
        }
        sum
    }

    #[test]
    fn a_computation_pauses_when_the_budget_is_spent_and_the_result_stays_the_same() {
        let mut gradual = Gradual::new(sum(25, StepBudget::of(10)));
        assert_eq!(gradual.go_on(), Poll::Pending);
        assert_eq!(gradual.go_on(), Poll::Pending);
        assert_eq!(gradual.go_on(), Poll::Ready(300));
        assert_eq!(at_once(sum(25, StepBudget::of(10))), 300);
        assert_eq!(
            Gradual::new(sum(25, StepBudget::unlimited())).go_on(),
            Poll::Ready(300)
        );
    }
}
