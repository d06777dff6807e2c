//! A bit of the program flips in the flash: the next start finds it.

use super::testbed::RelaxTestbed;
use crate::campaign::TrialSummary;
use crate::limits;
use rvac_protocol::message::Inhibit;
use stc90::board::CYCLES_PER_MS;
use stc90::hosted::{HostedBlueprint, HostedError};
use stc90::image::Image;

/// The first report comes so soon after the handshake.
const REPORT_MS: u64 = 500;

/// The program as it is flashed, with each bit of a text flipped in turn that it says on a fault only: what it does goes on.
/// The time counts from power-on to the report, and no robot may let itself be armed.
///
/// # Errors
/// When the text is no image, or a robot does not answer.
pub fn flipped_flash(hex: &str) -> Result<TrialSummary, HostedError> {
    let image = Image::from_hex(hex)?;
    let text = Inhibit::ChargerShorted.name().as_bytes();
    let place = image.flash().windows(text.len()).position(|bytes| bytes == text);
    let mut found = Vec::new();
    for bit in 0..8 {
        let mut wrong = image.clone();
        let flipped = place.and_then(|at| Some((at, image.flash().get(at)? ^ 1 << bit)));
        let is_written = flipped.is_some_and(|(at, byte)| wrong.write(at as u32, &[byte]));
        let mut testbed = RelaxTestbed::connected(&HostedBlueprint::new(wrong)?)?;
        testbed.run(REPORT_MS);
        let says = testbed.pair().inhibits().contains(Inhibit::Memory);
        let ms = testbed.cycle() as f64 / CYCLES_PER_MS as f64;
        let is_kept = is_written && says && testbed.pair.arm().is_err();
        found.push((is_kept, ms));
    }
    let worst_ms = found.iter().map(|(_, ms)| *ms).fold(0.0, f64::max);
    let broken = found.iter().filter(|(is_kept, _)| !is_kept).count();
    Ok(TrialSummary {
        name: "image-bit-flips",
        rule: "S21",
        what: "a bit of the image flips: the next start says so, and lets nobody arm",
        limit: limits::S21_MEMORY.name,
        allowance: None,
        phases: found.len(),
        spread_ms: 0,
        worst_ms: Some(worst_ms),
        mean_ms: worst_ms,
        limit_ms: limits::S21_MEMORY.ms,
        broken,
        violations: 0,
        said: Vec::new(),
    })
}
