//! Between the daemon and the domain.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use bridge::{Change, DRIVE_SILENCE, Daemon, DriveGate, Knowledge, News};
use futures::StreamExt as _;
use futures::stream::{FuturesUnordered, select_all};
use ros2_client::RmwRequestId;
use rvac_api::{Estimate, RequestBody, Topic, Update};
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, MissedTickBehavior, interval};

use crate::action::{self, DockWish};
use crate::convert::{self, FrameNames};
use crate::docking::DockView;
use crate::frames::{Frames, Links, TopSpeeds};
use crate::messages::{Header, Time, TriggerResponse, Twist};
use crate::node::{Publishers, Robot};
use crate::order::Order;
use crate::place::Place;
use crate::velocity::{self, LEASE_MS, Unfit};

const TOPICS: [Topic; 6] = [
    Topic::Status,
    Topic::Pose,
    Topic::Device,
    Topic::Home,
    Topic::Estimate,
    Topic::PlannedPath,
];
/// Commands of `/cmd_vel` go on at most so often, the newest of them: the daemon's own beat is 20 a second.
const BEAT: Duration = Duration::from_millis(25);
/// While the robot stands the daemon tells no poses, and `/tf` must not grow old.
const QUIET: Duration = Duration::from_millis(100);
/// The same complaint is said once in this time.
const COMPLAIN_AGAIN_AFTER: Duration = Duration::from_secs(5);
/// Of a robot that has not told its own: slow enough for any.
const CAREFUL: TopSpeeds = TopSpeeds {
    forward_m_per_s: 0.2,
    turn_rad_per_s: 1.0,
};

// The wheels must stand before the seat is given away.
const _: () = assert!(DRIVE_SILENCE.as_millis() > LEASE_MS as u128);

/// What the owner chose.
#[derive(Clone, Debug)]
pub(crate) struct Wishes {
    pub(crate) frame_prefix: String,
    pub(crate) clean: bool,
}

/// A call of a service that waits for the daemon's answer.
type Call = (Order, RmwRequestId);

/// Works until the node ends.
pub(crate) async fn run(robot: Robot, socket: &Path, wishes: Wishes) -> anyhow::Result<()> {
    let Robot {
        mut node,
        publishers,
        listeners,
    } = robot;
    let spinner = node.spinner()?;
    let mut spinning = std::pin::pin!(spinner.spin());
    let mut velocities = std::pin::pin!(listeners.velocity.async_stream());
    let mut stamped = std::pin::pin!(listeners.stamped.async_stream());
    let mut calls = select_all(listeners.orders.iter().map(|(order, server)| {
        let order = *order;
        server
            .receive_request_stream()
            .map(move |request| (order, request))
            .boxed_local()
    }));
    let mut answers = FuturesUnordered::new();
    let mut relay = Relay::new(socket, publishers, wishes);
    let (wishes_to_dock, mut to_dock) = mpsc::channel(1);
    let seen = relay.seen.subscribe();
    let mut docking = std::pin::pin!(action::serve(&listeners.docking, seen, wishes_to_dock));
    let mut beat = every(BEAT);
    let mut quiet = every(QUIET);
    loop {
        tokio::select! {
            ended = &mut spinning => return Ok(ended?),
            news = relay.daemon.next() => relay.hear(news).await,
            Some(Ok((twist, _))) = velocities.next() => relay.want(twist),
            Some(Ok((twist, _))) = stamped.next() => relay.want(twist.twist),
            Some((order, request)) = calls.next() => if let Ok((id, _)) = request {
                relay.call((order, id)).await;
            },
            _ = beat.tick() => relay.drive().await,
            _ = quiet.tick() => relay.keep_fresh(),
            Some(()) = answers.next() => {}
            Some(wish) = to_dock.recv() => relay.wish(wish).await,
            () = &mut docking => return Ok(()),
        }
        for ((order, id), answer) in relay.answered.drain(..) {
            if let Some((_, server)) = listeners.orders.iter().find(|(known, _)| *known == order) {
                answers.push(async move {
                    if let Err(error) = server.async_send_response(id, answer).await {
                        tracing::warn!(%error, service = order.service(), "the answer is not sent");
                    }
                });
            }
        }
    }
}

fn every(period: Duration) -> tokio::time::Interval {
    let mut ticks = interval(period);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    ticks
}

struct Relay {
    daemon: Daemon,
    known: Knowledge,
    estimate: Option<Estimate>,
    publishers: Publishers,
    names: FrameNames,
    clean: bool,
    frames: Frames,
    told_at: Instant,
    /// The newest command of `/cmd_vel` that is not sent on.
    wanted: Option<Twist>,
    gate: DriveGate,
    /// When the last one was sent on, while the seat is ours.
    driven_at: Option<Instant>,
    complaint: Option<(String, Instant)>,
    /// Calls by the numbers of their requests.
    waiting: BTreeMap<u32, Call>,
    answered: Vec<(Call, TriggerResponse)>,
    /// The request of the action's goal.
    docking: Option<u32>,
    /// What the action sees.
    seen: watch::Sender<DockView>,
}

impl Relay {
    fn new(socket: &Path, publishers: Publishers, wishes: Wishes) -> Self {
        Self {
            daemon: Daemon::new(socket.to_owned(), "rvac-ros2", &TOPICS),
            known: Knowledge::default(),
            estimate: None,
            publishers,
            names: FrameNames::with_prefix(&wishes.frame_prefix),
            clean: wishes.clean,
            frames: Frames::default(),
            told_at: Instant::now(),
            wanted: None,
            gate: DriveGate::shut_at(Instant::now()),
            driven_at: None,
            complaint: None,
            waiting: BTreeMap::new(),
            answered: Vec::new(),
            docking: None,
            seen: watch::Sender::default(),
        }
    }

    async fn hear(&mut self, news: News) {
        match news {
            News::Connected => {}
            News::Lost => self.lose(),
            News::Update(update) => {
                self.take(*update);
                if self.known.wants_hello() {
                    // A daemon that is away says it when it is there again.
                    self.daemon.hello().await.ok();
                }
            }
        }
    }

    fn lose(&mut self) {
        let was_there = self.known.status.is_some();
        self.known.forget_state();
        self.stop_driving();
        self.seen.send_replace(DockView::default());
        for (_, call) in std::mem::take(&mut self.waiting) {
            self.answered.push((call, away()));
        }
        if was_there {
            self.tell_diagnostics();
        }
    }

    fn take(&mut self, update: Update) {
        match &update {
            Update::Done { id } => {
                if let Some(call) = self.waiting.remove(id) {
                    self.answered.push((call, done()));
                }
            }
            Update::Failed(failure) => match failure.id.and_then(|id| self.waiting.remove(&id)) {
                Some(call) => self
                    .answered
                    .push((call, refused(&failure.reason, &failure.text))),
                None if failure.id.is_some() && failure.id == self.docking => {
                    let refusal = Some((failure.reason.clone(), failure.text.clone()));
                    self.seen.send_modify(|view| view.refusal = refusal);
                }
                // Nothing else is asked for that the daemon refuses.
                None => {
                    self.stop_driving();
                    self.complain(&failure.text);
                }
            },
            Update::Estimate(estimate) => self.estimate = Some(*estimate),
            Update::PlannedPath(path) => {
                let plan = convert::plan(path, &self.header(&self.names.map));
                sent("plan", self.publishers.plan.publish(plan).is_ok());
            }
            _ => {}
        }
        match self.known.take(&update) {
            Change::Pose => self.tell_pose(),
            Change::Home => self.tell_map(),
            Change::Device => {
                self.tell_battery();
                self.tell_diagnostics();
            }
            Change::Status => {
                let status = self.known.status.clone();
                self.seen.send_modify(|view| view.status = status);
                self.tell_diagnostics();
            }
            _ => {}
        }
    }

    fn top_speeds(&self) -> TopSpeeds {
        self.known.robot.as_ref().map_or(CAREFUL, |robot| TopSpeeds {
            forward_m_per_s: robot.speed_max_m_per_s,
            turn_rad_per_s: robot.turn_max_rad_per_s,
        })
    }

    fn header(&self, frame: &str) -> Header {
        Header {
            stamp: now(),
            frame_id: frame.to_owned(),
        }
    }

    fn tell_pose(&mut self) {
        let Some(pose) = self.known.pose else {
            return;
        };
        let links = self.frames.take(Place::from(pose), pose.t, self.top_speeds());
        self.tell(links);
        if let Some(estimate) = &self.estimate {
            let header = self.header(&self.names.map);
            let pose = convert::pose(links, estimate, header);
            sent("pose", self.publishers.pose.publish(pose).is_ok());
        }
    }

    fn tell(&mut self, links: Links) {
        self.told_at = Instant::now();
        let odom = self.header(&self.names.odom);
        let transforms = convert::transforms(&self.names, links, &odom);
        sent("tf", self.publishers.transforms.publish(transforms).is_ok());
        let odometry = convert::odometry(&self.names, links, odom);
        sent("odom", self.publishers.odometry.publish(odometry).is_ok());
    }

    /// Only while the daemon is there: frames of a robot that nobody knows anything of grow old.
    fn keep_fresh(&mut self) {
        if self.known.status.is_some()
            && self.told_at.elapsed() >= QUIET
            && let Some(links) = self.frames.stands()
        {
            self.tell(links);
        }
    }

    fn tell_map(&mut self) {
        if let Some(home) = &self.known.home {
            let grid = convert::grid(home, self.header(&self.names.map));
            sent("map", self.publishers.map.publish(grid).is_ok());
        }
    }

    fn tell_battery(&mut self) {
        let battery = self
            .known
            .device
            .as_ref()
            .and_then(|device| device.battery.as_ref());
        if let Some(reading) = battery {
            let message = convert::battery(reading, self.header(&self.names.base));
            sent("battery_state", self.publishers.battery.publish(message).is_ok());
        }
    }

    fn tell_diagnostics(&mut self) {
        let message = convert::diagnostics(
            self.known.status.as_ref(),
            self.known.device.as_ref(),
            self.header(""),
        );
        sent(
            "diagnostics",
            self.publishers.diagnostics.publish(message).is_ok(),
        );
    }

    fn want(&mut self, twist: Twist) {
        self.gate.hear(twist.is_zero(), Instant::now());
        self.wanted = Some(twist);
    }

    /// Whoever still commands must begin from rest again.
    fn stop_driving(&mut self) {
        self.driven_at = None;
        self.gate.shut();
    }

    async fn drive(&mut self) {
        let Some(twist) = self.wanted.take() else {
            return self.let_go().await;
        };
        if !self.gate.is_open() {
            return self.complain(Unfit::AlreadyRunning.text());
        }
        // The daemon wants a stick at rest before it gives the seat; that the commander was at rest is what the gate stands for.
        let first = self.driven_at.is_none().then_some(Twist::STOP);
        for twist in first.into_iter().chain([twist]) {
            match velocity::drive(&twist, self.top_speeds(), self.clean) {
                Ok(body) => {
                    if self.daemon.request(body).await.is_ok() {
                        self.driven_at = Some(Instant::now());
                    }
                }
                Err(unfit) => self.complain(unfit.text()),
            }
        }
    }

    /// The wheels stand by then: the lease has long ended.
    async fn let_go(&mut self) {
        if self.driven_at.is_some_and(|at| at.elapsed() >= DRIVE_SILENCE) {
            self.driven_at = None;
            // A daemon that is away holds no seat.
            self.daemon.request(RequestBody::Release).await.ok();
        }
    }

    async fn call(&mut self, call: Call) {
        tracing::info!(service = call.0.service(), "called");
        match self.daemon.request(call.0.request()).await {
            Ok(id) => {
                self.waiting.insert(id, call);
            }
            Err(_) => self.answered.push((call, away())),
        }
    }

    /// What a goal of the action needs. A daemon that is away shows in what the action sees.
    async fn wish(&mut self, wish: DockWish) {
        match wish {
            DockWish::Dock => {
                self.seen.send_modify(|view| view.refusal = None);
                self.docking = self.daemon.request(RequestBody::Dock).await.ok();
            }
            DockWish::GiveUp => {
                self.daemon.request(RequestBody::Stop).await.ok();
            }
        }
    }

    /// A robot that is driven is refused twenty times a second.
    fn complain(&mut self, text: &str) {
        let is_new = self
            .complaint
            .as_ref()
            .is_none_or(|(last, at)| last != text || at.elapsed() >= COMPLAIN_AGAIN_AFTER);
        if is_new {
            tracing::warn!("{text}");
            self.complaint = Some((text.to_owned(), Instant::now()));
        }
    }
}

/// A reader that is slow misses some; nothing is to be done about it here.
fn sent(topic: &str, is_sent: bool) {
    if !is_sent {
        tracing::debug!(topic, "a message is left out");
    }
}

fn done() -> TriggerResponse {
    TriggerResponse {
        success: true,
        message: String::new(),
    }
}

fn refused(reason: &str, text: &str) -> TriggerResponse {
    TriggerResponse {
        success: false,
        message: format!("{reason}: {text}"),
    }
}

fn away() -> TriggerResponse {
    refused("no-daemon", "the robot's daemon is away")
}

fn now() -> Time {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    Time {
        // ROS itself ends in 2038.
        sec: i32::try_from(since.as_secs()).unwrap_or(i32::MAX),
        nanosec: since.subsec_nanos(),
    }
}
