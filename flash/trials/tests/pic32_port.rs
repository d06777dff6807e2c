//! The programmer against the emulated PIC32: the whole way there and back, and what can be wrong.

use calibration_values::{Catalog, MAGIC, Measurements, RECORD_ADDRESS, record};
use flash_trials::fixtures::{chip_with, content_of, flash_image};
use flash_trials::{Interruption, LinesLost, SimulatedIcsp, WireFaults};
use pic32::board::CalibrationValues;
use pic32::icsp::PortFaults;
use pic32::machine::Machine;
use pic32::pins::Level;
use pic32_icsp::{ConfigurationRisk, ErasedFirst, FlashImage, IcspError, LineLevel, Programmer};
use rvac_flash::sr8730::{self, JobError, Keeping};
use rvac_flash::{Backups, Journal, Safeguards};

const MHZ: u64 = 1_000_000;
/// DEVCFG0 with nothing protected.
const OPEN: u32 = 0x7FFF_FFFF;

/// Both flashes full.
fn full(seed: u64) -> FlashImage {
    flash_image(0x4_0000, 0x2FF0, seed)
}

/// A few pages only: quick.
fn small(seed: u64) -> FlashImage {
    flash_image(0x2800, 64, seed)
}

fn lines(machine: Machine, port: PortFaults, wires: WireFaults) -> SimulatedIcsp {
    SimulatedIcsp::new(machine, MHZ, (wires, port))
}

fn write(
    lines: &mut SimulatedIcsp,
    image: &FlashImage,
    erased: ErasedFirst,
) -> Result<(), IcspError<LinesLost>> {
    let mut progress = |_| {};
    let mut programmer = Programmer::new(lines, &mut progress);
    programmer.write(image, erased)?;
    programmer.verify(image)?;
    programmer.release()
}

#[test]
fn a_chip_is_read_written_verified_and_restored() {
    let (makers, ours) = (full(1), full(2));
    let mut lines = lines(chip_with(&makers), PortFaults::default(), WireFaults::default());
    let mut progress = |_| {};
    let mut programmer = Programmer::new(&mut lines, &mut progress);
    assert_eq!(programmer.probe().expect("a chip") & 0x0FFF_FFFF, 0x0093_4053);
    let backup = programmer.read().expect("can be read");
    assert_eq!(backup, makers);
    programmer
        .write(&ours, ErasedFirst::Pages)
        .expect("can be written");
    programmer.verify(&ours).expect("is there");
    assert!(matches!(
        programmer.verify(&makers),
        Err(IcspError::Differs { .. })
    ));
    programmer
        .write(&backup, ErasedFirst::Chip)
        .expect("can be restored");
    programmer.verify(&makers).expect("is there again");
    programmer.release().expect("runs");
    assert_eq!(content_of(lines.machine()), makers);
    assert_eq!(lines.violations(), []);
}

#[test]
fn what_was_written_boots() {
    // lui t0, 0xBF88; sw zero to TRISE; ori t1, 1; sw t1 to LATE; loop.
    let words: [u32; 7] = [
        0x3C08_BF88,
        0xAD00_6100,
        0x3409_0001,
        0xAD09_6120,
        0x1000_FFFF,
        0,
        0,
    ];
    let mut image = FlashImage::erased();
    let code: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
    assert!(image.write(0x1FC0_0000, &code));
    assert!(image.write(0x1FC0_2FFC, &OPEN.to_le_bytes()));
    let mut lines = lines(chip_with(&small(3)), PortFaults::default(), WireFaults::default());
    let pin = "RE0".parse().expect("a pin");
    lines.run_ms(5);
    assert!(!lines.machine().output(pin).is_high());
    write(&mut lines, &image, ErasedFirst::Pages).expect("can be written");
    lines.run_ms(5);
    assert!(lines.machine().output(pin).is_high());
}

#[test]
fn wrong_chips_and_wires_are_refused_before_anything_is_touched() {
    let makers = small(1);
    let stuck = |level| PortFaults {
        stuck_data: Some(level),
        ..PortFaults::default()
    };
    let id = |id| PortFaults {
        device_id: Some(id),
        ..PortFaults::default()
    };
    let swapped = WireFaults {
        is_swapped: true,
        ..WireFaults::default()
    };
    let deaf = PortFaults {
        is_deaf: true,
        ..PortFaults::default()
    };
    let protected = PortFaults {
        is_protected: true,
        ..PortFaults::default()
    };
    let fine = WireFaults::default();
    let cases = [
        (stuck(Level::High), fine, IcspError::NoAnswer(LineLevel::High)),
        (stuck(Level::Low), fine, IcspError::NoAnswer(LineLevel::Low)),
        (
            PortFaults::default(),
            swapped,
            IcspError::NoAnswer(LineLevel::Low),
        ),
        (deaf, fine, IcspError::NoAnswer(LineLevel::Low)),
        (id(0x1093_8053), fine, IcspError::WrongPart(0x1093_8053)),
        (id(0x1234_5678), fine, IcspError::WrongPart(0x1234_5678)),
        (protected, fine, IcspError::CodeProtected),
    ];
    for (port, wires, expected) in cases {
        let mut lines = lines(chip_with(&makers), port, wires);
        assert_eq!(
            write(&mut lines, &small(2), ErasedFirst::Pages),
            Err(expected.clone())
        );
        assert_eq!(content_of(lines.machine()), makers, "{expected}");
    }
}

#[test]
fn a_protected_chip_is_entered_by_erasing_all_of_it_only() {
    let mut makers = small(1);
    assert!(makers.write(0x1FC0_2FFC, &(OPEN & !(1 << 28)).to_le_bytes()));
    assert_eq!(
        makers.configuration_risk(),
        Some(ConfigurationRisk::CodeProtection)
    );
    let mut lines = lines(chip_with(&makers), PortFaults::default(), WireFaults::default());
    assert_eq!(
        write(&mut lines, &small(2), ErasedFirst::Pages),
        Err(IcspError::CodeProtected)
    );
    assert_eq!(content_of(lines.machine()), makers);
    assert_eq!(write(&mut lines, &small(2), ErasedFirst::Chip), Ok(()));
    assert_eq!(content_of(lines.machine()), small(2));
}

#[test]
fn write_protected_pages_are_reported_and_a_whole_erasure_helps() {
    let mut makers = small(1);
    assert!(makers.write(0x1FC0_2FFC, &(OPEN & !(1 << 24)).to_le_bytes()));
    let mut lines = lines(chip_with(&makers), PortFaults::default(), WireFaults::default());
    let refused = write(&mut lines, &small(2), ErasedFirst::Pages);
    assert!(
        matches!(refused, Err(IcspError::FlashRefused { .. })),
        "{refused:?}"
    );
    assert_eq!(write(&mut lines, &small(2), ErasedFirst::Chip), Ok(()));
}

#[test]
fn flash_that_is_worn_out_is_reported() {
    let mut machine = chip_with(&small(1));
    machine.wear_out_flash();
    let mut lines = lines(machine, PortFaults::default(), WireFaults::default());
    let refused = write(&mut lines, &small(2), ErasedFirst::Pages);
    assert!(
        matches!(refused, Err(IcspError::FlashRefused { .. })),
        "{refused:?}"
    );
}

#[test]
fn noise_sleep_and_a_late_core_cost_time_only() {
    let noisy = |flip_one_in, seed| PortFaults {
        flip_one_in,
        seed,
        ..PortFaults::default()
    };
    let late = PortFaults {
        late_polls: 3,
        ..PortFaults::default()
    };
    let slow = |pause_every| WireFaults {
        pause_every,
        ..WireFaults::default()
    };
    let cases = [
        (noisy(200_000, 1), slow(0)),
        (noisy(60_000, 2), slow(0)),
        (late, slow(0)),
        (PortFaults::default(), slow(20_011)),
        (PortFaults::default(), slow(997)),
        (noisy(100_000, 3), slow(10_007)),
    ];
    for (port, wires) in cases {
        let mut lines = lines(chip_with(&small(1)), port, wires);
        assert_eq!(
            write(&mut lines, &small(2), ErasedFirst::Pages),
            Ok(()),
            "{port:?} {wires:?}"
        );
        assert_eq!(content_of(lines.machine()), small(2));
    }
}

#[test]
fn a_line_that_is_too_noisy_is_named() {
    let port = PortFaults {
        flip_one_in: 400,
        seed: 5,
        ..PortFaults::default()
    };
    let mut lines = lines(chip_with(&small(1)), port, WireFaults::default());
    let refused = write(&mut lines, &small(2), ErasedFirst::Pages);
    let is_named = matches!(
        refused,
        Err(IcspError::LineFaulty { .. }
            | IcspError::Unsteady { .. }
            | IcspError::NotReady(_)
            | IcspError::CoreSilent)
    );
    assert!(is_named, "{refused:?}");
}

/// FWDTEN with a period of 1 ms, far less than a page takes on the wire.
#[test]
fn a_watchdog_that_is_always_on_waits_for_the_programmer() {
    let guarded = |seed| {
        let mut image = small(seed);
        assert!(image.write(0x1FC0_2FF8, &0xFFE0_CED8_u32.to_le_bytes()));
        image
    };
    for erased in [ErasedFirst::Pages, ErasedFirst::Chip] {
        let mut lines = lines(
            chip_with(&guarded(1)),
            PortFaults::default(),
            WireFaults::default(),
        );
        assert_eq!(write(&mut lines, &guarded(2), erased), Ok(()), "{erased:?}");
        assert_eq!(content_of(lines.machine()), guarded(2));
        lines.run_ms(5);
        let barked =
            |reset: &pic32::machine::ResetEvent| reset.source == pic32::peripheral::ResetSource::Watchdog;
        assert!(
            lines.machine().resets().iter().any(barked),
            "once it runs, the watchdog barks: {erased:?}"
        );
    }
}

#[test]
fn after_a_power_cut_or_a_kill_the_next_run_writes() {
    let write =
        |lines: &mut SimulatedIcsp| Programmer::new(lines, &mut |_| {}).write(&small(2), ErasedFirst::Pages);
    let span_us = {
        let mut lines = lines(chip_with(&small(1)), PortFaults::default(), WireFaults::default());
        write(&mut lines).expect("can be written");
        pic32_icsp::IcspPins::now_us(&lines)
    };
    for part in 0..12 {
        let at_us = span_us * part / 12 + 1;
        for interruption in [
            Interruption::PowerCut { at_us, seed: part },
            Interruption::Killed { at_us },
        ] {
            let mut lines = lines(chip_with(&small(1)), PortFaults::default(), WireFaults::default());
            lines.interrupt(interruption);
            let cut = write(&mut lines);
            assert_eq!(cut, Err(IcspError::Pins(LinesLost)), "{interruption:?}");
            lines.start_again();
            assert_eq!(write(&mut lines), Ok(()), "{interruption:?}");
            assert_eq!(content_of(lines.machine()), small(2));
        }
    }
}

#[test]
fn a_calibration_outlives_a_write() {
    let mut before = small(1);
    let record = [&0x4C41_4352_u32.to_le_bytes()[..], &[1, 0, 2, 0, 9, 9, 9, 9]].concat();
    assert!(before.write(0x1D03_F000, &record));
    let mut lines = lines(chip_with(&before), PortFaults::default(), WireFaults::default());
    let folder = std::env::temp_dir().join(format!("flash-calibration-{}", std::process::id()));
    let keeping = keeping(&folder);
    let careful = Safeguards::default();
    let refused = sr8730::write(&mut lines, (&small(2), careful), &keeping, &mut |_| {});
    assert!(matches!(refused, Err(JobError::NoWayBack)), "{refused:?}");
    assert_eq!(content_of(lines.machine()), before);
    let bold = Safeguards {
        no_way_back: true,
        ..careful
    };
    sr8730::write(&mut lines, (&small(2), bold), &keeping, &mut |_| {}).expect("can be written");
    sr8730::verify(&mut lines, &small(2), &mut |_| {}).expect("it is there, with the calibration");
    std::fs::remove_dir_all(&folder).expect("the journal was there");
    let mut wanted = small(2);
    assert!(wanted.write(0x1D03_F000, &record));
    assert_eq!(content_of(lines.machine()), wanted);
}

fn keeping(folder: &std::path::Path) -> Keeping {
    Keeping {
        backups: Backups::new(folder),
        journal: Journal::new(folder),
        date: "2026-01-01T00:00:00Z".to_owned(),
    }
}

/// All values of the simulated robot as an owner's file, and the record that the emulator makes of them in its own way.
fn measured() -> (Vec<u8>, Vec<u8>) {
    let values = CalibrationValues::sr8730().expect("the project's own");
    let catalog = Catalog::of("sr8730").expect("known");
    let mut file = String::from("robot = \"sr8730\"\n[values]\n");
    for item in &catalog.items {
        let name: &'static str = item.name.clone().leak();
        let value = values.value(name).expect("listed");
        file.push_str(&format!("{name} = {value}\n"));
    }
    let measured = Measurements::parse("mine.toml".as_ref(), &file, &catalog).expect("valid");
    let ours = record(&catalog, &measured).expect("in range");
    (ours, values.record_without(&[]))
}

#[test]
fn a_calibration_is_written_beside_the_firmware_and_replaced() {
    let (ours, emulators) = measured();
    assert_eq!(ours, emulators);
    let mut lines = lines(chip_with(&small(1)), PortFaults::default(), WireFaults::default());
    let other = [&MAGIC.to_le_bytes()[..], &[1, 0, 2, 0, 9, 9, 9, 9]].concat();
    let folder = std::env::temp_dir().join(format!("flash-record-{}", std::process::id()));
    let keeping = keeping(&folder);
    for record in [other, ours] {
        sr8730::write_calibration(&mut lines, &record, &keeping, &mut |_| {}).expect("can be written");
        let mut wanted = small(1);
        assert!(wanted.write(RECORD_ADDRESS, &record));
        assert_eq!(content_of(lines.machine()), wanted);
    }
    assert_eq!(lines.violations(), []);
    assert_eq!(keeping.journal.warning(), None);
    std::fs::remove_dir_all(&folder).expect("the journal was there");
}

#[test]
fn a_page_that_holds_something_else_is_not_taken_for_a_calibration() {
    let makers = full(1);
    let mut lines = lines(chip_with(&makers), PortFaults::default(), WireFaults::default());
    let nowhere = keeping("/nonexistent".as_ref());
    let refused = sr8730::write_calibration(&mut lines, &measured().0, &nowhere, &mut |_| {});
    assert!(matches!(refused, Err(JobError::PageOccupied)), "{refused:?}");
    assert_eq!(content_of(lines.machine()), makers);
}

#[test]
fn a_calibration_that_is_cut_off_leaves_the_firmware_and_is_written_again() {
    let record = measured().0;
    let mut before = small(1);
    assert!(before.write(
        RECORD_ADDRESS,
        &[&MAGIC.to_le_bytes()[..], &[1, 0, 2, 0, 9, 9, 9, 9]].concat()
    ));
    let mut wanted = small(1);
    assert!(wanted.write(RECORD_ADDRESS, &record));
    let folder = std::env::temp_dir().join(format!("flash-cut-record-{}", std::process::id()));
    let keeping = keeping(&folder);
    let put = |lines: &mut SimulatedIcsp| sr8730::write_calibration(lines, &record, &keeping, &mut |_| {});
    let span_us = {
        let mut lines = lines(chip_with(&before), PortFaults::default(), WireFaults::default());
        put(&mut lines).expect("can be written");
        pic32_icsp::IcspPins::now_us(&lines)
    };
    for part in 0..25 {
        let at_us = span_us * part / 25 + 1;
        for interruption in [
            Interruption::PowerCut { at_us, seed: part },
            Interruption::Killed { at_us },
        ] {
            let mut lines = lines(chip_with(&before), PortFaults::default(), WireFaults::default());
            lines.interrupt(interruption);
            let cut = put(&mut lines);
            assert!(
                matches!(cut, Err(JobError::Chip(IcspError::Pins(LinesLost)))),
                "{interruption:?}: {cut:?}"
            );
            let left = content_of(lines.machine());
            let last_page = pic32_icsp::PROGRAM_BYTES - pic32_icsp::PAGE_BYTES;
            assert_eq!(
                left.program()[..last_page],
                before.program()[..last_page],
                "{interruption:?}"
            );
            assert_eq!(left.boot(), before.boot(), "{interruption:?}");
            lines.start_again();
            put(&mut lines).unwrap_or_else(|error| panic!("{interruption:?}: {error}"));
            assert_eq!(content_of(lines.machine()), wanted, "{interruption:?}");
            assert_eq!(keeping.journal.warning(), None);
        }
    }
    std::fs::remove_dir_all(&folder).expect("the journal was there");
}
