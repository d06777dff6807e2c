//! How well `bounce` cleans each home under each noise.

use rvac_sim::run::run;
use scenarios::{HOMES, Table, household, scene, settings};

const MINUTES: u64 = 5;

#[test]
fn table_of_outcomes() {
    let mut table = Table::new("outcomes", &format!("bounce, {MINUTES} minutes, seed 1"));
    table.line("home             noise     covered  bumps  stuck  violations");
    for home in HOMES {
        for noise in ["ideal", "nominal", "bad"] {
            let settings = settings(1, MINUTES * 60_000);
            let report =
                run(&mut household(&scene(home, noise), &settings), &settings, |_| {}).expect("an answer");
            table.line(&format!(
                "{home:<16} {noise:<8} {:>7.1} % {:>6} {:>6} {:>11}",
                report.covered * 100.0,
                report.bumps,
                report.stuck,
                report.monitor_violations
            ));
        }
    }
    table.compare();
}
