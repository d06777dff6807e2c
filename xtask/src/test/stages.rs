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
    /// Whether it runs in real time, or measures a time, so that nothing else may run beside it.
    pub(super) wants_the_machine: bool,
    /// Runs as much of it as belongs to an extent.
    pub(super) run: fn(Extent) -> Result,
}

/// All stages.
pub(super) const STAGES: [Stage; 20] = [
    Stage {
        name: "fmt",
        does: "the code is formatted",
        from: Extent::Short,
        wants_the_machine: false,
        run: code::fmt,
    },
    Stage {
        name: "tidy",
        does: "the rules of the repository hold",
        from: Extent::Short,
        wants_the_machine: false,
        run: code::tidy,
    },
    Stage {
        name: "codegen",
        does: "generated files are fresh",
        from: Extent::Short,
        wants_the_machine: false,
        run: code::codegen,
    },
    Stage {
        name: "clippy",
        does: "the linter finds nothing",
        from: Extent::Short,
        wants_the_machine: false,
        run: code::clippy,
    },
    Stage {
        name: "firmware",
        does: "the robot's firmware keeps to its budgets; its parts pass their tests; with --all its bytes are the same anywhere",
        from: Extent::Short,
        wants_the_machine: false,
        run: robot::of_firmware,
    },
    Stage {
        name: "emulator",
        does: "the emulated chips run programs as other implementations do",
        from: Extent::All,
        wants_the_machine: false,
        run: robot::of_emulator,
    },
    Stage {
        name: "tests",
        does: "unit and integration tests, C and Raku included; those of minutes with --all",
        from: Extent::Short,
        wants_the_machine: false,
        run: programs::workspace_tests,
    },
    Stage {
        name: "attacks",
        does: "each line of the attack table, against a real server on real sockets",
        from: Extent::Short,
        wants_the_machine: false,
        run: programs::attacks,
    },
    Stage {
        name: "doctests",
        does: "examples in the documentation compile and run",
        from: Extent::All,
        wants_the_machine: false,
        run: code::doctests,
    },
    Stage {
        name: "panel",
        does: "tests of the panel's logic",
        from: Extent::Short,
        wants_the_machine: false,
        run: programs::panel,
    },
    Stage {
        name: "fuzz",
        does: "the fuzz targets can be built",
        from: Extent::All,
        wants_the_machine: false,
        run: code::fuzz,
    },
    Stage {
        name: "link",
        does: "corrupted packets cause no wrong actuation",
        from: Extent::Short,
        wants_the_machine: false,
        run: campaigns::link,
    },
    Stage {
        name: "faults",
        does: "simulations with random faults violate nothing",
        from: Extent::Short,
        wants_the_machine: false,
        run: campaigns::faults,
    },
    Stage {
        name: "flash",
        does: "firmware goes into the simulated chips and comes back, with cut power; stcgal writes the simulated loader",
        from: Extent::All,
        wants_the_machine: true,
        run: flash::flash,
    },
    Stage {
        name: "joined",
        does: "the bridges work with mosquitto, Prometheus and Python",
        from: Extent::All,
        wants_the_machine: true,
        run: joined::joined,
    },
    Stage {
        name: "headless",
        does: "the demo cleans without a browser; with --all the emulated robot, too",
        from: Extent::Short,
        wants_the_machine: true,
        run: campaigns::headless,
    },
    Stage {
        name: "kill",
        does: "a robot stands soon after its daemon was killed",
        from: Extent::All,
        wants_the_machine: true,
        run: campaigns::kill,
    },
    Stage {
        name: "writes",
        does: "nothing acknowledged is lost when what keeps it is killed while it writes",
        from: Extent::All,
        wants_the_machine: true,
        run: campaigns::writes,
    },
    Stage {
        name: "packages",
        does: "a package is installed, set up, used, upgraded and purged in a bare Debian; with --long those that are given out",
        from: Extent::All,
        wants_the_machine: true,
        run: packages::packages,
    },
    Stage {
        name: "browser",
        does: "the demo works in a browser",
        from: Extent::All,
        wants_the_machine: true,
        run: browser::browser,
    },
];
