//! Damaged packets for the C cord under sanitizers: `bench-cord [PACKETS]` prints one JSON object, and fails when one of them
//! moved something.

use anyhow::bail;
use cord_c::corruption::corrupt;
use cord_c::host::HostedCord;
use std::io::Write;

const PACKETS: u64 = 100_000;
const SEED: u64 = 33;

fn main() -> anyhow::Result<()> {
    let packets = std::env::args().nth(1).map_or(Ok(PACKETS), |word| word.parse())?;
    let out = std::env::temp_dir().join(format!("bench-cord-{}", std::process::id()));
    let cord = HostedCord::start(&out);
    let found = cord.and_then(|cord| corrupt(cord, packets, SEED));
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
