//! How many tests passed and failed, read from what test runners print.

use std::fmt;

/// Passed and failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Count {
    /// Passed.
    pub(super) passed: u64,
    /// Failed.
    pub(super) failed: u64,
}

impl Count {
    /// One check that passed.
    pub(super) const ONE: Self = Self { passed: 1, failed: 0 };

    /// Adds another count.
    pub(super) fn add(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
    }

    /// The same with at least one failure: a stage can fail without naming a test.
    pub(super) fn with_a_failure(self) -> Self {
        Self {
            failed: self.failed.max(1),
            ..self
        }
    }

    /// Takes in one line of a test runner: cargo test ends each program with `test result: ok. 3 passed; 0 failed; ...`,
    /// nextest ends all with `Summary [ 1.2s] 3 tests run: 2 passed, 1 failed, 0 skipped`, and shows what a failed test printed further to
    /// the right.
    pub(super) fn read(&mut self, line: &str) {
        let is_closing = line.starts_with("test result:") || line.trim_start().starts_with("Summary [");
        if is_closing {
            self.passed += before(line, " passed");
            self.failed += before(line, " failed") + before(line, " timed out");
        }
    }
}

impl fmt::Display for Count {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} passed, {} failed", self.passed, self.failed)
    }
}

/// The number that stands before a word.
fn before(line: &str, word: &str) -> u64 {
    let Some((left, _)) = line.split_once(word) else {
        return 0;
    };
    left.rsplit(|letter: char| !letter.is_ascii_digit())
        .next()
        .and_then(|digits| digits.parse().ok())
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::Count;

    fn read(line: &str) -> (u64, u64) {
        let mut count = Count::default();
        count.read(line);
        (count.passed, count.failed)
    }

    #[test]
    fn lines_of_runners_are_understood() {
        assert_eq!(
            read("test result: FAILED. 12 passed; 3 failed; 0 ignored; 0 measured; 1 filtered out"),
            (12, 3)
        );
        assert_eq!(
            read("     Summary [   1.204s] 7 tests run: 5 passed (1 slow), 2 failed, 4 skipped"),
            (5, 2)
        );
        assert_eq!(
            read("     Summary [   0.204s] 5 tests run: 5 passed, 0 skipped"),
            (5, 0)
        );
        assert_eq!(read("this test passed"), (0, 0));
        assert_eq!(
            read("    test result: FAILED. 0 passed; 1 failed; 0 ignored"),
            (0, 0)
        );
    }
}
