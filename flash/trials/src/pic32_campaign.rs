//! The emulated PIC32: there and back, the time it takes, and runs that are cut off.

use std::path::Path;

use anyhow::Context as _;
use flash_trials::fixtures::{chip_with, content_of, flash_image};
use flash_trials::{Interruption, LinesLost, SimulatedIcsp, WireFaults};
use home::Pcg;
use pic32::board::{Blueprint, CalibrationChoice, EmulatedRobot, EmulatedSettings};
use pic32::icsp::PortFaults;
use pic32::image::Image;
use pic32_icsp::{ErasedFirst, FlashImage, IcspError, IcspPins as _, Programmer};
use rvac_flash::{Backups, Journal, Safeguards, sr8730};

use crate::FlashReport;

const CLOCK_HZ: u64 = 1_000_000;
const BYTES: usize = 0x4_0000;

fn lines(image: &FlashImage) -> SimulatedIcsp {
    let faults = (WireFaults::default(), PortFaults::default());
    SimulatedIcsp::new(chip_with(image), CLOCK_HZ, faults)
}

/// A folder of this process that is removed at the end.
pub(crate) struct Scratch(pub(crate) std::path::PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> std::io::Result<Self> {
        let path = std::env::temp_dir().join(format!("bench-flash-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path)?;
        Ok(Self(path))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // A folder that stays behind is no failure of what was tried.
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// Backup, write, verify and restore, as `rvac flash` does them.
pub(crate) fn round_trip(report: &mut FlashReport) -> anyhow::Result<()> {
    let scratch = Scratch::new("sr8730")?;
    let keeping = sr8730::Keeping {
        backups: Backups::new(&scratch.0),
        journal: Journal::new(&scratch.0),
        date: "2026-01-01T00:00:00Z".to_owned(),
    };
    let (makers, ours) = (flash_image(BYTES, 0x2FF0, 1), flash_image(BYTES, 0x2FF0, 9));
    let mut lines = lines(&makers);
    let show = &mut |_| {};
    let name = sr8730::backup(&mut lines, &keeping, show)?;
    let careful = Safeguards::default();
    sr8730::write(&mut lines, (&ours, careful), &keeping, show)?;
    let is_written = content_of(lines.machine()) == ours;
    sr8730::verify(&mut lines, &ours, show)?;
    let backup = keeping.backups.load(Some(&name))?;
    sr8730::restore(&mut lines, (&backup, careful), &keeping, show)?;
    let is_back = content_of(lines.machine()) == makers;
    report.round_trips += 1;
    report.round_trips_identical += u32::from(is_written && is_back && lines.violations().is_empty());
    Ok(())
}

/// The time that 256 KiB take, beside what the wire takes for its bits: four clocks each.
pub(crate) fn pace(report: &mut FlashReport) -> anyhow::Result<()> {
    let mut lines = lines(&flash_image(64, 64, 1));
    let image = flash_image(BYTES, 64, 2);
    let begun_us = lines.now_us();
    Programmer::new(&mut lines, &mut |_| {}).write(&image, ErasedFirst::Pages)?;
    let written_us = lines.now_us();
    Programmer::new(&mut lines, &mut |_| {}).verify(&image)?;
    report.write_256_kib_s = (written_us - begun_us) as f64 / 1e6;
    report.verify_256_kib_s = (lines.now_us() - written_us) as f64 / 1e6;
    report.wire_limit_s = (BYTES * 8 * 4) as f64 / CLOCK_HZ as f64;
    report.write_over_limit = report.write_256_kib_s / report.wire_limit_s;
    Ok(())
}

/// What a run puts into the chip.
struct Intent<'a> {
    image: &'a FlashImage,
    erased: ErasedFirst,
}

fn put(lines: &mut SimulatedIcsp, intent: &Intent<'_>) -> Result<(), IcspError<LinesLost>> {
    let mut progress = |_| {};
    let mut programmer = Programmer::new(lines, &mut progress);
    programmer.write(intent.image, intent.erased)?;
    programmer.release()
}

/// A write and a restore, cut off once in each block and at random moments; then the other of the two, or the same again.
pub(crate) fn cuts((moments, seed): (u32, u64), report: &mut FlashReport) -> anyhow::Result<()> {
    let (makers, ours) = (flash_image(0x2800, 0x300, 1), flash_image(0x1C00, 0x500, 9));
    // Rows of program and boot flash, and the erasures of all pages.
    let blocks = 0x2800_u32 / 0x200 + 0x500 / 0x200 + 67;
    let mut random = Pcg::new(seed, 0xC075);
    for (before, after, erased) in [
        (&makers, &ours, ErasedFirst::Pages),
        (&ours, &makers, ErasedFirst::Chip),
    ] {
        let intent = Intent { image: after, erased };
        let mut whole = lines(before);
        put(&mut whole, &intent)?;
        let span_us = whole.now_us();
        let block_us = (0..blocks).map(|block| span_us * u64::from(2 * block + 1) / u64::from(2 * blocks));
        let random_us = (0..moments.div_ceil(2)).map(|_| u64::from(random.next_u32()) * span_us >> 32);
        let moments_us: Vec<u64> = block_us.chain(random_us).collect();
        for at_us in moments_us {
            let seed = u64::from(random.next_u32());
            let interruption = match seed & 1 {
                0 => Interruption::PowerCut { at_us, seed },
                _ => Interruption::Killed { at_us },
            };
            let mut lines = lines(before);
            lines.interrupt(interruption);
            let cut = put(&mut lines, &intent);
            anyhow::ensure!(
                cut == Err(IcspError::Pins(LinesLost)),
                "{interruption:?}: not cut off, {cut:?}"
            );
            lines.start_again();
            let next = match seed & 2 {
                0 => before,
                _ => after,
            };
            let intent = Intent {
                image: next,
                erased: ErasedFirst::Pages,
            };
            // Whatever a cut left in the configuration words: the whole erasure is always a way in.
            let outcome = put(&mut lines, &intent).or_else(|_| {
                let erased = ErasedFirst::Chip;
                put(&mut lines, &Intent { erased, ..intent })
            });
            report.power_cuts += 1;
            report.bricked += u32::from(outcome.is_err() || content_of(lines.machine()) != *next);
        }
    }
    Ok(())
}

/// The real firmware is written into a chip that held something else; then a robot with this chip is switched on and must speak.
pub(crate) fn firmware_runs(elf: &Path) -> anyhow::Result<bool> {
    let bytes = std::fs::read(elf).with_context(|| elf.display().to_string())?;
    let firmware = Image::from_elf(&bytes)?;
    let wanted = FlashImage::of(firmware.flash(), firmware.boot()).context("sizes of the part")?;
    let mut lines = lines(&flash_image(BYTES, 0x2FF0, 1));
    let mut progress = |_| {};
    let mut programmer = Programmer::new(&mut lines, &mut progress);
    programmer.write(&wanted, ErasedFirst::Pages)?;
    programmer.verify(&wanted)?;
    programmer.release()?;
    let written = content_of(lines.machine());
    let mut image = Image::erased();
    image.write(0x1D00_0000, written.program())?;
    image.write(0x1FC0_0000, written.boot())?;
    let blueprint = Blueprint::sr8730(image, &CalibrationChoice::Complete)?;
    let model = home::RobotModel::by_name("sr8730").context("it comes with the project")?;
    let plan = "format = \"librervac-home\"\nversion = 1\n[[room]]\npolygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n";
    let home = std::sync::Arc::new(home::Home::from_floorplan("room", plan, &model)?);
    let world = home::World::new(home, &model, &home::Noise::ideal(), 1, None);
    let mut robot = EmulatedRobot::new(&blueprint, world, &EmulatedSettings::default());
    let mut said = Vec::new();
    for _ in 0..3_000 {
        robot.tick(&mut said);
    }
    Ok(!said.is_empty())
}
