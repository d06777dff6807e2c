//! The robot's map of the home, requested once.

use std::time::Instant;

use anyhow::bail;
use rvac_api::{Estimate, HomeView, Pose, Topic, Update};

use crate::control::ANSWER;
use crate::socket::Connection;

/// The home, how sure the robot is of its place, and where that is.
#[derive(Debug)]
pub(crate) struct KnownHome {
    pub(crate) home: HomeView,
    /// The daemon's own JSON of the home.
    pub(crate) text: String,
    pub(crate) estimate: Option<Estimate>,
    pub(crate) pose: Option<Pose>,
}

pub(crate) fn ask(connection: &mut Connection) -> anyhow::Result<KnownHome> {
    // Views come in this order, and those that a daemon without a robot does not have are left out: the status ends them.
    connection.watch(vec![Topic::Home, Topic::Estimate, Topic::Pose, Topic::Status])?;
    let deadline = Instant::now() + ANSWER;
    let (mut found, mut estimate, mut pose) = (None, None, None);
    loop {
        let Some(message) = connection.receive_until(deadline)? else {
            bail!("vthal told nothing of the home within {} s", ANSWER.as_secs());
        };
        match message.update {
            Some(Update::Home(view)) => found = Some((view, message.text)),
            Some(Update::Estimate(told)) => estimate = Some(told),
            Some(Update::Pose(told)) => pose = Some(told),
            Some(Update::Failed(failure)) => bail!("refused ({}): {}", failure.reason, failure.text),
            Some(Update::Status(_)) => break,
            _ => {}
        }
    }
    let Some((home, text)) = found else {
        bail!("no robot has been seen yet, so nothing is known of its home");
    };
    Ok(KnownHome {
        home,
        text,
        estimate,
        pose,
    })
}
