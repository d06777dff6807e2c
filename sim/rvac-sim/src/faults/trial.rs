//! One seed: a home, a household, ten minutes of faults.

use brain::SensorLayout;
use brain::command::StrategyName;
use home::{Noise, Pcg, SensorId};
use monitor::Bridges;
use robot::{FaultRates, RobotSettings};
use rvac_api::RequestBody;
use rvac_protocol::message::{Inhibit, Inhibits};
use vthal_core::{Checkpoints, CoreConfig};

use super::draw::{Fault, FaultDraw, FaultKind};
use super::{Calibration, FaultCampaign};
use crate::{Host, Household};

/// Outcome of a seed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaultOutcome {
    /// The seed.
    pub seed: u64,
    /// Name of the home.
    pub home: String,
    /// Faults by kind, in the order of [`FaultKind::ALL`].
    pub faults: [u32; FaultKind::ALL.len()],
    /// Number of times that each inhibit was set, in the order of [`Inhibit::ALL`].
    pub stops: [u32; Inhibit::ALL.len()],
    /// Violations in words.
    pub violations: Vec<String>,
    /// How many violations there were.
    pub violation_count: u32,
    /// True path length in metres.
    pub path_m: f64,
    /// The state of everything at the end, as one number.
    pub state_hash: u64,
}

/// How a trial is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TrialSettings {
    /// Seed of everything.
    pub seed: u64,
    /// Simulated milliseconds.
    pub duration_ms: u64,
    /// Kind of the bridges; broken ones show that the monitor notices.
    pub bridges: Bridges,
}

/// What ends by itself, some time after it began.
#[derive(Clone, Debug)]
enum EffectEnd {
    Noise,
    Host(Box<CoreConfig>),
    Sensor(SensorId),
    Lift,
    Button(u8),
}

/// Milliseconds between two readings of the inhibits: the host receives them 50 times a second.
const STOPS_MS: u64 = 20;
/// Milliseconds between two checks by the simulated owner.
const LOOK_MS: u64 = 1_000;
const STREAM: u64 = 0x7E57;

struct FaultTrial {
    household: Household,
    sensors: SensorLayout,
    draw: FaultDraw,
    ends: Vec<(u64, EffectEnd)>,
    next_fault_ms: u64,
    inhibits: Inhibits,
    settings: TrialSettings,
    outcome: FaultOutcome,
}

/// Runs one seed.
pub(crate) fn run(campaign: &FaultCampaign, settings: TrialSettings) -> FaultOutcome {
    let mut random = Pcg::new(settings.seed, STREAM);
    let noise = [Noise::ideal(), Noise::good(), Noise::nominal(), Noise::bad()][random.below(4) as usize];
    let scene = campaign
        .homes
        .scene(settings.seed, &campaign.model, noise)
        .with_firmware(campaign.firmware.clone());
    let robot = scene.robot(
        settings.seed,
        &RobotSettings {
            seed: settings.seed,
            bridges: settings.bridges,
            miscalibration: (campaign.calibration == Calibration::Wrong).then_some(settings.seed),
            ..RobotSettings::default()
        },
    );
    let sensors = scene.sensors();
    let host = Host::start(0, config(settings.seed, sensors, None));
    let mut trial = FaultTrial {
        household: Household::new(robot, host),
        sensors,
        draw: FaultDraw::new(settings.seed),
        ends: Vec::new(),
        next_fault_ms: 2_000,
        inhibits: Inhibits::NONE,
        settings,
        outcome: FaultOutcome {
            seed: settings.seed,
            home: scene.home().name().to_owned(),
            ..FaultOutcome::default()
        },
    };
    while trial.household.robot().now_ms() < settings.duration_ms {
        trial.tick();
    }
    trial.finish()
}

/// Each strategy comes up as often as the others; the sensors are known, as they are on a robot that was described.
fn config(seed: u64, sensors: SensorLayout, before: Option<&Host>) -> CoreConfig {
    let strategies = StrategyName::ALL;
    let number = (seed % strategies.len() as u64) as usize;
    CoreConfig {
        checkpoints: Checkpoints::On,
        resume: before.and_then(Host::checkpoint).cloned(),
        sensors,
        ..Host::config(seed, strategies.get(number).copied().unwrap_or_default())
    }
}

impl FaultTrial {
    fn tick(&mut self) {
        self.household.tick();
        let now_ms = self.household.robot().now_ms();
        if now_ms.is_multiple_of(STOPS_MS) {
            self.count_stops();
        }
        if now_ms >= self.next_fault_ms {
            self.next_fault_ms = now_ms + self.draw.pause_ms();
            let fault = self.draw.fault();
            self.begin(now_ms, fault);
        }
        self.end_due(now_ms);
        if now_ms.is_multiple_of(LOOK_MS) {
            self.look();
        }
    }

    /// The inhibits that the host last received from the firmware.
    fn count_stops(&mut self) {
        let Some(status) = self.household.host().map(Host::status) else {
            return;
        };
        let mut inhibits = Inhibits::NONE;
        for name in &status.inhibits {
            if let Some(inhibit) = Inhibit::from_name(name.as_bytes()) {
                inhibits.insert(inhibit);
            }
        }
        if inhibits == self.inhibits {
            return;
        }
        for (count, inhibit) in self.outcome.stops.iter_mut().zip(Inhibit::ALL) {
            if inhibits.contains(inhibit) && !self.inhibits.contains(inhibit) {
                *count += 1;
            }
        }
        self.inhibits = inhibits;
    }

    fn begin(&mut self, now_ms: u64, fault: Fault) {
        if self.is_busy(&fault) {
            return;
        }
        self.outcome.faults[fault.kind() as usize] += 1;
        let robot = self.household.robot_mut();
        match fault {
            Fault::Noise { rates, ms } => {
                robot.set_line_rates(rates);
                self.ends.push((now_ms + ms, EffectEnd::Noise));
            }
            Fault::CutOut { ms } => robot.cut_line(ms),
            Fault::Delay { ms } => robot.hold_line(ms),
            Fault::Reset(cause) => robot.reset(cause),
            Fault::HostDeath { ms } => {
                let dead = self.household.kill_host();
                let heir = config(self.settings.seed, self.sensors, dead.as_ref());
                self.ends.push((now_ms + ms, EffectEnd::Host(Box::new(heir))));
            }
            Fault::Sensor { sensor, lie, ms } => {
                robot.world_mut().set_fault(sensor, Some(lie));
                self.ends.push((now_ms + ms, EffectEnd::Sensor(sensor)));
            }
            Fault::Lift { ms } => {
                robot.world_mut().lift();
                self.ends.push((now_ms + ms, EffectEnd::Lift));
            }
            Fault::Button { button, ms } => {
                robot.world_mut().press_button(button);
                self.ends.push((now_ms + ms, EffectEnd::Button(button)));
            }
            Fault::Request(body) => self.ask(body),
        }
    }

    /// The owner asks for something. A stick is pushed from its centre.
    fn ask(&mut self, body: RequestBody) {
        if let RequestBody::Drive {
            ttl, clean, power, ..
        } = &body
        {
            self.household.ask(RequestBody::Drive {
                v: 0.0,
                w: 0.0,
                ttl: *ttl,
                clean: *clean,
                power: *power,
            });
        }
        self.household.ask(body);
    }

    /// Whether something of the same kind is still going on; sensors lie one at a time.
    fn is_busy(&self, fault: &Fault) -> bool {
        self.ends.iter().any(|(_, end)| {
            matches!(
                (end, fault),
                (EffectEnd::Noise, Fault::Noise { .. })
                    | (EffectEnd::Host(_), Fault::HostDeath { .. })
                    | (EffectEnd::Sensor(_), Fault::Sensor { .. })
                    | (EffectEnd::Lift, Fault::Lift { .. })
                    | (EffectEnd::Button(_), Fault::Button { .. })
            )
        })
    }

    fn end_due(&mut self, now_ms: u64) {
        while let Some(index) = self.ends.iter().position(|(due_ms, _)| *due_ms <= now_ms) {
            let (_, end) = self.ends.remove(index);
            let robot = self.household.robot_mut();
            match end {
                EffectEnd::Noise => robot.set_line_rates(FaultRates::NONE),
                EffectEnd::Host(config) => {
                    let now_us = self.household.now_us();
                    self.household.revive_host(Host::start(now_us, *config));
                }
                EffectEnd::Sensor(sensor) => robot.world_mut().set_fault(sensor, None),
                EffectEnd::Lift => robot.world_mut().put_down(),
                EffectEnd::Button(button) => robot.world_mut().release_button(button),
            }
        }
    }

    /// A simulated owner follows the panel.
    fn look(&mut self) {
        let Some(status) = self.household.host().map(Host::status) else {
            return;
        };
        match status.state.as_str() {
            "idle" | "docked" => self.household.ask(RequestBody::Start { strategy: None }),
            "paused" => self.household.ask(RequestBody::Resume),
            "error" | "stuck" => {
                for reason in status.inhibits.into_iter().chain([status.reason]) {
                    self.household.ask(RequestBody::Clear { reason });
                }
            }
            _ => {}
        }
    }

    fn finish(self) -> FaultOutcome {
        let robot = self.household.robot();
        let monitor = robot.monitor();
        FaultOutcome {
            violations: monitor.violations().iter().map(ToString::to_string).collect(),
            violation_count: monitor.count(),
            path_m: robot.world().truth().path_m,
            state_hash: robot.state_hash(),
            ..self.outcome
        }
    }
}
