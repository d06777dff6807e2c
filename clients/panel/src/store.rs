//! The state of the page, as signals that the views follow.

mod incoming;

use leptos::prelude::*;
use mixer::Steered;
use panel_logic::{Currency, DecisionBook, Driver, LogBook, News, Offers, Presses, RoomRow, top_speeds};
use rvac_api::{
    ComponentHealth, DeviceTable, Estimate, Evidence, Failure, FloorsView, KeptMap, LearntPart, LearntView,
    Request, RequestBody, RobotDescription, SimulatedTruth, SoftwareUpdate, Standstill, Status, Topic,
};

use crate::access::{EDITS_MIXES, Entrance};
use crate::calibration_view::CalibrationDesk;
use crate::drive::Seat;
use crate::floor_files::FloorDesk;
use crate::history::HistoryDesk;
use crate::late::Late;
use crate::link::Link;
use crate::map::{Edits, MapHandle, Orders};
use crate::mixes::Bench;
use crate::news::{no_news, now_ms};
use crate::notify::Notifier;
use crate::schedules::ScheduleDesk;
use crate::toasts::Undo;

/// The reason of the state while the daemon behind the server does not answer.
const NO_DAEMON: &str = "no-daemon";
/// Number of the drive requests, so that a refusal of one is known as such.
const DRIVE_ID: u32 = 1;

/// Number of the request that keeps a mix.
const MIX_ID: u32 = 3;

/// Number of the requests that save a schedule.
pub(crate) const SCHEDULE_ID: u32 = 4;

/// Number of the requests for a run that is over.
pub(crate) const RUN_ID: u32 = 5;

/// Number of the requests that say that a part was cleaned or replaced.
const HEALTH_ID: u32 = 6;

/// Number of the requests that have something forgotten.
const LEARNT_ID: u32 = 8;

/// Number of the requests with lent inputs, so that a refusal of one is recognized.
const LEND_ID: u32 = 9;

/// Number of all other requests.
const OTHER_ID: u32 = 2;

/// Everything the views share. It is a bundle of handles and cheap to copy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Store {
    /// What the robot does; none before the first word.
    pub(crate) status: RwSignal<Option<Status>>,
    /// The robot, once known.
    pub(crate) robot: RwSignal<Option<RobotDescription>>,
    /// Strategies that can be started.
    pub(crate) strategies: RwSignal<Vec<String>>,
    /// The device table.
    pub(crate) device: RwSignal<Option<DeviceTable>>,
    /// Where a simulated robot really is.
    pub(crate) truth: RwSignal<Option<SimulatedTruth>>,
    /// Name of the simulated home.
    pub(crate) home: RwSignal<Option<String>>,
    /// Rooms on the robot's map.
    pub(crate) rooms: RwSignal<Vec<RoomRow>>,
    /// The detected surfaces, in words.
    pub(crate) carpet: RwSignal<Option<String>>,
    /// How sure it is.
    pub(crate) estimate: RwSignal<Option<Estimate>>,
    /// What it decided.
    pub(crate) decisions: RwSignal<DecisionBook>,
    /// Its newest standstill without an order.
    pub(crate) standstill: RwSignal<Option<Standstill>>,
    /// The floors, and on which of them the robot is.
    pub(crate) floors: RwSignal<FloorsView>,
    /// Floors as a file.
    pub(crate) floor_desk: FloorDesk,
    /// The last update of the robot's software, as far as this device may know of it.
    pub(crate) software: RwSignal<Option<SoftwareUpdate>>,
    /// Versions of the map of a floor that the daemon keeps, newest first.
    pub(crate) maps: RwSignal<Vec<KeptMap>>,
    /// That floor.
    pub(crate) maps_floor: RwSignal<Option<u16>>,
    /// What a person orders.
    pub(crate) orders: Orders,
    /// What was edited in the map.
    pub(crate) edits: Edits,
    /// What starts by itself.
    pub(crate) schedules: ScheduleDesk,
    /// How the parts are.
    pub(crate) health: RwSignal<Vec<ComponentHealth>>,
    /// What robots have learnt of themselves.
    pub(crate) learnt: RwSignal<Vec<LearntView>>,
    /// What was measured of the robot, and the calibration that this page does.
    pub(crate) calibration: CalibrationDesk,
    /// Runs that are over.
    pub(crate) history: HistoryDesk,
    /// The log.
    pub(crate) log: RwSignal<LogBook>,
    /// Whether what is shown is true now.
    pub(crate) currency: RwSignal<Currency>,
    /// How often a connection was opened: what was asked before the first, or between two, was not heard.
    pub(crate) opened: RwSignal<u32>,
    pub(crate) news: StoredValue<News>,
    /// Presses of job buttons that wait for their answer.
    pub(crate) presses: RwSignal<Presses>,
    /// Notifications of the system.
    pub(crate) notifier: Notifier,
    /// What became of the last one, where that is not seen otherwise.
    pub(crate) note: RwSignal<Option<&'static str>>,
    /// When the daemon began, seconds since 1970 by the clock of this device.
    pub(crate) daemon_began_s: StoredValue<Option<f64>>,
    /// What was removed last and can be taken back.
    pub(crate) undo: RwSignal<Option<Undo>>,
    /// Views that are loaded after the first picture.
    pub(crate) late: Late,
    /// Strategy by which a job of the whole home is started; empty as long as the robot chooses.
    pub(crate) strategy: RwSignal<String>,
    /// Length of the planned path, metres.
    pub(crate) route_m: RwSignal<f64>,
    /// The last refusal, until it is dismissed.
    pub(crate) refusal: RwSignal<Option<Failure>>,
    /// Sensor readings and attempts at the time of a question about that refusal.
    pub(crate) evidence: RwSignal<Option<Evidence>>,
    /// Who drives, and by which mix.
    pub(crate) seat: Seat,
    /// The mix that is edited.
    pub(crate) bench: Bench,
    /// Who this device is to the robot.
    pub(crate) entrance: Entrance,
    /// The map.
    pub(crate) map: StoredValue<MapHandle, LocalStorage>,
    /// The connection to the server.
    link: StoredValue<Link, LocalStorage>,
}

impl Store {
    pub(crate) fn new() -> Self {
        Self {
            status: RwSignal::new(None),
            robot: RwSignal::new(None),
            strategies: RwSignal::new(Vec::new()),
            device: RwSignal::new(None),
            truth: RwSignal::new(None),
            home: RwSignal::new(None),
            rooms: RwSignal::new(Vec::new()),
            carpet: RwSignal::new(None),
            estimate: RwSignal::new(None),
            decisions: RwSignal::new(DecisionBook::default()),
            standstill: RwSignal::new(None),
            floors: RwSignal::new(FloorsView::default()),
            floor_desk: FloorDesk::new(),
            software: RwSignal::new(None),
            maps: RwSignal::new(Vec::new()),
            maps_floor: RwSignal::new(None),
            orders: Orders::new(),
            edits: Edits::new(),
            schedules: ScheduleDesk::new(),
            health: RwSignal::new(Vec::new()),
            learnt: RwSignal::new(Vec::new()),
            calibration: CalibrationDesk::default(),
            history: HistoryDesk::new(),
            log: RwSignal::new(LogBook::default()),
            currency: RwSignal::new(Currency::Current),
            opened: RwSignal::new(0),
            news: no_news(),
            presses: RwSignal::new(Presses::default()),
            notifier: Notifier::new(),
            note: RwSignal::new(None),
            daemon_began_s: StoredValue::new(None),
            undo: RwSignal::new(None),
            late: Late::new(),
            strategy: RwSignal::new(String::new()),
            route_m: RwSignal::new(0.0),
            refusal: RwSignal::new(None),
            evidence: RwSignal::new(None),
            seat: Seat::new(),
            bench: Bench::new(),
            entrance: Entrance::new(),
            map: StoredValue::new_local(MapHandle::default()),
            link: StoredValue::new_local(Link::default()),
        }
    }

    /// Connects to the server, for ever.
    pub(crate) fn connect(self) {
        self.link.with_value(|link| link.connect(self));
        self.watch_news();
    }

    /// Gives up a connection that is silent, and makes a new one.
    pub(crate) fn reconnect(self) {
        self.link.with_value(|link| link.abandon(self));
    }

    /// The offers of the moment; a view that asks follows them.
    pub(crate) fn offers(self) -> Offers {
        self.status.with(|status| {
            self.robot
                .with(|robot| Offers::of(status.as_ref(), robot.as_ref()))
                .within(|verb| self.may(verb))
        })
    }

    /// Asks for something that a person pressed.
    pub(crate) fn ask(self, body: RequestBody) {
        if self.admits_request(&body) {
            self.refusal.set(None);
            let id = match body {
                RequestBody::ResetHealth { .. }
                | RequestBody::RenewPart { .. }
                | RequestBody::UndoRenewPart { .. } => HEALTH_ID,
                _ => OTHER_ID,
            };
            self.send(Some(id), body);
        }
    }

    /// Sends a request that no button press caused.
    pub(crate) fn ask_quietly(self, body: RequestBody) {
        self.send(None, body);
    }

    /// Requests the sensor readings and attempts up to now; the refusal that they explain stays.
    pub(crate) fn ask_for_evidence(self) {
        self.send(Some(OTHER_ID), RequestBody::Evidence);
    }

    /// Asks under a number of its own.
    pub(crate) fn ask_as(self, id: u32, body: RequestBody) {
        self.send(Some(id), body);
    }

    /// Reads all inputs and sends the resulting commands. To be called fifty times a second.
    pub(crate) fn drive(self) {
        let top = self.robot.with_untracked(|robot| top_speeds(robot.as_ref()));
        self.send_steered(self.seat.step(top));
    }

    /// All inputs are lost: releases them, and sends that at once.
    pub(crate) fn let_go(self) {
        self.send_steered(self.seat.lose());
        self.pause_lending();
    }

    /// Reads all inputs without driving; returns the time of the reading.
    pub(crate) fn step_aside(self) -> u64 {
        let (steered, now_us) = self.seat.step_aside();
        self.send_steered(steered);
        now_us
    }

    /// Sends the lent inputs to the robot, if there is anything to send.
    pub(crate) fn say_lent(self, said: Option<RequestBody>) {
        if let Some(body) = said {
            self.send(Some(LEND_ID), body);
        }
    }

    /// Reads all inputs for the mix that is edited.
    pub(crate) fn edit_step(self) {
        let now_us = self.step_aside();
        self.pause_lending();
        self.seat
            .driver
            .with_value(|driver| self.bench.step(now_us, driver.readings()));
    }

    /// Asks the robot to keep the mix that is edited.
    pub(crate) fn save_mix(self) {
        if self.admits(EDITS_MIXES)
            && let Some((profile, was)) = self.bench.profile_to_save()
        {
            self.refusal.set(None);
            self.send(Some(MIX_ID), RequestBody::SaveMix { profile, was });
        }
    }

    /// Says that a part was replaced, or cleaned where that is what is done with it; the way back is offered.
    pub(crate) fn renew_part(self, component: String, said: String) {
        let body = RequestBody::RenewPart {
            component: component.clone(),
        };
        if self.admits_request(&body) {
            self.ask(body);
            self.undo.set(Some(Undo {
                what: said,
                body: RequestBody::UndoRenewPart { component },
            }));
        }
    }

    /// Says that a part was changed of which a robot had learnt something.
    pub(crate) fn forget_learnt(self, device: String, part: LearntPart) {
        let part = Some(part);
        let body = RequestBody::ForgetLearnt { device, part };
        if self.admits_request(&body) {
            self.refusal.set(None);
            self.send(Some(LEARNT_ID), body);
        }
    }

    fn on_done(self, id: u32) {
        self.end_press(id, true);
        match id {
            HEALTH_ID => self.send(None, RequestBody::Health),
            LEARNT_ID => self.send(None, RequestBody::Learnt),
            _ => {}
        }
        self.edits.on_done(id, &self.known_home());
        self.take_put_off_steps();
        self.schedules.on_done(id);
        self.on_floors_done(id);
        if id == MIX_ID
            && let Some(name) = self.bench.on_kept()
        {
            self.seat.choose(Some(name));
            self.send(None, RequestBody::Mixes);
        }
    }

    fn send_steered(self, steered: Steered) {
        for press in steered.presses {
            self.ask(press);
        }
        // Sticks and keys are read fifty times a second: on a device that may not drive they send nothing.
        let may_drive = self.entrance.access.with_untracked(|access| access.may("drive"));
        if let Some(body) = steered.seat.filter(|_| may_drive) {
            self.send(Some(DRIVE_ID), body);
        }
    }

    /// The connection is open: introduces the page.
    pub(crate) fn on_open(self) {
        self.news.update_value(|news| news.on_open(now_ms()));
        self.log.update(LogBook::clear);
        self.decisions.update(DecisionBook::clear);
        self.estimate.set(None);
        self.introduce();
        let topics = vec![
            Topic::Status,
            Topic::Pose,
            Topic::Device,
            Topic::Map,
            Topic::Home,
            Topic::Estimate,
            Topic::PlannedPath,
            Topic::Decisions,
            Topic::Log,
            Topic::Schedules,
            Topic::Floors,
            Topic::Standstills,
            Topic::Runs,
            Topic::Inputs,
        ];
        self.send(None, RequestBody::Watch { topics });
        self.send(None, RequestBody::Mixes);
        self.ask_for_last_run();
        self.opened.update(|count| *count += 1);
    }

    /// The connection is lost.
    pub(crate) fn on_close(self) {
        // Nothing can be said any more: the lease ends by itself.
        self.seat.lose();
        self.pause_lending();
        self.edits.on_lost();
        self.seat.driver.update_value(Driver::forget_inputs);
        self.floor_desk.on_close();
        // The state stays as it was for the moment that a glitch takes.
        self.news.update_value(News::on_close);
    }

    fn send(self, id: Option<u32>, body: RequestBody) {
        self.link.with_value(|link| link.send(&Request { id, body }));
    }
}
