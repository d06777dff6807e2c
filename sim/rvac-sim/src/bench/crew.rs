//! Work spread over threads; results are in the order of the work.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Does the work of each number below `count` on `threads` threads. Each thread begins with a `desk` of its own.
///
/// # Errors
/// One that came up; work that was not begun by then is left.
///
/// # Panics
/// When the work panics.
pub fn in_order<WorkerHome: Default, Done: Send>(
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
