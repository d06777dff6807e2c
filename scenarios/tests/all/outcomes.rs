//! How well each home is cleaned under each noise, as a table. A change of behaviour shows as a difference of the table:
//! look at it, and when it is what you wanted write the new one with `UPDATE_EXPECTED=1 cargo test -p scenarios`.

use std::fmt::Write;
use std::path::PathBuf;

use rvac_sim::run::{household, run};
use scenarios::{HOMES, scene, settings};

const MINUTES: u64 = 5;

#[test]
fn table_of_outcomes() {
    let mut table = format!(
        "bounce, {MINUTES} minutes, seed 1\n\nhome             noise     covered  bumps  stuck  violations\n"
    );
    for home in HOMES {
        for noise in ["ideal", "nominal", "bad"] {
            let settings = settings(1, MINUTES * 60_000);
            let report =
                run(&mut household(&scene(home, noise), &settings), &settings, |_| {}).expect("an answer");
            writeln!(
                table,
                "{home:<16} {noise:<8} {:>7.1} % {:>6} {:>6} {:>11}",
                report.covered * 100.0,
                report.bumps,
                report.stuck,
                report.monitor_violations
            )
            .unwrap();
        }
    }
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("expected/outcomes.txt");
    if std::env::var_os("UPDATE_EXPECTED").is_some() {
        std::fs::write(&path, &table).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(table, expected, "\nthe table differs; it is now:\n{table}");
}
