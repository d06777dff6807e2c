//! What is counted, and the page that says it. Names and units follow Prometheus' own advice: base units, and `_total` for what only grows.

use std::collections::BTreeMap;

use bridge::Knowledge;
use rvac_api::{
    Activity, ComponentHealth, Estimate, PartHours, RunResult, Statistics, Trouble, Update, explain,
};

use crate::exposition::Kind::{Counter, Gauge};
use crate::exposition::Page;

/// Everything that is known and counted.
#[derive(Debug, Default)]
pub(crate) struct Figures {
    pub(crate) known: Knowledge,
    pub(crate) daemon_is_up: bool,
    estimate: Option<Estimate>,
    wear: Vec<ComponentHealth>,
    /// What all runs come to, once it was said.
    lifetime: Option<Statistics>,
    counted: Counted,
}

/// Since this program started.
#[derive(Debug, Default)]
struct Counted {
    runs: BTreeMap<&'static str, u32>,
    stops: BTreeMap<String, u32>,
    /// Number of the newest stop that was counted: the daemon says the last ten again to each new client.
    last_stop: u64,
    swept_m2: f64,
    path_m: f64,
    moving_s: f64,
    bumps: u32,
}

impl Figures {
    pub(crate) fn take(&mut self, update: &Update) {
        match update {
            Update::Estimate(estimate) => self.estimate = Some(*estimate),
            Update::Health { components, .. } => self.wear.clone_from(components),
            Update::Statistics(sums) => self.lifetime = Some(sums.as_ref().clone()),
            Update::RunKept(run) => {
                let counted = &mut self.counted;
                *counted.runs.entry(run.result.name()).or_default() += 1;
                counted.swept_m2 += run.swept_m2;
                counted.path_m += run.path_m;
                counted.moving_s += run.moving_s;
                counted.bumps = counted.bumps.saturating_add(run.bumps);
            }
            Update::Standstill(stop) if stop.number > self.counted.last_stop => {
                self.counted.last_stop = stop.number;
                // A code that is not in the catalogue is counted, too, but not under a label of its own: labels must end somewhere.
                let code = if explain(&stop.reason).is_some() {
                    &stop.reason
                } else {
                    "other"
                };
                *self.counted.stops.entry(code.to_owned()).or_default() += 1;
            }
            update => {
                self.known.take(update);
            }
        }
    }

    /// The daemon has come or gone.
    pub(crate) fn daemon(&mut self, is_up: bool) {
        self.daemon_is_up = is_up;
        if !is_up {
            self.known.forget_state();
            self.estimate = None;
            // A daemon that starts anew numbers its stops from 1.
            self.counted.last_stop = 0;
        }
    }

    /// The page.
    pub(crate) fn page(&self) -> String {
        let mut page = Page::default();
        page.figure(
            ("rvac_daemon_up", Gauge),
            "Whether the robot's daemon can be reached.",
            Some(f64::from(u8::from(self.daemon_is_up))),
        );
        let version = self.known.versions.vthal.as_str();
        let versions = (!version.is_empty()).then_some((version, 1.0)).into_iter();
        page.figures(
            ("rvac_version_info", Gauge),
            "Version of the daemon.",
            ("vthal", versions),
        );
        self.computer(&mut page);
        self.state(&mut page);
        self.battery(&mut page);
        self.link(&mut page);
        self.body(&mut page);
        self.place(&mut page);
        self.counters(&mut page);
        self.lifetime(&mut page);
        page.into_text()
    }

    /// What the daemon takes of its computer.
    fn computer(&self, page: &mut Page) {
        let Some(load) = self.known.device.as_ref().and_then(|device| device.daemon) else {
            return;
        };
        page.figure(
            ("rvac_daemon_resident_memory_bytes", Gauge),
            "Memory that the daemon uses.",
            load.memory_bytes.map(|bytes| bytes as f64),
        );
        page.figure(
            ("rvac_daemon_busy_seconds_total", Counter),
            "Time for which the daemon's loop has worked since its start: the brain, and all else between two waits.",
            Some(load.busy_s),
        );
        page.figure(
            ("rvac_daemon_longest_turn_seconds", Gauge),
            "The longest that the daemon's loop worked at one thing in the last second.",
            Some(load.longest_turn_ms / 1e3),
        );
    }

    fn state(&self, page: &mut Page) {
        let Some(status) = &self.known.status else { return };
        let is = |yes: bool| f64::from(u8::from(yes));
        let activities = Activity::ALL
            .into_iter()
            .map(|activity| (activity.name(), is(activity.name() == status.state)));
        page.figures(
            ("rvac_activity", Gauge),
            "What the robot is doing: 1 for one of them.",
            ("activity", activities),
        );
        let now = Trouble::of_status(status).map(|(_, trouble)| trouble);
        let troubles = Trouble::ALL
            .into_iter()
            .map(|trouble| (trouble.words().name, is(now == Some(trouble))));
        page.figures(
            ("rvac_trouble", Gauge),
            "What is the matter: 1 for one of them at most.",
            ("trouble", troubles),
        );
        let jobs = [
            (
                "rvac_job_swept_square_meters",
                "Floor that the running or last job has swept.",
                status.swept_m2,
            ),
            (
                "rvac_job_path_meters",
                "Distance of the running or last job.",
                status.path_m,
            ),
            (
                "rvac_job_seconds",
                "Time of the running or last job.",
                status.job_s,
            ),
            (
                "rvac_job_bumps",
                "Bumps of the running or last job.",
                f64::from(status.bumps),
            ),
        ];
        for (name, help, value) in jobs {
            page.figure((name, Gauge), help, Some(value));
        }
    }

    fn battery(&self, page: &mut Page) {
        let battery = self
            .known
            .device
            .as_ref()
            .and_then(|device| device.battery.as_ref());
        let figures = [
            (
                "rvac_battery_charge_ratio",
                "Charge of the battery, 0 to 1.",
                battery.map(|battery| battery.charge),
            ),
            (
                "rvac_battery_volts",
                "Voltage of the battery.",
                battery.map(|battery| battery.voltage_v),
            ),
            (
                "rvac_battery_amperes",
                "Current into the battery.",
                battery.map(|battery| battery.current_a),
            ),
            (
                "rvac_battery_celsius",
                "Temperature of the battery.",
                battery.and_then(|battery| battery.temperature_c),
            ),
        ];
        for (name, help, value) in figures {
            page.figure((name, Gauge), help, value);
        }
    }

    fn link(&self, page: &mut Page) {
        let Some(device) = &self.known.device else { return };
        let link = &device.link;
        let figures = [
            (
                "rvac_link_up",
                "Whether telemetry is fresh.",
                Some(f64::from(u8::from(link.up))),
            ),
            (
                "rvac_link_age_seconds",
                "Age of the newest telemetry.",
                Some(f64::from(link.age_ms) / 1e3),
            ),
            (
                "rvac_link_bad_packets_ratio",
                "Share of bad packets over five seconds.",
                Some(link.bad_share),
            ),
            (
                "rvac_link_round_trip_seconds",
                "Median time to the robot's controller and back.",
                link.round_trip_ms.map(|ms| ms / 1e3),
            ),
            (
                "rvac_main_loop_hertz",
                "Passes of the firmware's main loop.",
                device.main_loop_hz.map(f64::from),
            ),
        ];
        for (name, help, value) in figures {
            page.figure((name, Gauge), help, value);
        }
        let bytes = [
            ("from_robot", device.bytes_in_per_s),
            ("to_robot", device.bytes_out_per_s),
        ];
        page.figures(
            ("rvac_link_bytes_per_second", Gauge),
            "Bytes on the line to the robot's controller.",
            ("direction", bytes.into_iter()),
        );
        let counters = [
            (
                "rvac_controller_resets_total",
                "Resets of the robot's controller since the daemon's start.",
                link.resets,
            ),
            (
                "rvac_link_reconnects_total",
                "Times the line was lost and found since the daemon's start.",
                link.reconnects,
            ),
        ];
        for (name, help, value) in counters {
            page.figure((name, Counter), help, Some(f64::from(value)));
        }
    }

    fn body(&self, page: &mut Page) {
        let Some(device) = &self.known.device else { return };
        let unmeasured = self
            .known
            .robot
            .as_ref()
            .map_or(&[][..], |robot| &robot.unmeasured);
        let motors = ["wheel-left", "wheel-right", "brush-main"];
        let is_measured = |motor: &str| {
            let family = if motor.starts_with("wheel") {
                "wheels"
            } else {
                motor
            };
            !unmeasured.iter().any(|name| name == family || name == motor)
        };
        let currents = motors
            .into_iter()
            .zip(device.currents_a.into_iter().flatten().map(f64::from));
        page.figures(
            ("rvac_motor_amperes", Gauge),
            "Currents of the motors.",
            ("motor", currents.filter(|(motor, _)| is_measured(motor))),
        );
        let wheels = [
            ("left", device.wheel_left_m_per_s),
            ("right", device.wheel_right_m_per_s),
        ];
        page.figures(
            ("rvac_wheel_meters_per_second", Gauge),
            "Speeds of the wheels.",
            ("wheel", wheels.into_iter()),
        );
        let worn = self
            .wear
            .iter()
            .filter_map(|part| Some((part.component.as_str(), part.share?)));
        page.figures(
            ("rvac_wear_ratio", Gauge),
            "Load of a part over its usual load.",
            ("part", worn),
        );
        let seconds = |of: fn(&PartHours) -> f64| {
            let parts = self.wear.iter();
            parts.filter_map(move |part| Some((part.component.as_str(), of(part.hours.as_ref()?))))
        };
        page.figures(
            ("rvac_part_worked_seconds", Gauge),
            "Time of work of a part since it was replaced or cleaned.",
            ("part", seconds(|hours| 3_600.0 * hours.worked_h)),
        );
        page.figures(
            ("rvac_part_usual_seconds", Gauge),
            "Time of work after which such a part is usually replaced or cleaned.",
            ("part", seconds(|hours| 3_600.0 * hours.usual_h)),
        );
    }

    fn place(&self, page: &mut Page) {
        let estimate = self.estimate.as_ref();
        let figures = [
            (
                "rvac_position_sigma_meters",
                "Standard deviation of the robot's place.",
                estimate.map(|estimate| estimate.sigma_m),
            ),
            (
                "rvac_position_lost",
                "Whether the robot does not know where it is.",
                estimate.map(|estimate| f64::from(u8::from(estimate.lost))),
            ),
            (
                "rvac_job_covered_ratio",
                "Share of the reachable floor that the job has swept, 0 to 1.",
                estimate.and_then(|estimate| estimate.covered),
            ),
        ];
        for (name, help, value) in figures {
            page.figure((name, Gauge), help, value);
        }
    }

    /// Sums that the daemon keeps: they go on where this program was not there to count.
    fn lifetime(&self, page: &mut Page) {
        let Some(sums) = &self.lifetime else { return };
        let runs = sums.runs.iter().map(|(job, count)| (job.as_str(), *count as f64));
        page.figures(
            ("rvac_lifetime_runs_total", Counter),
            "Runs since the robot's first one.",
            ("job", runs),
        );
        let figures = [
            (
                "rvac_lifetime_swept_square_meters_total",
                "Floor that all runs have swept.",
                sums.swept_m2,
            ),
            (
                "rvac_lifetime_path_meters_total",
                "Distance of all runs.",
                sums.path_km * 1e3,
            ),
            (
                "rvac_lifetime_moving_seconds_total",
                "Time in motion of all runs.",
                sums.moving_h * 3_600.0,
            ),
        ];
        for (name, help, value) in figures {
            page.figure((name, Counter), help, Some(value));
        }
    }

    fn counters(&self, page: &mut Page) {
        let counted = &self.counted;
        let runs = RunResult::ALL.into_iter().map(|result| {
            let name = result.name();
            (name, f64::from(counted.runs.get(name).copied().unwrap_or(0)))
        });
        page.figures(("rvac_runs_total", Counter), "Runs that ended.", ("result", runs));
        let stops = counted
            .stops
            .iter()
            .map(|(reason, count)| (reason.as_str(), f64::from(*count)));
        page.figures(
            ("rvac_stops_total", Counter),
            "Times that the robot waited or gave up without an order.",
            ("reason", stops),
        );
        let sums = [
            (
                "rvac_runs_swept_square_meters_total",
                "Floor that ended runs have swept.",
                counted.swept_m2,
            ),
            (
                "rvac_runs_path_meters_total",
                "Distance of ended runs.",
                counted.path_m,
            ),
            (
                "rvac_runs_moving_seconds_total",
                "Time in motion of ended runs.",
                counted.moving_s,
            ),
            (
                "rvac_runs_bumps_total",
                "Bumps of ended runs.",
                f64::from(counted.bumps),
            ),
        ];
        for (name, help, value) in sums {
            page.figure((name, Counter), help, Some(value));
        }
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{DaemonLoad, DeviceTable, Evidence, Pose, Standstill, Status, Update};

    use super::Figures;

    fn stop(number: u64, reason: &str) -> Update {
        Update::Standstill(Box::new(Standstill {
            number,
            t: 1.0,
            state: "stuck".to_owned(),
            reason: reason.to_owned(),
            text: String::new(),
            remedy: String::new(),
            place: Pose::default(),
            lost: false,
            evidence: Evidence::default(),
        }))
    }

    #[test]
    fn what_is_not_known_is_absent_and_stops_are_counted_once() {
        let mut figures = Figures::default();
        assert!(!figures.page().contains("rvac_battery"), "{}", figures.page());
        figures.daemon(true);
        for update in [
            stop(1, "slip"),
            stop(2, "slip"),
            stop(2, "slip"),
            stop(3, "of-tomorrow"),
        ] {
            figures.take(&update);
        }
        figures.take(&Update::Status(Status {
            state: "stuck".to_owned(),
            reason: "slip".to_owned(),
            ..Status::default()
        }));
        figures.take(&Update::Device(DeviceTable {
            daemon: Some(DaemonLoad {
                memory_bytes: None,
                busy_s: 12.5,
                longest_turn_ms: 2.0,
            }),
            ..DeviceTable::default()
        }));
        let page = figures.page();
        assert!(!page.contains("rvac_daemon_resident_memory_bytes"), "{page}");
        for line in [
            "rvac_daemon_busy_seconds_total 12.5\n",
            "rvac_daemon_longest_turn_seconds 0.002\n",
            "rvac_stops_total{reason=\"slip\"} 2\n",
            "rvac_stops_total{reason=\"other\"} 1\n",
            "rvac_activity{activity=\"stuck\"} 1\n",
            "rvac_trouble{trouble=\"held\"} 1\n",
        ] {
            assert!(page.contains(line), "{line} in {page}");
        }
        figures.daemon(false);
        let page = figures.page();
        assert!(
            !page.contains("rvac_activity") && page.contains("rvac_daemon_up 0\n"),
            "{page}"
        );
    }
}
