//! One life of the daemon for each change that it makes on its disk, in which that change fails: it goes on, answers, stops the robot, and
//! the next life knows what was answered, and nothing that was refused.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Context;
use vthal_bench::Client;

use crate::daemon::AtDaemon;
use crate::failing_disk::{DiskFault, FailingDisk};
use crate::life::{Keeper, Life, texts};
use crate::store::Store;

/// A daemon that makes more changes of its disk than this from its start to its answer does not end.
const CHANGES_MAX: u32 = 400;
/// Longest wait for an answer.
const ANSWERS_WITHIN: Duration = Duration::from_secs(20);

/// What was seen of one kind.
#[derive(Debug, Default)]
pub(crate) struct FaultFigures {
    /// Lives in which a change failed.
    pub(crate) faults: u32,
    /// Of these, changes of people that were acknowledged and refused.
    pub(crate) acknowledged: u32,
    pub(crate) refused: u32,
    /// What was acknowledged was not there afterwards.
    pub(crate) lost: u32,
    /// What was refused was there afterwards, though the disk failed but once.
    pub(crate) kept_though_refused: u32,
    /// The same on a disk that went on failing, so that nothing could be taken back.
    pub(crate) could_not_be_taken_back: u32,
    /// The daemon did not start, ended, or did not answer.
    pub(crate) failures: u32,
    /// The next daemon told of a damaged file.
    pub(crate) damaged: u32,
    /// Longest time to the answer to Stop afterwards.
    pub(crate) stop_max: Duration,
}

impl FaultFigures {
    pub(crate) fn is_good(&self) -> bool {
        (self.lost, self.kept_though_refused, self.failures, self.damaged) == (0, 0, 0, 0)
    }

    /// One line for people.
    pub(crate) fn sentence(&self, name: &str) -> String {
        format!(
            "{name}: {} faults; {} changes acknowledged, {} lost; {} refused, {} of them kept, {} could not be taken back; {} failures, \
             {} damaged files; Stop within {:.1} ms",
            self.faults,
            self.acknowledged,
            self.lost,
            self.refused,
            self.kept_though_refused,
            self.could_not_be_taken_back,
            self.failures,
            self.damaged,
            self.stop_max.as_secs_f64() * 1e3,
        )
    }

    /// The same for programs.
    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::json!({
            "kind": name,
            "faults": self.faults,
            "acknowledged": self.acknowledged,
            "lost": self.lost,
            "refused": self.refused,
            "kept_though_refused": self.kept_though_refused,
            "could_not_be_taken_back": self.could_not_be_taken_back,
            "failures": self.failures,
            "damaged": self.damaged,
            "stop_max_ms": self.stop_max.as_secs_f64() * 1e3,
        })
    }
}

/// What people were told of a change, and what may be found afterwards.
struct Outcome {
    before: Vec<String>,
    after: Vec<String>,
    is_acknowledged: bool,
}

/// Lets each change of the disk fail in each manner.
pub(crate) fn try_faults(store: &dyn Store, vthal: &Path) -> anyhow::Result<FaultFigures> {
    let disk = FailingDisk::build()?;
    let mut figures = FaultFigures::default();
    let mut number = 0;
    for manner in DiskFault::ALL {
        // Each manner begins with what a daemon finds that is new.
        let keeper = AtDaemon::new(store, vthal)?;
        for at in 1..=CHANGES_MAX {
            number += 1;
            let fault = (manner, at);
            let outcome = live(&keeper, (&disk, fault), (number, &mut figures));
            let Some(failed) = disk.failed() else { break };
            figures.faults += 1;
            let what = format!("{} at {at}: {failed}", manner.name());
            let judged = outcome.and_then(|outcome| look(&keeper, &outcome, (fault, &mut figures)));
            match judged.with_context(|| what.clone()) {
                Ok(None) => {}
                Ok(Some(wrong)) => eprintln!("{}: {what}: {wrong}", store.name()),
                Err(error) => {
                    figures.failures += 1;
                    eprintln!("{}: {error:#}", store.name());
                }
            }
        }
    }
    Ok(figures)
}

/// A life in which a change of the disk fails.
fn live(
    keeper: &AtDaemon<'_>,
    (disk, fault): (&FailingDisk, (DiskFault, u32)),
    (number, figures): (u64, &mut FaultFigures),
) -> anyhow::Result<Outcome> {
    let command = disk.under(keeper.vthal(), &keeper.state(), fault)?;
    let mut life = keeper.start_as(command).context("it does not start")?;
    life.get_ready()?;
    let kept = life.read()?;
    let after = life.begin_change(&kept, number)?;
    let is_acknowledged = life.wait_for_answer()?;
    let mut other = Client::connect(&keeper.socket())?;
    let pressed = Instant::now();
    other.press_stop(1, ANSWERS_WITHIN)?;
    figures.stop_max = figures.stop_max.max(pressed.elapsed());
    life.kill()?;
    Ok(Outcome {
        before: texts(&kept),
        after,
        is_acknowledged,
    })
}

/// The next life, on a sound disk. Gives what is wrong, if anything is.
fn look(
    keeper: &AtDaemon<'_>,
    outcome: &Outcome,
    ((manner, _), figures): ((DiskFault, u32), &mut FaultFigures),
) -> anyhow::Result<Option<String>> {
    let mut life = keeper.start()?;
    life.get_ready()?;
    let found = texts(&life.read()?);
    let damage = life.damage().join("; ");
    life.kill()?;
    if !damage.is_empty() {
        figures.damaged += 1;
        return Ok(Some(damage));
    }
    let Outcome {
        before,
        after,
        is_acknowledged,
    } = outcome;
    if *is_acknowledged {
        figures.acknowledged += 1;
        let is_there = found == *after;
        figures.lost += u32::from(!is_there);
        return Ok((!is_there).then(|| format!("acknowledged {after:#?}, found {found:#?}")));
    }
    figures.refused += 1;
    if found == *before {
        return Ok(None);
    }
    if found == *after && manner != DiskFault::ErrorOnce {
        figures.could_not_be_taken_back += 1;
        return Ok(None);
    }
    figures.kept_though_refused += 1;
    Ok(Some(format!("refused, was {before:#?}, found {found:#?}")))
}
