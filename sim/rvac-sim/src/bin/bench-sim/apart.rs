//! World and brain in isolation: they get the inputs of a recorded run and produce the same outputs.

use anyhow::ensure;
use brain::command::StrategyName;
use brain::{Actions, Brain, Command};
use home::{Actuation, World};
use rvac_sim::run::{keep_working, start_cleaning};
use rvac_sim::{Host, Household, thread_processor_s};
use serde::Serialize;
use vthal_core::Record;

/// A household that works, and copies of two of its parts that do the same as they.
pub(crate) struct HouseholdCopies {
    household: Household,
    world: World,
    world_s: f64,
    brain: Option<Brain>,
    commands: Vec<Command>,
    answer: Option<Actions>,
    brain_s: f64,
    differences: u64,
    clock_s: f64,
}

/// What the parts took of a processor, seconds.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Shares {
    /// Physics and sensors of the home.
    pub(crate) world_s: f64,
    /// The firmware, the serial line, the safety monitor, and the figures.
    pub(crate) firmware_s: f64,
    /// Both ends of the link on the host, and what the daemon does around the brain.
    pub(crate) core_s: f64,
    /// Steps of the brain.
    pub(crate) brain_s: f64,
}

/// Number of clock readings from which the cost of one reading is computed.
const READINGS: u32 = 100_000;

/// Seconds that one reading of the clock takes.
pub(crate) fn clock_s() -> f64 {
    let began_s = thread_processor_s();
    let last_s = (0..READINGS).fold(began_s, |_, _| std::hint::black_box(thread_processor_s()));
    (last_s - began_s) / f64::from(READINGS)
}

impl HouseholdCopies {
    /// A household that is asked to clean.
    pub(crate) fn begin(mut household: Household, strategy: StrategyName) -> Self {
        start_cleaning(&mut household, strategy);
        Self {
            world: household.robot().world().clone(),
            household,
            world_s: 0.0,
            brain: None,
            commands: Vec::new(),
            answer: None,
            brain_s: 0.0,
            differences: 0,
            clock_s: clock_s(),
        }
    }

    /// One second of the household, then the same of the copies.
    pub(crate) fn second(&mut self, strategy: StrategyName) {
        let actuations: Vec<Actuation> = (0..1_000)
            .map(|_| {
                self.household.tick();
                *self.household.robot().world().actuation()
            })
            .collect();
        keep_working(&mut self.household, strategy);
        let began_s = thread_processor_s();
        for actuation in &actuations {
            self.world.step(actuation);
        }
        self.world_s += thread_processor_s() - began_s;
        let records = self.household.host_mut().map(Host::take_records);
        for record in records.unwrap_or_default() {
            self.think(record);
        }
    }

    /// The brain again, from what was recorded.
    fn think(&mut self, record: Record) {
        match record {
            Record::RunStarted(start) => {
                let mut brain = Brain::new(start.brain, start.seed);
                brain.restore(&start.checkpoint);
                self.brain = Some(brain);
            }
            Record::Command { command, .. } => self.commands.push(command),
            Record::Observation(observation) => {
                let began_s = thread_processor_s();
                let answer = self
                    .brain
                    .as_mut()
                    .map(|brain| brain.step(&observation, &self.commands));
                self.brain_s += thread_processor_s() - began_s - self.clock_s;
                self.commands.clear();
                self.answer = answer;
            }
            Record::Actions { actions, .. } => {
                self.differences += u64::from(self.answer.take() != Some(actions));
            }
            _ => {}
        }
    }

    /// What each part took of a run that took `all_s`, and its host `host_s`.
    pub(crate) fn shares(&self, state_hash: u64, all_s: f64, host_s: f64) -> anyhow::Result<Shares> {
        let robot = self.household.robot();
        ensure!(
            robot.state_hash() == state_hash,
            "the recorded run went another way"
        );
        ensure!(
            robot.world().truth().pose == self.world.truth().pose,
            "the copy of the world went another way"
        );
        ensure!(
            self.differences == 0,
            "the copy of the brain answered {} times otherwise",
            self.differences
        );
        Ok(Shares {
            world_s: self.world_s,
            firmware_s: all_s - host_s - self.world_s,
            core_s: host_s - self.brain_s,
            brain_s: self.brain_s,
        })
    }
}
