//! What comes from the robot, given to the parts that it is for.

use leptos::prelude::*;
use panel_logic::{Driver, carpet_sentence, room_rows, route_length_m};
use rvac_api::{Failure, HomeView, PlannedPath, RequestBody, Run, Status, Update as Message};

use super::{DRIVE_ID, LEND_ID, MIX_ID, NO_DAEMON, Store};
use crate::access::Newcomer;
use crate::changes::set_if_changed;
use crate::language::words;

impl Store {
    /// A message came.
    pub(crate) fn on_update(self, update: Message) {
        match update {
            Message::Hello {
                robot, strategies, ..
            } => {
                self.map.with_value(|map| map.set_robot(robot.as_ref()));
                self.robot.set(robot);
                self.strategies.set(strategies);
            }
            Message::Status(status) => self.on_status(status),
            Message::Device(table) => self.device.set(Some(table)),
            Message::Log(entry) => self.log.update(|log| log.push(entry)),
            Message::Failed(failure) => self.on_failed(failure),
            Message::SimulatedTruth(truth) => {
                self.map.with_value(|map| map.on_truth(truth.pose));
                self.truth.set(Some(truth));
            }
            Message::SimulatedPlan(plan) => {
                self.map.with_value(|map| map.set_plan(&plan));
                self.home.set(Some(plan.name));
            }
            Message::Pose(pose) => {
                self.set_wall_clock(pose.t);
                self.seat.on_pose(pose);
                self.map.with_value(|map| map.on_pose(pose));
            }
            Message::Map(snapshot) => self.map.with_value(|map| map.on_snapshot(&snapshot)),
            Message::MapDelta(delta) => self.map.with_value(|map| map.on_delta(&delta)),
            Message::Home(home) => self.on_home(&home),
            Message::Estimate(estimate) => {
                self.map.with_value(|map| map.on_estimate(&estimate));
                self.estimate.set(Some(estimate));
            }
            Message::PlannedPath(path) => self.on_planned_path(&path),
            Message::Heartbeat { silent_ms } => self.on_heartbeat(silent_ms),
            Message::Evidence { evidence, .. } => self.evidence.set(Some(evidence)),
            Message::Standstill(told) => self.standstill.set(Some(*told)),
            Message::Decision(decision) => self.decisions.update(|book| book.push(decision)),
            Message::Maps { floor, maps } => {
                self.maps_floor.set(floor);
                self.maps.set(maps);
            }
            Message::Floors(floors) => {
                self.edits.on_floor(floors.here);
                self.floors.set(floors);
            }
            Message::Health { components, .. } => self.health.set(components),
            Message::Learnt { devices, .. } => self.learnt.set(devices),
            Message::Calibration { values, file, .. } => self.calibration.on_values(values, file),
            Message::CalibrationPage(page) => self.calibration.on_page(*page),
            Message::JobEstimate(estimate) => self.orders.on_estimate(&estimate),
            Message::Mixes { mixes } => self.seat.on_mixes(&mixes),
            Message::Done { id } => self.on_done(id),
            Message::Schedules(schedules) => self.schedules.on_schedules(schedules),
            Message::Runs { runs, more } => self.history.on_runs(runs, more),
            Message::Run(record) => self.history.on_record(*record),
            Message::RunKept(run) => self.on_run_kept(*run),
            Message::Statistics(sums) => self.history.on_statistics(*sums),
            Message::RunTrack(track) => self.history.on_track(*track),
            Message::Inputs { inputs } => self.seat.on_inputs(&inputs),
            Message::Packet { .. }
            | Message::Piece { .. }
            | Message::RunFile { .. }
            | Message::FloorArchive { .. }
            | Message::Button { .. } => {}
            Message::SoftwareUpdate(told) => self.software.set(Some(*told)),
            Message::NewDevice { name, role, from } => self.entrance.meet(Newcomer { name, role, from }),
        }
    }

    fn on_run_kept(self, run: Run) {
        self.notifier.on_run(&run);
        self.history.on_kept(run);
        self.renew_lifetime();
    }

    fn on_planned_path(self, path: &PlannedPath) {
        set_if_changed(self.route_m, route_length_m(path));
        self.map.with_value(|map| map.on_planned_path(path));
    }

    fn on_home(self, home: &HomeView) {
        let rows = room_rows(words(), home);
        set_if_changed(self.rooms, rows);
        set_if_changed(self.carpet, carpet_sentence(words(), home));
        self.orders.on_home(home);
        self.map.with_value(|map| map.on_home(home));
        self.take_put_off_steps();
    }

    /// Says what this is, and asks what the robot is.
    pub(super) fn introduce(self) {
        let name = "panel".to_owned();
        self.send(None, RequestBody::Hello { name });
    }

    fn on_status(self, status: Status) {
        self.seat.on_status(&status);
        self.notifier.on_status(&status);
        let was_away = self.status.with_untracked(|before| {
            before
                .as_ref()
                .is_some_and(|before| before.state == "disconnected")
        });
        if was_away && status.state != "disconnected" {
            // What comes back may have been programmed anew.
            self.introduce();
        }
        if status.state == "disconnected" {
            self.device.set(None);
        }
        if status.reason == NO_DAEMON {
            self.edits.on_lost();
        }
        self.forget_why_not(&status);
        self.status.set(Some(status));
    }

    fn on_failed(self, failure: Failure) {
        if let Some(id) = failure.id {
            self.end_press(id, false);
        }
        self.edits.on_failed(&failure);
        if self.orders.on_failed(&failure)
            || self.schedules.on_failed(&failure)
            || self.history.on_failed(&failure)
            || self.floor_desk.on_failed(&failure)
        {
            return;
        }
        if failure.id == Some(MIX_ID) && failure.reason == "changed-meanwhile" {
            self.bench.on_changed_meanwhile();
        }
        if failure.id == Some(LEND_ID) {
            self.on_lending_refused();
        }
        if failure.id == Some(DRIVE_ID) {
            self.seat.driver.update_value(Driver::on_refused);
        }
        self.refusal.set(Some(failure));
    }
}
