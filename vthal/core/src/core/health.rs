//! What the loads of motors say of their parts: taken in while the robot cleans, told on demand, begun anew when somebody has
//! cleaned a part.

use brain::BehaviorState;
use rvac_api::{ComponentHealth, LogLevel, Update};

use super::Core;
use super::awaited::{Awaited, Change};
use super::refusal::Refusal;
use crate::Outputs;
use crate::device::CleanerPower;
use crate::health::{Component, Gauge, Health, Load, StoredHealth};
use crate::journal::Part;
use crate::observe::currents_a;
use crate::outputs::{Delivery, HealthOrder, Recipients};
use crate::scheduler::Asker;

/// Wheels below this speed, or that differ by more, carry loads of their own kind.
const STRAIGHT_MIN_M_PER_S: f64 = 0.12;
const STRAIGHT_DIFFERENCE: f64 = 0.15;

/// A part was cleaned.
pub(super) const RESET: Change<(Component, Gauge)> = Change {
    refused_as: "health-unwritable",
    waiting: |core| &mut core.health.resets,
    take_back: |core, (component, before)| core.health.health.put_back(component, before),
};

/// The loads, and who waits until a reset is on the disk.
#[derive(Debug, Default)]
pub(super) struct HealthDesk {
    health: Health,
    resets: Awaited<(Component, Gauge)>,
}

impl HealthDesk {
    pub(super) fn new(health: Health) -> Self {
        Self {
            health,
            ..Self::default()
        }
    }

    fn keep(&mut self, outputs: &mut Outputs) {
        outputs.health = Some(HealthOrder {
            number: self.resets.next_order(),
            health: StoredHealth::from(&self.health),
        });
    }
}

impl Core {
    /// What the motors draw in this step, if it can be compared with other moments.
    pub(super) fn weigh_loads(&mut self, now_us: u64, outputs: &mut Outputs) {
        let Some(load) = self.load(now_us) else { return };
        let taken = self.health.health.take(&load);
        if taken.marked {
            self.health.keep(outputs);
        }
        for change in taken.changes {
            let (level, text) = match change.component.remedy(change.verdict) {
                Some(remedy) => (LogLevel::Warn, remedy.to_owned()),
                None => (
                    LogLevel::Info,
                    format!("{} runs as usual again.", change.component.name()),
                ),
            };
            self.log(now_us, (level, Part::Vthal, text), outputs);
        }
    }

    fn load(&self, now_us: u64) -> Option<Load> {
        let mind = self.mind.as_ref().filter(|_| self.description().is_some())?;
        if mind.brain().status().state != BehaviorState::Cleaning {
            return None;
        }
        let report = self.facts.report.as_ref()?;
        let [left_a, right_a, brush_a] = currents_a(report)?;
        let (left, right) = (
            self.facts.wheel_speeds.left_m_per_s,
            self.facts.wheel_speeds.right_m_per_s,
        );
        let [slower, faster] = [left.min(right), left.max(right)];
        let is_straight = slower >= STRAIGHT_MIN_M_PER_S && faster - slower <= STRAIGHT_DIFFERENCE * faster;
        let brush_runs = report.cleaners.brush_main && self.cleaner_power() == CleanerPower::FULL;
        is_straight.then_some(Load {
            time_us: now_us,
            wheels_a: Some([left_a, right_a]),
            brush_a: brush_runs.then_some(brush_a),
        })
    }

    /// How worn or dirty the parts are whose loads are measured.
    #[must_use]
    pub fn component_health(&self) -> Vec<ComponentHealth> {
        Component::ALL
            .map(|component| view(&self.health.health, component))
            .into()
    }

    /// A client asks how the parts are.
    pub(super) fn tell_health(&self, (client, id): Asker, outputs: &mut Outputs) -> Result<(), Refusal> {
        outputs.deliveries.push(Delivery {
            to: Recipients::One(client),
            update: Update::Health {
                id,
                components: self.component_health(),
            },
        });
        Ok(())
    }

    /// A client has cleaned a part. Answered when the disk has it.
    pub(super) fn reset_health(
        &mut self,
        asker: Asker,
        name: &str,
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let component = Component::from_name(name).ok_or("unknown-component")?;
        let before = self.health.health.reset(component);
        self.health.keep(outputs);
        self.health.resets.wait(asker, (component, before));
        Ok(())
    }
}

fn view(health: &Health, component: Component) -> ComponentHealth {
    let (gauge, verdict) = (health.gauge(component), health.verdict(component));
    ComponentHealth {
        component: component.name().to_owned(),
        verdict: verdict.name().to_owned(),
        minutes: gauge.minutes(),
        load_a: gauge.present_a().map(f64::from),
        usual_a: gauge.usual_a().map(f64::from),
        share: gauge.share().map(f64::from),
        text: component.remedy(verdict).unwrap_or_default().to_owned(),
    }
}
