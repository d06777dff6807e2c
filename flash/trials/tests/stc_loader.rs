//! The flasher against the simulated loader: the whole way, and what can be wrong.

use flash_trials::{HostFaults, SimulatedLine, SupplyLost};
use rvac_flash::relax::{IspLine as _, JobError};
use stc_isp::{Entry, Flasher, IspError, Job, Model, Report};
use stc90::image::Image;
use stc90::loader::{BootLoader, LoaderFaults};
use stc90::machine::{ClockMode, Options};

fn program(length: usize, seed: u8) -> Vec<u8> {
    (0..length)
        .map(|at| (at as u8).wrapping_mul(31).wrapping_add(seed))
        .collect()
}

fn chip(faults: LoaderFaults) -> BootLoader {
    let mut image = Image::erased();
    assert!(image.write(0, &program(0x8000, 1)));
    BootLoader::new(&image, Options::RELAX, faults)
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Ending {
    Finished(Report),
    Failed(IspError),
    PowerCut,
}

fn converse(loader: &mut BootLoader, host: HostFaults, (job, entry): (Job, Entry)) -> Ending {
    let mut line = SimulatedLine::new(loader, host);
    let flasher = Flasher::new(job, entry, 0).expect("it fits");
    match line.converse(flasher) {
        Ok(report) => Ending::Finished(report),
        Err(JobError::Chip(error)) => Ending::Failed(error),
        Err(error) => {
            assert_eq!(error.to_string(), format!("the serial line: {SupplyLost}"));
            Ending::PowerCut
        }
    }
}

fn write(loader: &mut BootLoader, host: HostFaults, image: &[u8]) -> Ending {
    converse(loader, host, (Job::Write(image.to_vec()), Entry::PowerSwitch))
}

#[test]
fn a_program_is_written_and_runs() {
    for length in [1, 127, 128, 129, 5_000, 0x8000] {
        let image = program(length, 7);
        let mut loader = chip(LoaderFaults::default());
        let ending = write(&mut loader, HostFaults::default(), &image);
        let Ending::Finished(report) = ending else {
            panic!("{length}: {ending:?}");
        };
        assert_eq!((report.written_bytes, report.baud), (length, Some(115_200)));
        assert_eq!(loader.flash()[..length], image);
        assert!(loader.runs_program());
        assert_eq!(loader.image().flash()[..length], image);
    }
}

#[test]
fn every_entry_leads_into_the_loader_and_a_probe_changes_nothing() {
    for entry in [Entry::PowerSwitch, Entry::Person, Entry::Jumped] {
        let mut loader = chip(LoaderFaults::default());
        let before = loader.flash().to_vec();
        let ending = converse(&mut loader, HostFaults::default(), (Job::Probe, entry));
        let Ending::Finished(report) = ending else {
            panic!("{entry:?}: {ending:?}");
        };
        assert_eq!(report.model, Model::RELAX);
        assert!(report.clock.hz.abs_diff(30_000_000) < 30_000);
        assert_eq!(loader.flash(), before);
        assert!(loader.runs_program());
    }
}

#[test]
fn the_twelve_clock_mode_is_kept() {
    let options = Options {
        clock_mode: ClockMode::Twelve,
        crystal_hz: 11_059_200,
        ..Options::RELAX
    };
    let mut loader = BootLoader::new(&Image::erased(), options, LoaderFaults::default());
    let before = loader.option_byte();
    let image = program(600, 3);
    let ending = write(&mut loader, HostFaults::default(), &image);
    assert!(matches!(ending, Ending::Finished(_)), "{ending:?}");
    assert_eq!(loader.option_byte(), before);
    assert_eq!(loader.flash()[..600], image);
}

#[test]
fn what_does_not_fit_or_is_another_chip_is_refused_before_anything_is_touched() {
    for length in [0, 0x8001] {
        let refused = Flasher::new(Job::Write(vec![0; length]), Entry::PowerSwitch, 0).map(|_| ());
        assert_eq!(refused, Err(IspError::ImageSize(length)));
    }
    for id in [0xF130, 0xF108, 0x1234] {
        let mut loader = chip(LoaderFaults {
            model: Some(id),
            ..LoaderFaults::default()
        });
        let before = loader.flash().to_vec();
        let ending = write(&mut loader, HostFaults::default(), &program(100, 2));
        assert_eq!(ending, Ending::Failed(IspError::WrongModel(id)));
        assert_eq!(loader.flash(), before);
    }
}

#[test]
fn a_cable_that_is_slow_gets_a_slower_rate() {
    for (most, expected) in [(60_000, 57_600), (20_000, 19_200), (10_000, 9_600)] {
        let mut loader = chip(LoaderFaults {
            deaf_above_baud: Some(most),
            ..LoaderFaults::default()
        });
        let ending = write(&mut loader, HostFaults::default(), &program(300, 2));
        let Ending::Finished(report) = ending else {
            panic!("{most}: {ending:?}");
        };
        assert_eq!(report.baud, Some(expected));
    }
    let mut loader = chip(LoaderFaults {
        deaf_above_baud: Some(5_000),
        ..LoaderFaults::default()
    });
    let before = loader.flash().to_vec();
    let ending = write(&mut loader, HostFaults::default(), &program(300, 2));
    assert_eq!(ending, Ending::Failed(IspError::NoRate));
    assert_eq!(loader.flash(), before);
}

#[test]
fn a_silent_line_is_named() {
    let swapped = HostFaults {
        is_swapped: true,
        ..HostFaults::default()
    };
    let fed = HostFaults {
        is_fed: true,
        ..HostFaults::default()
    };
    for host in [swapped, fed] {
        let mut loader = chip(LoaderFaults::default());
        let ending = write(&mut loader, host, &program(300, 2));
        assert_eq!(ending, Ending::Failed(IspError::NoLoader), "{host:?}");
    }
}

#[test]
fn noise_and_sleep_cost_time_only() {
    let faults = [
        LoaderFaults {
            garbage_first: true,
            ..LoaderFaults::default()
        },
        LoaderFaults {
            drop_one_in: 9_000,
            seed: 1,
            ..LoaderFaults::default()
        },
        LoaderFaults {
            spoil_one_in: 60,
            seed: 2,
            ..LoaderFaults::default()
        },
    ];
    let image = program(4_000, 9);
    for fault in faults {
        for pause_every in [0, 5, 7] {
            let mut loader = chip(fault);
            let host = HostFaults {
                pause_every,
                ..HostFaults::default()
            };
            let ending = write(&mut loader, host, &image);
            assert!(
                matches!(ending, Ending::Finished(_)),
                "{fault:?} {pause_every}: {ending:?}"
            );
            assert_eq!(loader.flash()[..4_000], image);
        }
    }
}

#[test]
fn a_cell_that_does_not_hold_is_found_by_its_sum() {
    let mut loader = chip(LoaderFaults {
        weak_cell: Some(0x100),
        ..LoaderFaults::default()
    });
    let ending = write(&mut loader, HostFaults::default(), &program(1_000, 2));
    let expected = IspError::BlockSum {
        address: 0x100,
        attempts: 5,
    };
    assert_eq!(ending, Ending::Failed(expected));
}

#[test]
fn after_a_power_cut_at_any_time_the_next_run_writes() {
    let image = program(3_000, 4);
    let span_ms = {
        let mut loader = chip(LoaderFaults::default());
        let mut line = SimulatedLine::new(&mut loader, HostFaults::default());
        let flasher = Flasher::new(Job::Write(image.clone()), Entry::PowerSwitch, 0).expect("it fits");
        line.converse(flasher).expect("nothing is in its way");
        line.now_ms()
    };
    for at_ms in (0..span_ms).step_by(13) {
        let mut loader = chip(LoaderFaults::default());
        let host = HostFaults {
            power_cut_ms: Some(at_ms),
            ..HostFaults::default()
        };
        assert_eq!(write(&mut loader, host, &image), Ending::PowerCut, "{at_ms}");
        let ending = write(&mut loader, HostFaults::default(), &image);
        assert!(matches!(ending, Ending::Finished(_)), "{at_ms}: {ending:?}");
        assert_eq!(loader.flash()[..3_000], image);
        assert!(loader.runs_program());
    }
}
