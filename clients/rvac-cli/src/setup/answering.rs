//! What the daemon and the panel's server say when they are asked.

use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use rvac_api::{RobotDescription, Status, Topic, Update};

use crate::arguments::{Console, Daemon};
use crate::board::Finding;
use crate::socket::Connection;

/// The daemon tells its state at once; this covers a small board at its start.
const PATIENCE: Duration = Duration::from_secs(5);
/// Inhibits that belong to a robot in order: it waits for a start, on its dock.
const EXPECTED: [&str; 2] = ["not-armed", "docked"];

/// What is heard of the daemon, the robot and the panel's server.
pub(super) fn all(daemon: &Daemon, console: &Console) -> Vec<Finding> {
    let mut findings = match ask(daemon) {
        Err(error) => vec![Finding::fault(
            "daemon",
            format!("{error:#}"),
            "systemctl start vthal; journalctl -u vthal says why it does not run",
        )],
        Ok((status, robot)) => {
            let mut findings = vec![Finding::good("daemon", "answers")];
            findings.extend(of_robot(&status, robot.as_ref()));
            findings
        }
    };
    findings.push(match UnixStream::connect(&console.console) {
        Ok(_) => Finding::good("panel", "answers"),
        Err(error) => Finding::fault(
            "panel",
            format!("cannot reach panel-server at {}: {error}", console.console.display()),
            "systemctl start rvac-panel; journalctl -u rvac-panel says why it does not run; or start this with sudo",
        ),
    });
    findings
}

fn ask(daemon: &Daemon) -> anyhow::Result<(Status, Option<RobotDescription>)> {
    let mut connection = Connection::open(daemon)?;
    connection.watch(vec![Topic::Status])?;
    let deadline = Instant::now() + PATIENCE;
    let mut robot = None;
    while let Some(message) = connection.receive_until(deadline)? {
        match message.update {
            Some(Update::Hello { robot: told, .. }) => robot = told,
            Some(Update::Status(status)) => return Ok((status, robot)),
            _ => {}
        }
    }
    anyhow::bail!("vthal tells nothing")
}

fn of_robot(status: &Status, robot: Option<&RobotDescription>) -> Vec<Finding> {
    let Some(robot) = robot else {
        let told = rvac_api::explain(&status.reason);
        return vec![Finding::fault(
            "robot",
            told.map_or(status.reason.as_str(), |told| told.cause),
            told.map_or("check its cable", |told| told.remedy),
        )];
    };
    let mut findings = vec![Finding::good("robot", format!("{} answers", robot.device))];
    for inhibit in status
        .inhibits
        .iter()
        .filter(|name| !EXPECTED.contains(&name.as_str()))
    {
        let told = rvac_api::explain(inhibit);
        findings.push(Finding::fault(
            "robot",
            told.map_or(inhibit.as_str(), |told| told.cause),
            told.map_or("look at the panel", |told| told.remedy),
        ));
    }
    findings.extend(robot.lacking.iter().map(|one| {
        Finding::warning(
            "calibration",
            format!("{} is absent until it is measured", one.ability),
            format!("rvac calibrate {}", one.values.join(" ")),
        )
    }));
    findings
}
