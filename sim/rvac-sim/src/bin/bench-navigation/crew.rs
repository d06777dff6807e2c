//! Work spread over threads; results are in the order of the work.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::thread;

use crate::progress::Progress;

/// Does the work of each number below `count` on `threads` threads. Each thread begins with a `desk` of its own.
///
/// # Errors
/// One that came up; work that was not begun by then is left.
pub(crate) fn in_order<WorkerHome: Default, Done: Send>(
    count: usize,
    threads: usize,
    work: impl Fn(&mut WorkerHome, usize) -> anyhow::Result<Done> + Sync,
) -> anyhow::Result<Vec<Done>> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    let toil = || {
        let mut desk = WorkerHome::default();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= count {
                return;
            }
            let result = work(&mut desk, number);
            if result.is_err() {
                next.store(count, Ordering::Relaxed);
            }
            results
                .lock()
                .expect("nothing panics that holds the list")
                .push((number, result));
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(toil);
        }
    });
    let mut results = results.into_inner().expect("all threads have ended well");
    results.sort_by_key(|(number, _)| *number);
    results.into_iter().map(|(_, result)| result).collect()
}

/// Progress of work that several do at once.
#[derive(Debug)]
pub(crate) struct SharedProgress {
    line: Progress,
    count: usize,
    /// Thousandths of single pieces of work, all together.
    done: AtomicU64,
}

impl SharedProgress {
    pub(crate) fn new(what: &'static str, count: usize) -> Self {
        Self {
            line: Progress::new(what),
            count,
            done: AtomicU64::new(0),
        }
    }

    /// Takes shares of 0 to 1 of one piece of work.
    pub(crate) fn piece(&self) -> impl FnMut(f64) {
        let mut before = 0;
        move |share| {
            let now = (1_000.0 * share) as u64;
            let more = now.saturating_sub(before);
            before += more;
            let done = self.done.fetch_add(more, Ordering::Relaxed) + more;
            self.line.show(done as f64 / (1_000.0 * self.count as f64));
        }
    }

    pub(crate) fn clear(&self) {
        self.line.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[test]
    fn results_stand_in_the_order_of_the_work() {
        let squares = |threads| {
            in_order(20, threads, |calls: &mut usize, number| {
                *calls += 1;
                std::thread::yield_now();
                Ok(number * number)
            })
        };
        let one = squares(1).unwrap();
        assert_eq!(one, (0..20).map(|number| number * number).collect::<Vec<_>>());
        assert_eq!(squares(3).unwrap(), one);
    }

    #[test]
    fn an_error_ends_the_work() {
        let result = in_order(1_000, 2, |_: &mut (), number| {
            anyhow::ensure!(number < 3, "{number}");
            Ok(())
        });
        assert!(result.is_err());
    }
}
