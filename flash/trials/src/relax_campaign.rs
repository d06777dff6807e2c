//! The simulated loader of the STC90: there and back, runs that are cut off, and flashers on a terminal.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::Context as _;
use flash_trials::fixtures::noise;
use flash_trials::{HostFaults, LoaderTerminal, SimulatedLine};
use home::Pcg;
use rvac_flash::relax::{self, IspLine as _};
use rvac_flash::{Journal, Safeguards, SerialLine};
use stc_isp::{Entry, Flasher, Job};
use stc90::image::Image;
use stc90::loader::{BootLoader, LoaderFaults};
use stc90::machine::Options;

use crate::FlashReport;
use crate::pic32_campaign::Scratch;

const CODE_BYTES: usize = 0x8000;
/// stcgal and a slow machine.
const STCGAL_WAIT: Duration = Duration::from_secs(90);

fn chip(program: &[u8]) -> BootLoader {
    let mut image = Image::erased();
    let fits = image.write(0, program);
    debug_assert!(fits, "flash has the size of flash");
    BootLoader::new(&image, Options::RELAX, LoaderFaults::default())
}

/// An image of ours, another one, and back to the first, as `rvac flash` does it.
pub(crate) fn round_trip(report: &mut FlashReport) -> anyhow::Result<()> {
    let scratch = Scratch::new("relax")?;
    let keeping = relax::Keeping {
        folder: scratch.0.clone(),
        journal: Journal::new(&scratch.0),
        date: "2026-01-01T00:00:00Z".to_owned(),
    };
    let (makers, first, second) = (noise(CODE_BYTES, 1), noise(20_000, 2), noise(CODE_BYTES, 3));
    let mut loader = chip(&makers);
    let mut flash = |image: &[u8], safeguards| {
        let mut line = SimulatedLine::new(&mut loader, HostFaults::default());
        relax::write(
            &mut line,
            (image, safeguards, Entry::PowerSwitch),
            &keeping,
            &mut |_, _| {},
        )?;
        anyhow::Ok(loader.flash().starts_with(image) && loader.runs_program())
    };
    let careful = Safeguards::default();
    let is_refused = flash(&first, careful).is_err();
    let bold = Safeguards {
        no_way_back: true,
        ..careful
    };
    let is_first = flash(&first, bold)?;
    let back = keeping.way_back().context("the first image is known")?;
    let is_second = flash(&second, careful)?;
    let is_back = flash(&back, careful)? && back == first;
    report.round_trips += 1;
    report.round_trips_identical += u32::from(is_refused && is_first && is_second && is_back);
    Ok(())
}

/// A write that is cut off in each block and at random moments; then another one.
pub(crate) fn cuts((moments, seed): (u32, u64), report: &mut FlashReport) -> anyhow::Result<()> {
    let (before, after) = (noise(CODE_BYTES, 1), noise(CODE_BYTES, 2));
    let run = |loader: &mut BootLoader, image: &[u8], power_cut_ms| {
        let faults = HostFaults {
            power_cut_ms,
            ..HostFaults::default()
        };
        let mut line = SimulatedLine::new(loader, faults);
        let flasher = Flasher::new(Job::Write(image.to_vec()), Entry::PowerSwitch, 0)?;
        let outcome = line.converse(flasher);
        let ended_ms = line.now_ms();
        anyhow::Ok((outcome, ended_ms))
    };
    let (_, span_ms) = run(&mut chip(&before), &after, None)?;
    let blocks = (CODE_BYTES / 128) as u64;
    let mut random = Pcg::new(seed, 0xC057);
    let block_ms = (0..blocks).map(|block| span_ms * (2 * block + 1) / (2 * blocks));
    let random_ms = (0..moments).map(|_| u64::from(random.next_u32()) * span_ms >> 32);
    let all_ms: Vec<u64> = block_ms.chain(random_ms).collect();
    for (index, at_ms) in all_ms.into_iter().enumerate() {
        let mut loader = chip(&before);
        let (cut, _) = run(&mut loader, &after, Some(at_ms))?;
        anyhow::ensure!(cut.is_err(), "{at_ms} ms: not cut off");
        let next = if index % 2 == 0 { &before } else { &after };
        let (outcome, _) = run(&mut loader, next, None)?;
        report.power_cuts += 1;
        let is_back = outcome.is_ok() && loader.flash() == next && loader.runs_program();
        report.bricked += u32::from(!is_back);
    }
    Ok(())
}

/// Our flasher, on a terminal.
pub(crate) fn own_flasher_programs() -> anyhow::Result<bool> {
    let image = noise(5_000, 4);
    let terminal = LoaderTerminal::start(chip(&noise(CODE_BYTES, 1)))?;
    let mut line = SerialLine::open(terminal.path(), None)?;
    let flasher = Flasher::new(Job::Write(image.clone()), Entry::Person, line.now_ms())?;
    let outcome = relax::converse(&mut line, flasher, &mut |_, _| {});
    let loader = terminal.end()?;
    outcome?;
    Ok(loader.flash().starts_with(&image) && loader.runs_program())
}

/// stcgal, which nobody here wrote, on the same terminal.
pub(crate) fn stcgal_programs(stcgal: &Path) -> anyhow::Result<bool> {
    let scratch = Scratch::new("stcgal")?;
    let image = noise(5_120, 5);
    let file = scratch.0.join("program.bin");
    std::fs::File::create(&file)?.write_all(&image)?;
    let chip = chip(&noise(CODE_BYTES, 1));
    let options_before = chip.option_byte();
    let terminal = LoaderTerminal::start(chip)?;
    let mut child = Command::new(stcgal)
        .args(["-P", "stc89", "-b", "115200", "-p"])
        .args([terminal.path(), &file])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::inherit())
        .spawn()
        .with_context(|| stcgal.display().to_string())?;
    let deadline = Instant::now() + STCGAL_WAIT;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if Instant::now() >= deadline {
            child.kill()?;
            child.wait()?;
            break None;
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let loader = terminal.end()?;
    let is_done = status.is_some_and(|status| status.success());
    let is_written = loader.flash().starts_with(&image) && loader.runs_program();
    Ok(is_done && is_written && loader.option_byte() == options_before)
}
