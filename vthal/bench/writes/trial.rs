//! The lives of a program, one after the other, on the same files.

use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use vthal_bench::next_random;

use crate::figures::Figures;
use crate::life::{Keeper, Life, texts};

/// Acknowledged changes of a life, at most.
const WHOLE_CHANGES_MAX: u64 = 3;
/// The kill comes within this many times the usual time of a change.
const KILL_WITHIN: u32 = 2;

/// Kills the program so many times.
pub(crate) fn try_keeper(keeper: &dyn Keeper, kills: u32, seed: u64) -> anyhow::Result<Figures> {
    let mut trial = Trial {
        keeper,
        random: seed,
        numbers: 0,
        usual: Duration::from_millis(10),
        figures: Figures::default(),
    };
    let mut possible = None;
    for kill in 1..=kills {
        possible = Some(
            trial
                .live_once(possible)
                .with_context(|| format!("life {kill} of the program"))?,
        );
    }
    Ok(trial.figures)
}

/// What the next life may find: what was acknowledged, or that and the change that was cut off.
struct Possible {
    acknowledged: Vec<String>,
    cut_off: Option<Vec<String>>,
}

struct Trial<'a> {
    keeper: &'a dyn Keeper,
    random: u64,
    /// Numbers given to changes.
    numbers: u64,
    /// Time of the last acknowledged change.
    usual: Duration,
    figures: Figures,
}

impl Trial<'_> {
    /// One life of the program, from its start to its kill.
    fn live_once(&mut self, possible: Option<Possible>) -> anyhow::Result<Possible> {
        let started = Instant::now();
        let mut life = self.keeper.start()?;
        self.figures.ready_within = self.figures.ready_within.max(started.elapsed());
        life.get_ready()?;
        self.compare(life.as_mut(), possible.as_ref())?;
        for _ in 0..next_random(&mut self.random) % (WHOLE_CHANGES_MAX + 1) {
            self.change_and_look(life.as_mut())?;
        }
        self.kill_in_a_change(life)
    }

    fn compare(&mut self, life: &mut dyn Life, possible: Option<&Possible>) -> anyhow::Result<()> {
        let found = texts(&life.read()?);
        if !life.damage().is_empty() {
            self.figures.corrupt += 1;
            eprintln!("damage: {}", life.damage().join("; "));
        }
        let Some(possible) = possible else { return Ok(()) };
        if possible.cut_off.as_ref() == Some(&found) {
            self.figures.cut_off_there += 1;
        } else if possible.acknowledged != found {
            self.figures.lost += 1;
            eprintln!("acknowledged: {:#?}\nfound: {found:#?}", possible.acknowledged);
        }
        Ok(())
    }

    fn change_and_look(&mut self, life: &mut dyn Life) -> anyhow::Result<()> {
        let kept = life.read()?;
        let started = Instant::now();
        let after = life.begin_change(&kept, self.next_number())?;
        life.finish_change()?;
        self.usual = started.elapsed();
        self.figures.acknowledged += 1;
        let found = texts(&life.read()?);
        if found != after {
            bail!("after a change was done it keeps {found:#?} in place of {after:#?}");
        }
        Ok(())
    }

    fn kill_in_a_change(&mut self, mut life: Box<dyn Life + '_>) -> anyhow::Result<Possible> {
        let kept = life.read()?;
        let within_us = u64::try_from((self.usual * KILL_WITHIN).as_micros()).unwrap_or(u64::MAX);
        let pause = Duration::from_micros(next_random(&mut self.random) % within_us.max(1));
        let after = life.begin_change(&kept, self.next_number())?;
        thread::sleep(pause);
        let was_acknowledged = life.kill()?;
        self.figures.kills += 1;
        if was_acknowledged {
            self.figures.acknowledged += 1;
            return Ok(Possible {
                acknowledged: after,
                cut_off: None,
            });
        }
        self.figures.cut_off += 1;
        Ok(Possible {
            acknowledged: texts(&kept),
            cut_off: Some(after),
        })
    }

    fn next_number(&mut self) -> u64 {
        self.numbers += 1;
        self.numbers
    }
}
