//! The stages in the order in which they run: the quick ones first, so that a slip shows at once.

use super::extent::Extent;
use super::runner::Result;
use super::{browser, campaigns, code, flash, joined, packages, programs, robot};

/// One stage.
pub(super) struct Stage {
    /// What `--only` takes.
    pub(super) name: &'static str,
    /// One line for people.
    pub(super) does: &'static str,
    /// The least extent that has this stage.
    pub(super) from: Extent,
    /// What may run beside it.
    pub(super) company: Company,
    /// Runs as much of it as belongs to an extent.
    pub(super) run: fn(Extent) -> Result,
}

/// What may run beside a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Company {
    /// What compiles: the stage measures no time.
    Anything,
    /// The stage that follows it: both wait more than they compute, and judge no time that two cores cannot give to both.
    TheNext,
    /// Nothing: it runs in real time, or measures a time.
    Nothing,
}

/// All stages.
pub(super) const STAGES: [Stage; 21] = [
    Stage {
        name: "fmt",
        does: "the code is formatted",
        from: Extent::Short,
        company: Company::Anything,
        run: code::fmt,
    },
    Stage {
        name: "tidy",
        does: "the rules of the repository hold",
        from: Extent::Short,
        company: Company::Anything,
        run: code::tidy,
    },
    Stage {
        name: "codegen",
        does: "generated files are fresh",
        from: Extent::Short,
        company: Company::Anything,
        run: code::codegen,
    },
    Stage {
        name: "book",
        does: "the book becomes a site in which every link leads somewhere",
        from: Extent::All,
        company: Company::Anything,
        run: code::book,
    },
    Stage {
        name: "clippy",
        does: "the linter finds nothing",
        from: Extent::Short,
        company: Company::Anything,
        run: code::clippy,
    },
    Stage {
        name: "firmware",
        does: "the robot's firmware keeps to its budgets; its parts pass their tests; with --all its bytes are the same anywhere",
        from: Extent::Short,
        company: Company::Anything,
        run: robot::of_firmware,
    },
    Stage {
        name: "emulator",
        does: "the emulated chips run programs as other implementations do",
        from: Extent::All,
        company: Company::Anything,
        run: robot::of_emulator,
    },
    Stage {
        name: "tests",
        does: "unit and integration tests, C and Raku included; those of minutes with --all",
        from: Extent::Short,
        company: Company::Anything,
        run: programs::workspace_tests,
    },
    Stage {
        name: "attacks",
        does: "each line of the attack table, against a real server on real sockets",
        from: Extent::Short,
        company: Company::Anything,
        run: programs::attacks,
    },
    Stage {
        name: "doctests",
        does: "examples in the documentation compile and run",
        from: Extent::All,
        company: Company::Anything,
        run: code::doctests,
    },
    Stage {
        name: "panel",
        does: "tests of the panel's logic",
        from: Extent::Short,
        company: Company::Anything,
        run: programs::panel,
    },
    Stage {
        name: "fuzz",
        does: "the fuzz targets can be built",
        from: Extent::All,
        company: Company::Anything,
        run: code::fuzz,
    },
    Stage {
        name: "link",
        does: "corrupted packets cause no wrong actuation",
        from: Extent::Short,
        company: Company::Anything,
        run: campaigns::link,
    },
    Stage {
        name: "faults",
        does: "simulations with random faults violate nothing",
        from: Extent::Short,
        company: Company::Anything,
        run: campaigns::faults,
    },
    Stage {
        name: "flash",
        does: "firmware goes into the simulated chips and comes back, with cut power; stcgal writes the simulated loader, OpenOCD the emulated chip",
        from: Extent::All,
        company: Company::TheNext,
        run: flash::flash,
    },
    Stage {
        name: "joined",
        does: "the bridges work with mosquitto, Prometheus and Python",
        from: Extent::All,
        company: Company::Nothing,
        run: joined::joined,
    },
    Stage {
        name: "kill",
        does: "a robot stands soon after its daemon was killed",
        from: Extent::All,
        company: Company::Nothing,
        run: campaigns::kill,
    },
    Stage {
        name: "headless",
        does: "the demo cleans without a browser; with --all the emulated robot, too",
        from: Extent::Short,
        company: Company::TheNext,
        run: campaigns::headless,
    },
    Stage {
        name: "writes",
        does: "nothing acknowledged is lost when what keeps it is killed while it writes, or its disk fails",
        from: Extent::All,
        company: Company::Nothing,
        run: campaigns::writes,
    },
    Stage {
        name: "packages",
        does: "a package is installed, set up, used, upgraded and purged in a bare Debian; with --long those that are given out",
        from: Extent::All,
        company: Company::Nothing,
        run: packages::packages,
    },
    Stage {
        name: "browser",
        does: "the demo works in a browser",
        from: Extent::All,
        company: Company::Nothing,
        run: browser::browser,
    },
];
