//! Whole updates with the emulated PIC32 as the robot's chip.

use std::cell::RefCell;
use std::rc::Rc;

use minisign::KeyPair;
use pic32::icsp::PortFaults;
use pic32_icsp::{FlashImage, IcspError, IcspPins as _};
use rvac_flash::sr8730::{self, JobError, Keeping};
use rvac_flash::{Backups, Journal, Safeguards, parse_hex};
use rvac_update::{Attempt, Chip, ChipError, UpdateError};

use crate::fixtures::{chip_with, content_of, flash_image, hex_of};
use crate::icsp_pins::{Interruption, LinesLost, SimulatedIcsp, WireFaults};
use crate::update_cuts::UpdateCuts;
use crate::update_world::{Release, RobotEnd, Supply, UpdateFolder, UpdateWorld, accepted, key_pair};

const CLOCK_HZ: u64 = 1_000_000;
/// Where our firmware keeps a calibration, and how one begins.
const CALIBRATION_PAGE: u32 = 0x1D03_F000;
const CALIBRATION: [u8; 12] = [0x52, 0x43, 0x41, 0x4C, 1, 0, 2, 0, 9, 9, 9, 9];

/// The chip with its lines and backups.
#[derive(Debug)]
pub struct EmulatedChip {
    lines: SimulatedIcsp,
    folder: UpdateFolder,
    /// Images that would greet a daemon.
    speaking: Vec<FlashImage>,
}

impl RobotEnd for EmulatedChip {
    fn speaks(&self) -> bool {
        self.speaking.contains(&content_of(self.lines.machine()))
    }
}

impl EmulatedChip {
    fn keeping(&self) -> Keeping {
        Keeping {
            backups: Backups::new(self.folder.path()),
            journal: Journal::new(self.folder.path()),
            date: "2026-01-01T00:00:00Z".to_owned(),
        }
    }
}

/// Its port. When the lines fail, the board's supply has failed.
#[derive(Debug)]
pub struct EmulatedPort {
    chip: Rc<RefCell<EmulatedChip>>,
    supply: Rc<Supply>,
}

type Job<T> = Result<T, JobError<LinesLost>>;

impl EmulatedPort {
    fn work<T>(&self, job: impl FnOnce(&mut SimulatedIcsp, &Keeping) -> Job<T>) -> Result<T, ChipError> {
        let mut chip = self.chip.borrow_mut();
        let keeping = chip.keeping();
        job(&mut chip.lines, &keeping).map_err(|error| {
            if let JobError::Chip(IcspError::Pins(LinesLost)) = error {
                self.supply.fail();
            }
            ChipError::NotWritten(error.to_string())
        })
    }
}

fn image_of(hex: &[u8]) -> Result<FlashImage, ChipError> {
    let refused = |error: String| ChipError::Image(error);
    let text = std::str::from_utf8(hex).map_err(|error| refused(error.to_string()))?;
    let pieces = parse_hex(text).map_err(|error| refused(error.to_string()))?;
    sr8730::image_of(&pieces).map_err(|error| refused(error.to_string()))
}

impl Chip for EmulatedPort {
    fn check(&mut self, hex: &[u8]) -> Result<(), ChipError> {
        image_of(hex)?;
        self.work(|lines, _| sr8730::probe(lines, &mut |_| {})).map(drop)
    }

    fn verified(&self) -> Option<String> {
        self.chip.borrow().keeping().journal.last()?.last_verified
    }

    fn keep(&mut self) -> Result<Option<String>, ChipError> {
        self.work(|lines, keeping| sr8730::backup(lines, keeping, &mut |_| {}))
            .map(Some)
    }

    fn write(&mut self, hex: &[u8], _: Attempt) -> Result<(), ChipError> {
        let image = image_of(hex)?;
        let sure = Safeguards {
            no_way_back: true,
            erase_chip: false,
        };
        self.work(|lines, keeping| sr8730::write(lines, (&image, sure), keeping, &mut |_| {}))
    }

    fn restore(&mut self, name: &str) -> Result<(), ChipError> {
        let backup = Backups::new(self.chip.borrow().folder.path())
            .load(Some(name))
            .map_err(|error| ChipError::NotWritten(error.to_string()))?;
        self.work(|lines, keeping| sr8730::bring_back(lines, &backup, keeping, &mut |_| {}))
    }
}

type EmulatedWorld = UpdateWorld<EmulatedChip, EmulatedPort>;

/// The images of a trial: what is in the chip, with its owner's calibration, and what the update brings.
struct Images {
    present: FlashImage,
    next: FlashImage,
    /// The next one with the calibration.
    expected: FlashImage,
}

impl Images {
    fn new() -> Self {
        let mut present = flash_image(0x2800, 64, 1);
        let next = flash_image(0x1C00, 64, 2);
        let mut expected = next.clone();
        for image in [&mut present, &mut expected] {
            let fits = image.write(CALIBRATION_PAGE, &CALIBRATION);
            debug_assert!(fits, "it is a page of flash");
        }
        Self {
            present,
            next,
            expected,
        }
    }

    fn world(&self, speaking: Vec<FlashImage>) -> std::io::Result<EmulatedWorld> {
        let faults = (WireFaults::default(), PortFaults::default());
        let chip = Rc::new(RefCell::new(EmulatedChip {
            lines: SimulatedIcsp::new(chip_with(&self.present), CLOCK_HZ, faults),
            folder: UpdateFolder::new()?,
            speaking,
        }));
        let supply = Rc::new(Supply::default());
        let port = EmulatedPort {
            chip: Rc::clone(&chip),
            supply: Rc::clone(&supply),
        };
        UpdateWorld::new((supply, chip), port)
    }

    fn release(&self) -> Release {
        Release {
            firmware: Some(hex_of(&self.next)),
            ..Release::good(1)
        }
    }
}

fn content(world: &EmulatedWorld) -> FlashImage {
    content_of(world.robot.borrow().lines.machine())
}

/// One update that works, one whose firmware says nothing, and so many that are cut off while the chip is read or written.
///
/// # Errors
/// When one of the first two does not end as it must.
pub fn update_emulated(moments: u32, seed: u64) -> anyhow::Result<UpdateCuts> {
    let (images, pair) = (Images::new(), key_pair());
    let archive = images.release().packed(&pair)?;
    let speaking = || vec![images.present.clone(), images.expected.clone()];
    let mut whole = images.world(speaking())?;
    let begun_us = whole.robot.borrow().lines.now_us();
    whole.install(&archive, &accepted(&pair))?;
    let span_us = whole.robot.borrow().lines.now_us() - begun_us;
    anyhow::ensure!(content(&whole) == images.expected, "the calibration must stay");
    let mut silent = images.world(vec![images.present.clone()])?;
    let outcome = silent.install(&archive, &accepted(&pair));
    anyhow::ensure!(
        matches!(outcome, Err(UpdateError::WentBack(_))) && content(&silent) == images.present,
        "{outcome:?}"
    );
    let mut cuts = UpdateCuts::default();
    let mut random = home::Pcg::new(seed, 0x0DA7);
    for moment in 0..moments {
        let at_us = begun_us + span_us * u64::from(2 * moment + 1) / u64::from(2 * moments);
        let seed = u64::from(random.next_u32());
        let interruption = match moment % 2 {
            0 => Interruption::PowerCut { at_us, seed },
            _ => Interruption::Killed { at_us },
        };
        let mut world = images.world(speaking())?;
        cut_once(&mut world, interruption, (&archive, &pair, &images), &mut cuts)?;
    }
    Ok(cuts)
}

fn cut_once(
    world: &mut EmulatedWorld,
    interruption: Interruption,
    (archive, pair, images): (&[u8], &KeyPair, &Images),
    cuts: &mut UpdateCuts,
) -> anyhow::Result<()> {
    world.robot.borrow_mut().lines.interrupt(interruption);
    let cut = world.install(archive, &accepted(pair));
    anyhow::ensure!(cut.is_err(), "{interruption:?} is not reached");
    cuts.cut += 1;
    world.robot.borrow_mut().lines.start_again();
    world.supply.come_back(None);
    let settled = world.settle();
    let is_new = world.daemon().is_some();
    let has_new = content(world) == images.expected;
    cuts.broken += u32::from(settled.is_err() || !world.robot.borrow().speaks());
    cuts.mixed += u32::from(is_new != has_new);
    Ok(())
}
