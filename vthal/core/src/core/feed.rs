//! What clients are told, and how often.

use brain::{MapCursor, SweptShare};
use rvac_api::{
    API_VERSION, DeviceTable, Estimate, FloorsView, LinkReading, PlannedWay, Pose, Status, Topic, Update,
    Versions,
};

use super::{Core, recorder};
use crate::clients::Clients;
use crate::device::{Description, Report, Supervisor};
use crate::mind::Mind;
use crate::observe::currents_a;
use crate::outputs::{Delivery, Recipients};
use crate::swept_sigma::SweptSigma;
use crate::{ClientId, ExpertAccess, Outputs, Record, to_api};

/// Poses go out at most this often.
const POSE_US: u64 = 50_000;
/// The device table goes out this often.
const DEVICE_US: u64 = 500_000;
/// The device table goes to a recording this often.
const RECORDED_DEVICE_US: u64 = 1_000_000;
/// Map deltas go out at most this often.
const MAP_US: u64 = 200_000;
/// A status whose figures alone changed goes out at most this often.
const FIGURES_US: u64 = 1_000_000;
/// Pause between two views of the home: walls are looked for in each.
const HOME_US: u64 = 5_000_000;
/// Estimates go out at most this often.
const ESTIMATE_US: u64 = 500_000;
/// Pause between two looks at how much is swept: cells are counted in each.
const SHARE_US: u64 = 5_000_000;
/// Changes of an estimate that nobody would see: metres or radians, and shares.
const UNSEEN: f64 = 0.002;
/// Planned ways go out at most this often.
const WAY_US: u64 = 2_000_000;

/// When each kind of update last went out.
#[derive(Debug, Default)]
pub(super) struct Feed {
    status: Option<Status>,
    status_us: u64,
    pose: Pose,
    pose_us: u64,
    device_us: u64,
    recorded_device_us: u64,
    map_us: u64,
    map_cursor: MapCursor,
    map_number: u32,
    swept_us: u64,
    swept_cursor: MapCursor,
    swept_number: u32,
    swept_sigma: SweptSigma,
    home_us: u64,
    home_revision: u32,
    estimate_us: u64,
    estimate: Estimate,
    share_us: u64,
    share: Option<SweptShare>,
    floors: Option<FloorsView>,
    way_us: u64,
    way: PlannedWay,
    state_changed_us: Option<u64>,
}

impl Feed {
    /// The behaviour state has changed.
    pub(super) fn state_changed(&mut self, now_us: u64) {
        self.state_changed_us = Some(now_us);
    }

    /// A person has changed the home and waits to see it: it is told at once.
    pub(super) fn tell_home_now(&mut self) {
        self.home_us = 0;
    }

    /// Whether it has changed within the last `span_us`.
    pub(super) fn state_changed_within(&self, now_us: u64, span_us: u64) -> bool {
        self.state_changed_us
            .is_some_and(|then_us| now_us < then_us + span_us)
    }

    /// When something is due that no report of the robot would bring.
    pub(super) fn next_wake_us(&self, clients: &Clients) -> Option<u64> {
        clients.any(Topic::Device).then_some(self.device_us + DEVICE_US)
    }
}

impl Core {
    pub(super) fn feed(&mut self, now_us: u64, outputs: &mut Outputs) {
        if self.clients.any_topic() || self.records() {
            self.feed_status(now_us, outputs);
            self.feed_pose(now_us, outputs);
        }
        if self.clients.any(Topic::Device) && now_us >= self.feed.device_us + DEVICE_US {
            self.feed.device_us = now_us;
            let update = Update::Device(self.device_table(now_us));
            followers(Topic::Device, update, outputs);
        }
        if self.records() && now_us >= self.feed.recorded_device_us + RECORDED_DEVICE_US {
            self.feed.recorded_device_us = now_us;
            let table = Box::new(self.device_table(now_us));
            outputs.records.push(Record::Device {
                time_us: now_us,
                table,
            });
        }
        // Whether or not anybody looks: later nobody knows how sure the robot was.
        if now_us >= self.feed.swept_us + MAP_US {
            self.feed.swept_us = now_us;
            self.note_swept();
        }
        if self.clients.any(Topic::Map) && now_us >= self.feed.map_us + MAP_US {
            self.feed.map_us = now_us;
            self.feed_map(outputs);
        }
        if self.clients.any(Topic::Home) && now_us >= self.feed.home_us + HOME_US {
            self.feed.home_us = now_us;
            self.feed_home(outputs);
        }
        if self.clients.any(Topic::Estimate) && now_us >= self.feed.estimate_us + ESTIMATE_US {
            self.feed.estimate_us = now_us;
            self.feed_estimate(now_us, outputs);
        }
        if self.clients.any(Topic::Way) && now_us >= self.feed.way_us + WAY_US {
            self.feed.way_us = now_us;
            self.feed_way(outputs);
        }
        if self.clients.any(Topic::Floors) {
            self.feed_floors(outputs);
        }
        self.feed_inputs(now_us, outputs);
        self.follow_checkpoint(now_us, outputs);
    }

    fn feed_estimate(&mut self, now_us: u64, outputs: &mut Outputs) {
        let Some(mind) = &self.mind else { return };
        if now_us >= self.feed.share_us + SHARE_US {
            self.feed.share_us = now_us;
            self.feed.share = mind.brain().swept_share();
        }
        let estimate = to_api::estimate(mind.brain(), self.feed.share);
        if !looks_alike(&self.feed.estimate, &estimate) {
            self.feed.estimate = estimate;
            followers(Topic::Estimate, Update::Estimate(estimate), outputs);
        }
    }

    fn feed_floors(&mut self, outputs: &mut Outputs) {
        if self.is_new_of_floors(self.feed.floors.as_ref()) {
            let floors = self.floors_view();
            self.feed.floors = Some(floors.clone());
            followers(Topic::Floors, Update::Floors(floors), outputs);
        }
    }

    fn feed_way(&mut self, outputs: &mut Outputs) {
        let Some(mind) = &self.mind else { return };
        let way = to_api::way(mind.brain());
        if way != self.feed.way {
            self.feed.way = way.clone();
            followers(Topic::Way, Update::Way(way), outputs);
        }
    }

    fn feed_home(&mut self, outputs: &mut Outputs) {
        let Some(mind) = &self.mind else { return };
        let revision = mind.home_revision();
        if revision != self.feed.home_revision {
            self.feed.home_revision = revision;
            followers(Topic::Home, Update::Home(mind.home_view()), outputs);
        }
    }

    fn feed_status(&mut self, now_us: u64, outputs: &mut Outputs) {
        let status = self.status();
        let due = match &self.feed.status {
            Some(old) if is_same_situation(old, &status) => {
                *old != status && now_us >= self.feed.status_us + FIGURES_US
            }
            _ => true,
        };
        if !due {
            return;
        }
        self.feed.status_us = now_us;
        self.feed.status = Some(status.clone());
        let mind_recorded = self.mind.as_ref().is_some_and(Mind::is_recorded);
        if mind_recorded && let Some(records) = recorder(self.config.recording, outputs).records {
            records.push(Record::Status {
                time_us: now_us,
                status: status.clone(),
            });
        }
        if self.clients.any(Topic::Status) {
            followers(Topic::Status, Update::Status(status), outputs);
        }
    }

    fn feed_pose(&mut self, now_us: u64, outputs: &mut Outputs) {
        if now_us < self.feed.pose_us + POSE_US {
            return;
        }
        let pose = self.pose();
        let moved = Pose {
            t: self.feed.pose.t,
            ..pose
        } != self.feed.pose;
        if !moved {
            return;
        }
        self.feed.pose = pose;
        self.feed.pose_us = now_us;
        let mind_recorded = self.mind.as_ref().is_some_and(Mind::is_recorded);
        if mind_recorded && let Some(records) = recorder(self.config.recording, outputs).records {
            records.push(Record::Pose(pose));
        }
        if self.clients.any(Topic::Pose) {
            followers(Topic::Pose, Update::Pose(pose), outputs);
        }
    }

    /// Notes how sure the robot was of its place when it swept what is new.
    fn note_swept(&mut self) {
        let Some(mind) = &self.mind else { return };
        let (number, map) = (mind.map_number(), mind.brain().map());
        let new = (number == self.feed.swept_number)
            .then(|| map.since(self.feed.swept_cursor))
            .flatten();
        self.feed.swept_cursor = mind.map_cursor();
        self.feed.swept_number = number;
        let present_m = mind.brain().estimate().sigma_m;
        if let Some(part) = new {
            self.feed.swept_sigma.add(part.swept.len(), present_m);
            return;
        }
        // Drawn anew or read from the disk: the home remembers how surely it was seen.
        self.feed.swept_sigma = SweptSigma::default();
        for cell in map.snapshot().swept {
            let sigma_m = map.sigma_m(*cell).unwrap_or(present_m);
            self.feed.swept_sigma.add(1, sigma_m);
        }
    }

    fn feed_map(&mut self, outputs: &mut Outputs) {
        self.note_swept();
        let Some(mind) = &self.mind else { return };
        let number = mind.map_number();
        let delta = (number == self.feed.map_number)
            .then(|| mind.brain().map().since(self.feed.map_cursor))
            .flatten();
        self.feed.map_cursor = mind.map_cursor();
        self.feed.map_number = number;
        let update = match delta {
            Some(part) if part.swept.is_empty() && part.path.is_empty() && part.hazards.is_empty() => return,
            Some(part) => Update::MapDelta(to_api::map_delta(number, &part, &self.feed.swept_sigma)),
            None => {
                let snapshot = mind.brain().map().snapshot();
                Update::Map(to_api::map_snapshot(number, &snapshot, &self.feed.swept_sigma))
            }
        };
        followers(Topic::Map, update, outputs);
    }

    /// What a new follower of a topic gets at once.
    pub(super) fn first_view(
        &mut self,
        now_us: u64,
        (client, topic): (ClientId, Topic),
        outputs: &mut Outputs,
    ) {
        let one = |update| Delivery {
            to: Recipients::One(client),
            update,
        };
        match topic {
            Topic::Status => outputs.deliveries.push(one(Update::Status(self.status()))),
            Topic::Pose => outputs.deliveries.push(one(Update::Pose(self.pose()))),
            Topic::Device => outputs
                .deliveries
                .push(one(Update::Device(self.device_table(now_us)))),
            Topic::Log => {
                let entries = self.journal.entries().cloned();
                outputs
                    .deliveries
                    .extend(entries.map(|entry| one(Update::Log(entry))));
            }
            Topic::Map => {
                // Others first hear what is new, so that one cursor serves all.
                self.feed_map(outputs);
                if let Some(mind) = &self.mind {
                    let snapshot = mind.brain().map().snapshot();
                    let map = to_api::map_snapshot(mind.map_number(), &snapshot, &self.feed.swept_sigma);
                    outputs.deliveries.push(one(Update::Map(map)));
                }
            }
            Topic::Home => {
                if let Some(mind) = &self.mind {
                    outputs.deliveries.push(one(Update::Home(mind.home_view())));
                }
            }
            Topic::Estimate => {
                if let Some(mind) = &self.mind {
                    let brain = mind.brain();
                    let estimate = to_api::estimate(brain, brain.swept_share());
                    outputs.deliveries.push(one(Update::Estimate(estimate)));
                }
            }
            Topic::Way => {
                if let Some(mind) = &self.mind {
                    let way = to_api::way(mind.brain());
                    outputs.deliveries.push(one(Update::Way(way)));
                }
            }
            Topic::Decisions => {
                let entries = self.diary.entries().cloned();
                outputs
                    .deliveries
                    .extend(entries.map(|entry| one(Update::Decision(entry))));
            }
            Topic::Schedules => outputs.deliveries.push(one(Update::Schedules(self.schedules()))),
            Topic::Floors => outputs.deliveries.push(one(Update::Floors(self.floors_view()))),
            Topic::Standstills => {
                let all = self.standstills.entries().cloned();
                outputs
                    .deliveries
                    .extend(all.map(|told| one(Update::Standstill(Box::new(told)))));
            }
            Topic::Inputs => outputs.deliveries.push(one(self.inputs_view(now_us))),
            Topic::Packets | Topic::Runs | Topic::Buttons => {}
        }
    }

    /// Answer to `hello`.
    pub(super) fn greeting(&self) -> Update {
        Update::Hello {
            api: API_VERSION,
            versions: self.versions(),
            robot: self.description().map(to_api::robot),
            strategies: brain::StrategyName::ALL
                .iter()
                .map(|strategy| strategy.name().to_owned())
                .collect(),
            expert: self.config.expert == ExpertAccess::Allowed,
        }
    }

    pub(super) fn description(&self) -> Option<&Description> {
        self.device.as_ref().and_then(Supervisor::description)
    }

    fn versions(&self) -> Versions {
        let description = self.description();
        Versions {
            vthal: self.config.version.clone(),
            brain: self.config.version.clone(),
            firmware: description.map(|robot| robot.identity.firmware.clone()),
            cordlib: self.facts.slow.as_ref().and_then(|slow| slow.library.clone()),
            protocol: description.map(|robot| robot.identity.protocol),
        }
    }

    fn device_table(&self, now_us: u64) -> DeviceTable {
        let (bytes_in_per_s, bytes_out_per_s) = self.facts.bytes_per_s();
        let mut table = DeviceTable {
            versions: self.versions(),
            battery: self
                .facts
                .slow
                .as_ref()
                .and_then(|slow| slow.battery.as_ref())
                .map(to_api::battery),
            main_loop_hz: self.facts.slow.as_ref().and_then(|slow| slow.main_loop_hz),
            bytes_out_per_s,
            bytes_in_per_s,
            link: self.link_reading(now_us),
            ..DeviceTable::default()
        };
        if let (Some(report), Some(description)) = (&self.facts.report, self.description()) {
            fill_from_report(&mut table, report, description);
            table.wheel_left_m_per_s = self.facts.wheel_speeds.left_m_per_s;
            table.wheel_right_m_per_s = self.facts.wheel_speeds.right_m_per_s;
        }
        table
    }

    fn link_reading(&self, now_us: u64) -> LinkReading {
        let quality = self
            .device
            .as_ref()
            .map(Supervisor::link_quality)
            .unwrap_or_default();
        LinkReading {
            up: self.link_view(now_us).up,
            age_ms: self.facts.age_ms(now_us).unwrap_or(u32::MAX),
            bad_share: quality.bad_share,
            round_trip_ms: quality.round_trip_ms,
            resets: self.facts.resets(),
            reset_cause: self.facts.reset_cause().map(str::to_owned),
            reconnects: self.facts.reconnects(),
            binary: quality.is_binary,
        }
    }
}

fn fill_from_report(table: &mut DeviceTable, report: &Report, description: &Description) {
    table.bumpers = [report.contacts.left, report.contacts.right];
    table.cliffs = [report.cliffs.left, report.cliffs.middle, report.cliffs.right];
    table.wheel_drops = [report.wheel_drops.left, report.wheel_drops.right];
    table.proximity = report
        .proximity
        .iter()
        .take(usize::from(description.sensors.proximity))
        .copied()
        .collect();
    table.currents_a = currents_a(report);
    let running = report.cleaners;
    table.cleaners = [running.brush_main, running.brush_sides, running.vacuum];
    table.dust_box = report.dust_box;
    table.docked = report.docked;
}

fn followers(topic: Topic, update: Update, outputs: &mut Outputs) {
    outputs.deliveries.push(Delivery {
        to: Recipients::Followers(topic),
        update,
    });
}

/// Whether two estimates are the same for people.
fn looks_alike(old: &Estimate, new: &Estimate) -> bool {
    let near = |one: f64, other: f64| (one - other).abs() < UNSEEN;
    let both = |one: Option<f64>, other: Option<f64>| match (one, other) {
        (Some(one), Some(other)) => near(one, other),
        (one, other) => one.is_none() && other.is_none(),
    };
    old.lost == new.lost
        && near(old.sigma_m, new.sigma_m)
        && near(old.sigma_rad, new.sigma_rad)
        && both(old.agreement, new.agreement)
        && both(old.covered, new.covered)
        && both(old.covered_low, new.covered_low)
}

/// Whether only figures differ, which change all the time.
fn is_same_situation(old: &Status, new: &Status) -> bool {
    old.state == new.state
        && old.reason == new.reason
        && old.strategy == new.strategy
        && old.inhibits == new.inhibits
        && old.driver == new.driver
        && old.bumps == new.bumps
}
