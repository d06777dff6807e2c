//! Damaged packets for the C cord under sanitizers: `bench-cord [PACKETS [SEED]]` prints one JSON object, and fails when one
//! of them moved something.

use anyhow::bail;
use cord_c::corruption::corrupt;
use cord_c::host::HostedCord;
use std::io::Write;

const PACKETS: u64 = 100_000;
const SEED: u64 = 33;

fn main() -> anyhow::Result<()> {
    let number = |at, usual| std::env::args().nth(at).map_or(Ok(usual), |word| word.parse());
    let (packets, seed) = (number(1, PACKETS)?, number(2, SEED)?);
    let out = std::env::temp_dir().join(format!("bench-cord-{}", std::process::id()));
    let cord = HostedCord::start(&out);
    let found = cord.and_then(|cord| corrupt(cord, packets, seed));
    std::fs::remove_file(&out).ok();
    let found = found?;
    writeln!(
        std::io::stdout(),
        "{{\"host_corrupted\": {}, \"host_wrong_actuation_ms\": {}, \"host_sound\": {}, \"host_sound_moved\": {}}}",
        found.packets,
        found.wrong_actuation_ms,
        found.sound,
        found.sound_moved
    )?;
    if !found.is_right() {
        bail!("a damaged packet moved something, or a sound one did not");
    }
    Ok(())
}
