//! What a test runner tells while it runs: how many tests passed and failed, and which failed.

use super::count::Count;
use std::collections::BTreeSet;
use std::fmt;

/// All of it so far.
#[derive(Debug, Default)]
pub(super) struct Verdicts {
    /// From the lines that close a program.
    pub(super) count: Count,
    /// Names of tests, as the runner writes them.
    failed: BTreeSet<String>,
}

impl Verdicts {
    /// Takes in one line.
    pub(super) fn read(&mut self, line: &str) {
        self.count.read(line);
        self.failed.extend(name_of_failed(line).map(str::to_owned));
    }

    /// Adds what was told on another stream.
    pub(super) fn add(&mut self, other: Self) {
        self.count.add(other.count);
        self.failed.extend(other.failed);
    }
}

/// The tests that failed, each on a line of its own, for the end of a message.
impl fmt::Display for Verdicts {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.failed
            .iter()
            .try_for_each(|name| write!(formatter, "\n    {name}"))
    }
}

/// `cargo test` writes `test NAME ... FAILED`; nextest `FAIL [   0.1s] (3/9) PROGRAM NAME`, or `TIMEOUT` or a signal's name
/// in place of FAIL, each of them once more in its summary, and further to the right what the failed test printed.
fn name_of_failed(line: &str) -> Option<&str> {
    if let Some(rest) = line.strip_prefix("test ") {
        return rest.trim_end().strip_suffix(" ... FAILED");
    }
    let line = line.trim();
    let (verdict, rest) = line.split_once(" [")?;
    let failed = verdict == "FAIL" || verdict == "TIMEOUT" || verdict.starts_with("SIG");
    let (_, rest) = rest.split_once(']')?;
    let rest = rest.trim_start();
    let name = match rest.strip_prefix('(') {
        Some(counted) => counted.split_once(')')?.1.trim_start(),
        None => rest,
    };
    failed.then_some(name)
}

#[cfg(test)]
mod tests {
    use super::Verdicts;

    fn names(lines: &[&str]) -> String {
        let mut verdicts = Verdicts::default();
        lines.iter().for_each(|line| verdicts.read(line));
        verdicts.to_string()
    }

    #[test]
    fn failed_tests_are_named_once_whoever_runs_them() {
        let cargo = [
            "test board::off::tests::a ... ok",
            "test board::off::tests::b ... FAILED",
            "test result: FAILED. 1 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out",
        ];
        assert_eq!(names(&cargo), "\n    board::off::tests::b");
        let nextest = [
            "        PASS [   0.012s] (1/4) brain a::b",
            "        FAIL [   0.019s] (2/4) brain a::c",
            "    test a::c ... FAILED",
            "     TIMEOUT [  60.001s] (3/4) vthal::all d",
            "     SIGABRT [   0.200s] (4/4) cordlib e",
            "     Summary [  60.204s] 4 tests run: 1 passed, 2 failed, 1 timed out, 0 skipped",
            "        FAIL [   0.019s] (2/4) brain a::c",
        ];
        assert_eq!(
            names(&nextest),
            "\n    brain a::c\n    cordlib e\n    vthal::all d"
        );
    }

    #[test]
    fn what_a_program_prints_is_no_verdict() {
        for line in [
            "FAIL",
            "a test that FAILED [somewhere] once",
            "[1.0s] FAIL",
            "FAIL [1.0s",
        ] {
            assert_eq!(names(&[line]), "");
        }
    }
}
