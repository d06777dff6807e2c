//! The attack table: each line is tried against a real server over real sockets. Prints attack, expected and seen, and at
//! the end how many there were and how many came out otherwise; `--json` for programs.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

mod absent;
mod connections;
mod drivers;
mod entrance;
#[path = "../folder/mod.rs"]
mod folder;
mod held;
mod identity;
mod pages;
mod presses;
mod recovery;
mod report;
#[path = "../gate/rig.rs"]
mod rig;
#[path = "../browser/rival.rs"]
mod rival;
#[path = "../browser/robot.rs"]
mod robot;
mod roles;
#[path = "../stack/mod.rs"]
mod stack;
mod texts;
mod tokens;
mod transport;

use std::process::ExitCode;

use report::Report;

#[tokio::main(flavor = "current_thread")]
async fn main() -> ExitCode {
    // A test runner that asks for single tests finds none.
    if std::env::args().any(|argument| argument == "--list") {
        return ExitCode::SUCCESS;
    }
    let mut report = Report::default();
    if std::env::var_os("RVAC_HELD_MOMENTS").is_some() {
        drivers::try_held_only(&mut report).await;
        return end(&report);
    }
    roles::try_all(&mut report).await;
    entrance::try_all(&mut report).await;
    presses::try_all(&mut report).await;
    pages::try_all(&mut report).await;
    tokens::try_all(&mut report).await;
    connections::try_all(&mut report).await;
    transport::try_all(&mut report).await;
    recovery::try_all(&mut report).await;
    drivers::try_all(&mut report).await;
    texts::try_all(&mut report).await;
    identity::try_all(&mut report).await;
    absent::try_all(&mut report).await;
    report.elsewhere(
        "A4: 100,000 guesses on a virtual clock, and A5: 500 races (clients/pairing/tests/door.rs)",
    );
    report.elsewhere("A8 to A12 by real pages in Chromium (panel-server's browser test of foreign pages)");
    report.elsewhere("A20: a name with HTML is text in Chromium (panel-server's browser test of pairing)");
    report.elsewhere("A20: texts of a robot in a terminal (rvac-cli's tests)");
    report.elsewhere("A17: a hundred silent drivers on a virtual clock (scenarios/tests/all/lost_driver.rs)");
    report.elsewhere("A17: a thousand held sticks on a virtual clock (scenarios/tests/all/held_stick.rs)");
    report.elsewhere("A17: browsers that hide, freeze and lose their pad (panel-server's browser tests)");
    report.elsewhere("A24: a window's time on a virtual clock (clients/pairing/tests/door.rs)");
    report.elsewhere("A26: updates unsigned, old, damaged or for another robot (flash/trials/tests/update.rs, rvac-cli's tests, panel-server's browser test)");
    report.elsewhere("A27: the bridge to MQTT is tried by its own tests, and cargo xtask test joined");
    end(&report)
}

/// Prints the report, and whether all came out as it should.
fn end(report: &Report) -> ExitCode {
    let wants_json = std::env::args().any(|argument| argument == "--json");
    println!("{}", if wants_json { report.json() } else { report.text() });
    if report.is_good() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
