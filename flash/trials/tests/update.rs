//! Updates on a board whose disk, programs and chip are models, and with the chip that is emulated.

use flash_trials::emulated_update::update_emulated;
use flash_trials::update_cuts::cut_everywhere;
use flash_trials::update_model::{ModelChip, ModelChipPort};
use flash_trials::update_world::{Release, UpdateWorld, accepted, key_pair};
use minisign::KeyPair;
use rvac_update::{
    Accepted, ChipError, DaemonEnd, Fallback, Moment, Programs, RealDisk, Settled, Slot, UpdateError, WayBack,
};
use update_bundle::BundleError;

type World = UpdateWorld<ModelChip, ModelChipPort>;

fn world() -> World {
    World::with_model().expect("a folder")
}

/// A board on which update 1 is in use.
fn after_one(pair: &KeyPair) -> World {
    let mut world = world();
    let archive = Release::good(1).packed(pair).expect("packed");
    world.install(&archive, &accepted(pair)).expect("it works");
    world
}

/// The update is refused for this reason, and nothing is changed.
fn check_refusal(
    mut world: World,
    (release, pair): (&Release, &KeyPair),
    accepted: &Accepted,
    expected: fn(&UpdateError) -> bool,
) {
    let archive = release.packed(pair).expect("packed");
    let (files, content) = (world.files(), world.robot.borrow().content.clone());
    let refused = world.install(&archive, accepted).expect_err("it is refused");
    assert!(expected(&refused), "{refused:?}");
    assert!(refused.to_string().starts_with("refused"), "{refused}");
    assert_eq!(world.files(), files, "{refused}");
    assert_eq!(world.robot.borrow().content, content, "{refused}");
}

#[test]
fn an_update_brings_programs_and_firmware_and_the_next_goes_into_the_other_folder() {
    let pair = key_pair();
    let mut world = world();
    for epoch in 1..4 {
        let archive = Release::good(epoch).packed(&pair).expect("packed");
        let outcome = world.install(&archive, &accepted(&pair)).expect("it works");
        assert_eq!(outcome.installed.epoch, epoch);
        assert!(outcome.flashed);
        assert_eq!(world.daemon(), Some(format!("daemon {epoch}")));
        assert_eq!(world.robot.borrow().content, format!("firmware {epoch}"));
        assert_eq!(world.settle().expect("settled"), Settled::Nothing);
    }
    let same_firmware = Release {
        firmware: Some("firmware 3".to_owned()),
        ..Release::good(4)
    };
    let archive = same_firmware.packed(&pair).expect("packed");
    let outcome = world.install(&archive, &accepted(&pair)).expect("it works");
    assert!(!outcome.flashed, "this very image is in the chip");
    let programs_alone = Release {
        firmware: None,
        ..Release::good(5)
    };
    let archive = programs_alone.packed(&pair).expect("packed");
    world.install(&archive, &accepted(&pair)).expect("it works");
    assert_eq!(world.robot.borrow().content, "firmware 3");
}

#[test]
fn what_is_not_for_this_robot_is_refused_and_changes_nothing() {
    let (pair, other) = (key_pair(), key_pair());
    let taken = accepted(&pair);
    let check = |release: Release, signer: &KeyPair, expected: fn(&UpdateError) -> bool| {
        check_refusal(after_one(&pair), (&release, signer), &taken, expected);
    };
    check(Release::good(1), &pair, |error| {
        matches!(
            error,
            UpdateError::OldEpoch {
                installed: 1,
                offered: 1
            }
        )
    });
    check(Release::good(0), &pair, |error| {
        matches!(
            error,
            UpdateError::OldEpoch {
                installed: 1,
                offered: 0
            }
        )
    });
    check(Release::good(2), &other, |error| {
        matches!(error, UpdateError::Bundle(BundleError::UnknownKey))
    });
    let relax = Release {
        robot: "relax",
        ..Release::good(2)
    };
    check(relax, &pair, |error| {
        matches!(error, UpdateError::OtherRobot { .. })
    });
    let for_a_pc = Release {
        machine: "amd64",
        ..Release::good(2)
    };
    check(for_a_pc, &pair, |error| {
        matches!(error, UpdateError::OtherMachine { .. })
    });
}

#[test]
fn a_board_or_chip_that_cannot_take_it_is_named_and_not_touched() {
    let pair = key_pair();
    let taken = accepted(&pair);
    let next = Release::good(2);
    let mut full = after_one(&pair);
    full.claimed_room = 1 << 20;
    check_refusal(full, (&next, &pair), &taken, |error| {
        matches!(error, UpdateError::DiskFull { .. })
    });
    let mut unwired = after_one(&pair);
    unwired.chip = None;
    check_refusal(unwired, (&next, &pair), &taken, |error| {
        matches!(error, UpdateError::NoWiring)
    });
    let undocked = after_one(&pair);
    undocked.robot.borrow_mut().is_unreachable = true;
    check_refusal(undocked, (&next, &pair), &taken, |error| {
        matches!(error, UpdateError::Chip(ChipError::Unreachable(_)))
    });
    let at_work = after_one(&pair);
    at_work.robot.borrow_mut().is_at_work = true;
    check_refusal(at_work, (&next, &pair), &taken, |error| {
        matches!(error, UpdateError::RobotWorks)
    });
    let unknown = Accepted {
        robot: None,
        ..accepted(&pair)
    };
    check_refusal(after_one(&pair), (&next, &pair), &unknown, |error| {
        matches!(error, UpdateError::RobotUnknown)
    });
}

#[test]
fn a_damaged_file_changes_nothing() {
    let pair = key_pair();
    let mut world = after_one(&pair);
    let archive = Release::good(2).packed(&pair).expect("packed");
    let files = world.files();
    let taken = accepted(&pair);
    let mut refused = 0;
    for percent in 0..100 {
        let cut = &archive[..archive.len() * percent / 100];
        let error = world.install(cut, &taken).expect_err("it is cut off");
        assert!(
            matches!(error, UpdateError::Bundle(BundleError::CutOff { .. })),
            "{percent} %: {error}"
        );
        refused += 1;
    }
    // The manifest is the first entry, behind a header of 512 bytes.
    let length = archive
        .iter()
        .skip(512)
        .position(|byte| *byte == 0)
        .expect("its end");
    for at in 512..512 + length {
        let mut changed = archive.clone();
        changed[at] ^= 1;
        let error = world.install(&changed, &taken).expect_err("it was changed");
        assert!(
            matches!(error, UpdateError::Bundle(BundleError::WrongSignature)),
            "byte {at}: {error}"
        );
        refused += 1;
    }
    assert!(refused > 600, "{refused}");
    assert_eq!(world.files(), files);
    assert_eq!(world.robot.borrow().content, "firmware 1");
    world.install(&archive, &taken).expect("the whole one works");
}

#[test]
fn what_does_not_answer_is_undone() {
    let pair = key_pair();
    let broken_daemon = Release {
        daemon: "broken".to_owned(),
        ..Release::good(2)
    };
    let broken_panel = Release {
        panel: "broken".to_owned(),
        ..Release::good(2)
    };
    let silent_robot = Release {
        firmware: Some("silent".to_owned()),
        ..Release::good(2)
    };
    for (release, what) in [
        (broken_daemon, "the daemon"),
        (broken_panel, "the panel"),
        (silent_robot, "the robot"),
    ] {
        let mut world = after_one(&pair);
        let archive = release.packed(&pair).expect("packed");
        let error = world
            .install(&archive, &accepted(&pair))
            .expect_err("it does not work");
        let UpdateError::WentBack(cause) = &error else {
            panic!("{error}");
        };
        assert!(
            matches!(**cause, UpdateError::Silent(silent) if silent == what),
            "{error}"
        );
        assert_eq!(world.daemon().as_deref(), Some("daemon 1"));
        assert_eq!(world.robot.borrow().content, "firmware 1");
        let good = Release::good(2).packed(&pair).expect("packed");
        world
            .install(&good, &accepted(&pair))
            .expect("the next one works");
    }
}

#[test]
fn a_disk_that_fills_in_between_is_undone() {
    let pair = key_pair();
    let mut world = after_one(&pair);
    // The disk says that there is room, and another program takes it.
    world.room = 12;
    let archive = Release::good(2).packed(&pair).expect("packed");
    let error = world
        .install(&archive, &accepted(&pair))
        .expect_err("it does not fit");
    let UpdateError::WentBack(cause) = &error else {
        panic!("{error}");
    };
    let is_full = matches!(&**cause, UpdateError::Bundle(BundleError::Kept { error, .. })
        if error.kind() == std::io::ErrorKind::StorageFull);
    assert!(is_full, "{cause:?}");
    assert_eq!(world.daemon().as_deref(), Some("daemon 1"));
    assert_eq!(world.settle().expect("settled"), Settled::Nothing);
    let spare = world.slots().folder(world.slots().current().spare());
    assert!(!spare.exists(), "no half update stays");
}

#[test]
fn a_chip_that_cannot_be_read_needs_its_owner_s_word() {
    let pair = key_pair();
    let mut world = world();
    world.robot.borrow_mut().is_readable = false;
    let archive = Release::good(1).packed(&pair).expect("packed");
    let error = world
        .install(&archive, &accepted(&pair))
        .expect_err("no way back");
    assert!(
        matches!(&error, UpdateError::WentBack(cause) if matches!(**cause, UpdateError::NoWayBack)),
        "{error}"
    );
    assert_eq!(world.robot.borrow().content, "firmware 0");
    assert_eq!(world.daemon(), None, "the package runs again");
    let bold = Accepted {
        way_back: WayBack::None,
        ..accepted(&pair)
    };
    world.install(&archive, &bold).expect("its owner can do without");
}

#[test]
fn with_the_emulated_chip_a_calibration_stays_and_cuts_and_silent_firmware_are_undone() {
    let cuts = update_emulated(2, 1).expect("trials");
    assert_eq!(cuts.cut, 2);
    assert_eq!((cuts.broken, cuts.mixed, cuts.stuck), (0, 0, 0), "{cuts:?}");
}

#[test]
fn whatever_step_is_cut_off_the_next_run_ends_with_programs_and_firmware_that_run() {
    let cuts = cut_everywhere().expect("trials");
    assert!(cuts.cut > 500, "{cuts:?}");
    assert_eq!((cuts.broken, cuts.mixed, cuts.stuck), (0, 0, 0), "{cuts:?}");
}

/// A second of the first start of a board.
fn second(s: f64) -> Moment {
    Moment {
        boot: "first".to_owned(),
        s,
    }
}

const FAILS: DaemonEnd<'_> = DaemonEnd {
    result: "exit-code",
    status: "1",
};

/// The daemon starts and ends like this so long afterwards; whether the update is given up.
fn starts_and_ends(world: &World, (end, lived_s): (DaemonEnd<'_>, f64)) -> bool {
    let slots = world.slots();
    let mut fallback = Fallback {
        slots: &slots,
        disk: &mut RealDisk,
    };
    fallback.daemon_starts(second(100.0)).expect("a file");
    let ended = fallback.daemon_ended(end, &second(100.0 + lived_s));
    ended.expect("files").is_some()
}

#[test]
fn only_failures_one_after_the_other_and_soon_after_the_start_end_an_update() {
    let pair = key_pair();
    let mut world = after_one(&pair);
    let archive = Release::good(2).packed(&pair).expect("packed");
    world.install(&archive, &accepted(&pair)).expect("it works");
    let is_wanted = DaemonEnd {
        result: "success",
        status: "0",
    };
    let hangs = DaemonEnd {
        result: "timeout",
        status: "TERM",
    };
    let course = [
        (FAILS, 1.0),
        (FAILS, 1.0),
        (is_wanted, 1.0),
        (FAILS, 1.0),
        (FAILS, 1.0),
        // It had started well, so this is the first failure anew.
        (FAILS, 90.0),
        (hangs, 30.0),
    ];
    for step in course {
        assert!(!starts_and_ends(&world, step), "{step:?}");
    }
    assert!(starts_and_ends(&world, (FAILS, 1.0)));
    let (slots, installed) = (world.slots(), world.slots().installed().expect("a file"));
    assert_eq!(slots.current(), Programs::Update(Slot::A));
    assert!(installed.given_up && installed.epoch == 2);
    for _ in 0..4 {
        assert!(
            !starts_and_ends(&world, (FAILS, 1.0)),
            "there is nothing before it"
        );
    }
    assert_eq!(slots.current(), Programs::Update(Slot::A));
}

#[test]
fn the_first_update_gives_way_to_the_programs_of_the_package() {
    let world = after_one(&key_pair());
    assert!(!starts_and_ends(&world, (FAILS, 1.0)));
    assert!(!starts_and_ends(&world, (FAILS, 1.0)));
    assert!(starts_and_ends(&world, (FAILS, 1.0)));
    assert_eq!(world.slots().current(), Programs::Package);
}
