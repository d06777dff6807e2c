//! Long computations in steps of bounded work, so that no command waits for one.
//!
//! A long computation is an `async` function, because the compiler turns that into something that can be left in the middle
//! and taken up again. There is no executor, no thread and no clock in it: it counts its own work in a [`StepBudget`] and pauses
//! when a step's share is done, so equal inputs pause at equal places on every machine. Pauses change nothing in the result.

use core::fmt;
use core::future::poll_fn;
use core::pin::Pin;
use core::task::{Context, Poll, Waker};

/// Work of one step, in cells looked at and things that take as long: some millisecond of a desktop's core.
const STEP_WORK: usize = 600_000;

/// How much work may be done before the next pause.
#[derive(Debug)]
pub(crate) struct StepBudget {
    left: usize,
    step: usize,
}

impl StepBudget {
    /// Pauses after each step's work.
    pub(crate) const fn limited() -> Self {
        Self::of(STEP_WORK)
    }

    /// Never pauses.
    pub(crate) const fn unlimited() -> Self {
        Self::of(usize::MAX)
    }

    /// Pauses when so much work was done.
    pub(crate) const fn of(step: usize) -> Self {
        Self { left: step, step }
    }

    /// Counts work that was done, and pauses if that was enough for a step.
    pub(crate) async fn spend(&mut self, done: usize) {
        self.left = self.left.saturating_sub(done);
        if self.left == 0 {
            self.pause().await;
        }
    }

    /// Leaves the rest to the next step, however much was done in this one.
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

/// A computation that is under way.
pub(crate) struct Gradual<T> {
    rest: Pin<Box<dyn Future<Output = T> + Send>>,
}

impl<T> Gradual<T> {
    /// Begins it; nothing is done yet. It must await nothing but [`StepBudget::spend`].
    pub(crate) fn new(computation: impl Future<Output = T> + Send + 'static) -> Self {
        Self {
            rest: Box::pin(computation),
        }
    }

    /// Does the next step. Not to be called again once it is ready.
    pub(crate) fn go_on(&mut self) -> Poll<T> {
        self.rest.as_mut().poll(&mut Context::from_waker(Waker::noop()))
    }
}

impl<T> fmt::Debug for Gradual<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Gradual")
    }
}

/// Does all of a computation in one go.
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
    fn it_pauses_after_each_steps_work_and_ends_with_the_same_result() {
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
