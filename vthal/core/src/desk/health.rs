//! What the loads of motors say of their parts, and for how long parts have worked: accumulated while the robot cleans, reported on
//! demand, started again when a person has seen to a part.

use rvac_api::{ComponentHealth, LogLevel, PartHours, Update};

use super::audience::{Asking, Teller};
use super::awaited::{Awaited, Settled};
use super::journal::LogSource;
use super::reply::Reply;
use crate::Outputs;
use crate::device::{CleanerPower, CleanersRunning, Part, Report, WheelSpeeds};
use crate::health::{
    AtWork, Component, Consumable, Gauge, Health, Load, LoadVerdict, PartWork, StoredHealth,
};
use crate::observe::currents_a;
use crate::outputs::HealthOrder;
use crate::refusal::Refusal;

/// Wheels below this speed, or that differ by more, carry loads of their own kind.
const STRAIGHT_MIN_M_PER_S: f64 = 0.12;
const STRAIGHT_DIFFERENCE: f64 = 0.15;
/// Hours go to the disk after so much work, and when the robot has stopped cleaning after so much, seconds.
const KEEP_EVERY_S: f64 = 600.0;
const KEEP_AT_REST_S: f64 = 60.0;

/// What clients ask of the loads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum HealthRequest {
    /// How the parts are.
    Show,
    /// A part of this name was cleaned or changed: its load is learnt anew.
    Reset(String),
    /// A part of this name was replaced, or cleaned if that is its care: its hours begin anew.
    Renew(String),
    /// The last of that is taken back.
    UndoRenew(String),
}

/// What a person has changed, as it was before.
#[derive(Clone, Debug)]
enum Earlier {
    Load(Component, Gauge),
    Hours(Consumable, PartWork),
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

/// The loads and the hours, and who waits until a change is on the disk.
#[derive(Debug, Default)]
pub(crate) struct HealthDesk {
    health: Health,
    changes: Awaited<Earlier>,
    /// Work that the disk does not have yet, seconds.
    unkept_s: f64,
}

impl HealthDesk {
    pub(crate) fn new(health: Health) -> Self {
        Self {
            health,
            ..Self::default()
        }
    }

    fn keep(&mut self, outputs: &mut Outputs) {
        self.unkept_s = 0.0;
        if let Some(number) = self.changes.change() {
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

    /// Counts the hours of what runs in this step.
    pub(crate) fn count_hours(&mut self, running: CleanersRunning, teller: &mut Teller<'_>) {
        let at_work = AtWork {
            brush_main: running.brush_main,
            brush_sides: running.brush_sides,
            vacuum: running.vacuum,
        };
        let parts = self.health.consumables_mut();
        self.unkept_s += parts.take(teller.now_us, at_work);
        let due = parts.newly_due();
        let is_at_rest = at_work == AtWork::default() && self.unkept_s >= KEEP_AT_REST_S;
        if !due.is_empty() || is_at_rest || self.unkept_s >= KEEP_EVERY_S {
            self.keep(teller.outputs);
        }
        for part in due {
            let text = format!("{} Then: rvac health renew {}", part.remedy(), part.name());
            teller.log(LogLevel::Warn, LogSource::Vthal, text);
        }
    }

    /// The daemon ends: the hours that the disk does not have go there.
    pub(crate) fn end(&mut self, outputs: &mut Outputs) {
        if self.unkept_s > 0.0 {
            self.keep(outputs);
        }
    }

    /// How worn or dirty the parts are whose loads are measured or whose hours are counted, of a robot that has these parts; of one that
    /// is not known all.
    pub(crate) fn components(&self, fitted: Option<&[Part]>) -> Vec<ComponentHealth> {
        let is_fitted = |part: &Consumable| {
            let needed = part.of_device();
            needed.is_none_or(|needed| fitted.is_none_or(|fitted| fitted.contains(&needed)))
        };
        let is_weighed = |part: &Consumable| Component::from_name(part.name()).is_some();
        let weighed = Component::ALL.map(|component| view(&self.health, component));
        let others = Consumable::ALL
            .into_iter()
            .filter(|part| !is_weighed(part) && is_fitted(part))
            .map(|part| view_of_hours(&self.health, part));
        weighed.into_iter().chain(others).collect()
    }

    /// # Errors
    /// Why the request is refused.
    pub(crate) fn serve(
        &mut self,
        Asking { asker, request }: &Asking<HealthRequest>,
        (now_s, fitted): (Option<i64>, Option<&[Part]>),
        outputs: &mut Outputs,
    ) -> Result<Reply, Refusal> {
        let earlier = match request {
            HealthRequest::Show => {
                return Ok(Reply::from(Update::Health {
                    id: asker.id,
                    components: self.components(fitted),
                }));
            }
            HealthRequest::Reset(name) => {
                let component = Component::from_name(name).ok_or("unknown-component")?;
                Earlier::Load(component, self.health.reset(component))
            }
            HealthRequest::Renew(name) => {
                let part = Consumable::from_name(name).ok_or("unknown-component")?;
                Earlier::Hours(part, self.health.consumables_mut().see_to(part, now_s))
            }
            HealthRequest::UndoRenew(name) => {
                let part = Consumable::from_name(name).ok_or("unknown-component")?;
                let before = self.health.consumables_mut().take_back(part);
                Earlier::Hours(part, before.ok_or("not-renewed")?)
            }
        };
        self.keep(outputs);
        self.changes.wait(*asker, earlier);
        Ok(Reply::WhenKept)
    }

    /// The disk has the loads that it was given under this number, or says why it has not.
    pub(crate) fn kept(&mut self, number: u64, result: Result<(), String>, teller: &mut Teller<'_>) {
        let result = result.map_err(|text| Refusal {
            reason: "health-unwritable",
            text,
        });
        let Settled { undone, hands_over } = self.changes.kept(number, result, teller);
        for earlier in undone {
            match earlier {
                Earlier::Load(component, gauge) => self.health.put_back(component, gauge),
                Earlier::Hours(part, work) => self.health.consumables_mut().put_back(part, work),
            }
        }
        if hands_over {
            self.keep(teller.outputs);
        }
    }
}

fn view(health: &Health, component: Component) -> ComponentHealth {
    let (gauge, verdict) = (health.gauge(component), health.verdict(component));
    let consumable = Consumable::from_name(component.name());
    let remedy = component.remedy(verdict);
    ComponentHealth {
        component: component.name().to_owned(),
        verdict: verdict.name().to_owned(),
        minutes: gauge.minutes(),
        load_a: gauge.present_a().map(f64::from),
        usual_a: gauge.usual_a().map(f64::from),
        share: gauge.share().map(f64::from),
        hours: consumable.map(|part| hours(health, part)),
        // What is measured says more than what is counted.
        text: remedy
            .or_else(|| consumable.and_then(|part| remedy_of_hours(health, part)))
            .unwrap_or_default()
            .to_owned(),
    }
}

fn view_of_hours(health: &Health, part: Consumable) -> ComponentHealth {
    ComponentHealth {
        component: part.name().to_owned(),
        verdict: LoadVerdict::UNMEASURED.to_owned(),
        hours: Some(hours(health, part)),
        text: remedy_of_hours(health, part).unwrap_or_default().to_owned(),
        ..ComponentHealth::default()
    }
}

fn hours(health: &Health, part: Consumable) -> PartHours {
    let work = health.consumables().work(part);
    PartHours {
        worked_h: work.worked_h(),
        usual_h: f64::from(part.life_h()),
        care: part.care(),
        since_s: work.since_s,
        before_h: work.before.map(|before| before.worked_s / 3_600.0),
    }
}

fn remedy_of_hours(health: &Health, part: Consumable) -> Option<&'static str> {
    hours(health, part).is_due().then(|| part.remedy())
}
