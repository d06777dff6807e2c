//! What came of runs, from the words of the brain.

use rvac_api::{RunAsker, RunJob, RunResult};

use super::ending::{Ending, LastWords};

fn clean() -> RunJob {
    RunJob::Clean {
        strategy: "systematic".to_owned(),
        rooms: Vec::new(),
        zones: 0,
        spots: 0,
        passes: 1,
    }
}

#[test]
fn a_job_that_has_nothing_left_to_do_is_finished_for_its_own_reason() {
    let clean = clean();
    for reason in [
        "finished",
        "rest-out-of-reach",
        "not-worth-the-time",
        "by-statistics",
        "crumbs-left",
    ] {
        let words = LastWords {
            job: &clean,
            reason: "docked",
            turned_home: Some(reason),
            trouble: None,
            by: None,
        };
        let ending = Ending::of(words);
        assert_eq!(
            (ending.result, ending.reason.as_str()),
            (RunResult::Finished, reason)
        );
    }
}

#[test]
fn results_follow_from_the_last_words() {
    use RunResult::{Finished, GaveUp, Stopped};
    let clean = clean();
    let anna = RunAsker::Client("Anna".to_owned());
    let words = |reason, turned_home| LastWords {
        job: &clean,
        reason,
        turned_home,
        trouble: None,
        by: Some(&anna),
    };
    for (words, result, reason) in [
        (words("finished", None), Finished, "finished"),
        (words("docked", Some("finished")), Finished, "finished"),
        (
            words("dock-not-found", Some("finished")),
            Finished,
            "dock-not-found",
        ),
        (words("command", None), Stopped, "command"),
        (words("docked", Some("command")), Stopped, "command"),
        (words("docked", Some("task-budget")), GaveUp, "task-budget"),
        (
            words("dock-not-found", Some("battery-low")),
            GaveUp,
            "dock-not-found",
        ),
        (words("no-heading", None), GaveUp, "no-heading"),
        (
            LastWords {
                trouble: Some("contact-held"),
                ..words("command", None)
            },
            GaveUp,
            "contact-held",
        ),
        (
            LastWords {
                job: &RunJob::Dock,
                ..words("docked", None)
            },
            Finished,
            "docked",
        ),
        (
            LastWords {
                job: &RunJob::Dock,
                ..words("dock-not-found", None)
            },
            GaveUp,
            "dock-not-found",
        ),
    ] {
        let ending = Ending::of(words);
        assert_eq!(
            (ending.result, ending.reason.as_str()),
            (result, reason),
            "{words:?}"
        );
    }
    assert_eq!(Ending::of(words("command", None)).text, "Stopped by Anna.");
    assert_eq!(
        Ending::of(words("dock-not-found", Some("finished"))).text,
        "Finished, but did not come home: it did not find the dock in time."
    );
}

#[test]
fn a_job_that_was_done_stays_finished_when_another_order_ends_its_way_home() {
    use RunResult::{Finished, GaveUp, Stopped};
    let clean = clean();
    for (reason, turned_home, result, told) in [
        ("command", "finished", Finished, "finished"),
        ("command", "battery-low", Stopped, "command"),
        ("docked", "no-go-in-the-way", GaveUp, "no-go-in-the-way"),
        (
            "docked",
            "virtual-wall-in-the-way",
            GaveUp,
            "virtual-wall-in-the-way",
        ),
        ("docked", "door-shut", GaveUp, "door-shut"),
        (
            "docked",
            "new-obstacle-in-the-way",
            GaveUp,
            "new-obstacle-in-the-way",
        ),
        ("docked", "most-out-of-reach", GaveUp, "most-out-of-reach"),
    ] {
        let ending = Ending::of(LastWords {
            job: &clean,
            reason,
            turned_home: Some(turned_home),
            trouble: None,
            by: None,
        });
        assert_eq!((ending.result, ending.reason.as_str()), (result, told));
    }
}
