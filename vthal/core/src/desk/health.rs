//! What the loads of motors say of their parts: accumulated while the robot cleans, reported on demand, started again when a person has
//! cleaned a part.

use rvac_api::{ComponentHealth, LogLevel, Update};

use super::audience::{Asking, Teller};
use super::awaited::{Awaited, Settled};
use super::journal::LogSource;
use super::reply::Reply;
use crate::Outputs;
use crate::device::{CleanerPower, Report, WheelSpeeds};
use crate::health::{Component, Gauge, Health, Load, StoredHealth};
use crate::observe::currents_a;
use crate::outputs::HealthOrder;
use crate::refusal::Refusal;

/// Wheels below this speed, or that differ by more, carry loads of their own kind.
const STRAIGHT_MIN_M_PER_S: f64 = 0.12;
const STRAIGHT_DIFFERENCE: f64 = 0.15;

/// What clients ask of the loads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum HealthRequest {
    /// How the parts are.
    Show,
    /// A part of this name was cleaned or changed.
    Reset(String),
}

/// What the loads are computed from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotorSample<'a> {
    pub(crate) report: &'a Report,
    pub(crate) wheel_speeds: WheelSpeeds,
    /// How hard the cleaners run.
    pub(crate) power: CleanerPower,
}

impl MotorSample<'_> {
    /// What the motors draw now, if it can be compared with other moments.
    fn load(&self, now_us: u64) -> Option<Load> {
        let [left_a, right_a, brush_a] = currents_a(self.report)?;
        let WheelSpeeds {
            left_m_per_s,
            right_m_per_s,
        } = self.wheel_speeds;
        let [slower, faster] = [left_m_per_s.min(right_m_per_s), left_m_per_s.max(right_m_per_s)];
        let is_straight = slower >= STRAIGHT_MIN_M_PER_S && faster - slower <= STRAIGHT_DIFFERENCE * faster;
        let brush_runs = self.report.cleaners.brush_main && self.power == CleanerPower::FULL;
        is_straight.then_some(Load {
            time_us: now_us,
            wheels_a: Some([left_a, right_a]),
            // A brush that runs draws something: 0 A is that of a robot that does not measure it (SPEC, `z`).
            brush_a: brush_runs.then_some(brush_a).filter(|drawn_a| *drawn_a != 0.0),
        })
    }
}

/// The loads, and who waits until a reset is on the disk.
#[derive(Debug, Default)]
pub(crate) struct HealthDesk {
    health: Health,
    resets: Awaited<(Component, Gauge)>,
}

impl HealthDesk {
    pub(crate) fn new(health: Health) -> Self {
        Self {
            health,
            ..Self::default()
        }
    }

    fn keep(&mut self, outputs: &mut Outputs) {
        if let Some(number) = self.resets.change() {
            outputs.health = Some(HealthOrder {
                number,
                health: StoredHealth::from(&self.health),
            });
        }
    }

    /// Takes in what the motors draw in a step in which the robot cleans.
    pub(crate) fn weigh(&mut self, drive: &MotorSample<'_>, teller: &mut Teller<'_>) {
        let Some(load) = drive.load(teller.now_us) else {
            return;
        };
        let taken = self.health.take(&load);
        if taken.marked {
            self.keep(teller.outputs);
        }
        for change in taken.changes {
            let (level, text) = match change.component.remedy(change.verdict) {
                Some(remedy) => (LogLevel::Warn, remedy.to_owned()),
                None => (
                    LogLevel::Info,
                    format!("{} runs as usual again.", change.component.name()),
                ),
            };
            teller.log(level, LogSource::Vthal, text);
        }
    }

    /// How worn or dirty the parts are whose loads are measured.
    pub(crate) fn components(&self) -> Vec<ComponentHealth> {
        Component::ALL
            .map(|component| view(&self.health, component))
            .into()
    }

    /// # Errors
    /// Why the request is refused.
    pub(crate) fn serve(
        &mut self,
        Asking { asker, request }: &Asking<HealthRequest>,
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        match request {
            HealthRequest::Show => Ok(Reply::from(Update::Health {
                id: asker.id,
                components: self.components(),
            })),
            HealthRequest::Reset(name) => {
                let component = Component::from_name(name).ok_or("unknown-component")?;
                let before = self.health.reset(component);
                self.keep(outputs);
                self.resets.wait(*asker, (component, before));
                Ok(Reply::WhenKept)
            }
        }
    }

    /// The disk has the loads that it was given under this number, or says why it has not.
    pub(crate) fn kept(&mut self, number: u64, result: Result<(), String>, teller: &mut Teller<'_>) {
        let result = result.map_err(|text| Refusal {
            reason: "health-unwritable",
            text,
        });
        let Settled { undone, hands_over } = self.resets.kept(number, result, teller);
        for (component, before) in undone {
            self.health.put_back(component, before);
        }
        if hands_over {
            self.keep(teller.outputs);
        }
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
