//! Between the daemon and the homes that follow the robot.

use std::collections::BTreeMap;
use std::path::Path;

use bridge::{Change, Daemon, Knowledge, News};
use rs_matter::dm::clusters::decl::{power_source, rvc_operational_state, rvc_run_mode, service_area};
use rs_matter::dm::{AttrChangeNotifier, EventEmitter};
use rs_matter::tlv::Nullable;
use rvac_api::{Activity, JobPart, RequestBody, Status, Topic, Trouble, Update};
use tokio::sync::oneshot;

use crate::clusters::write_fault;
use crate::node::ENDPOINT;
use crate::progress::{Moment, Progress, swept_share};
use crate::refusal::Refusal;
use crate::robot::{Ends, Order, Robot};
use crate::view::View;

const TOPICS: [Topic; 5] = [
    Topic::Status,
    Topic::Device,
    Topic::Home,
    Topic::Floors,
    Topic::Map,
];

type Answer = oneshot::Sender<Result<(), Refusal>>;

/// Follows the daemon for ever; `node` tells the homes what changed.
pub(crate) async fn run(
    socket: &Path,
    (robot, ends): (&Robot, Ends),
    node: impl AttrChangeNotifier + EventEmitter,
) {
    let mut relay = Relay {
        daemon: Daemon::new(socket.to_owned(), "rvac-matter", &TOPICS),
        known: Knowledge::default(),
        progress: Progress::default(),
        waiting: BTreeMap::new(),
        robot,
        ends,
        node,
    };
    loop {
        tokio::select! {
            news = relay.daemon.next() => relay.hear(news).await,
            Some(order) = relay.ends.orders.recv() => relay.order(order).await,
        }
    }
}

struct Relay<'a, N> {
    daemon: Daemon,
    known: Knowledge,
    progress: Progress,
    /// Who waits for the daemon's word, by the number of the request.
    waiting: BTreeMap<u32, Answer>,
    robot: &'a Robot,
    ends: Ends,
    node: N,
}

impl<N: AttrChangeNotifier + EventEmitter> Relay<'_, N> {
    async fn hear(&mut self, news: News) {
        match news {
            News::Connected => {}
            News::Lost => {
                self.known.forget_state();
                for (_, answer) in std::mem::take(&mut self.waiting) {
                    tell(answer, Err(Refusal::without_daemon()));
                }
                self.show(None);
            }
            News::Update(update) => {
                self.take(*update);
                if self.known.wants_hello() {
                    // A daemon that is away says it when it is there again.
                    self.daemon.hello().await.ok();
                }
            }
        }
    }

    fn take(&mut self, update: Update) {
        let job_before = self.known.status.as_ref().map_or(0.0, |status| status.job_s);
        let change = self.known.take(&update);
        match update {
            Update::Done { id } => {
                if let Some(answer) = self.waiting.remove(&id) {
                    tell(answer, Ok(()));
                }
            }
            Update::Failed(failure) => {
                if let Some(answer) = failure.id.and_then(|id| self.waiting.remove(&id)) {
                    self.progress.refused();
                    tell(answer, Err(failure.into()));
                }
            }
            _ => {}
        }
        if matches!(
            change,
            Change::Status | Change::Device | Change::Home | Change::Floors | Change::Robot
        ) {
            self.show(Some(job_before));
        }
    }

    async fn order(&mut self, order: Order) {
        tracing::info!(asked = ?order.body, "a home asks");
        if let Some(rooms) = self.rooms_of(&order.body) {
            self.progress.order(rooms);
        }
        match self.daemon.request(order.body).await {
            Ok(id) => {
                // Whoever waited before has given up.
                self.waiting.retain(|_, answer| !answer.is_closed());
                self.waiting.insert(id, order.answer);
            }
            Err(_) => tell(order.answer, Err(Refusal::without_daemon())),
        }
    }

    /// The rooms that a job is ordered for, if this begins one: all, when it names none.
    fn rooms_of(&self, body: &RequestBody) -> Option<Vec<u16>> {
        let all = || {
            self.ends
                .shown
                .borrow()
                .areas
                .iter()
                .map(|area| area.id)
                .collect()
        };
        match body {
            RequestBody::Start { .. } => Some(all()),
            RequestBody::Clean(job) if job.parts.is_empty() => Some(all()),
            RequestBody::Clean(job) => Some(job.parts.iter().filter_map(room_of).collect()),
            _ => None,
        }
    }

    /// What is known now. While the daemon is away nobody knows how the job goes on.
    fn view(&mut self) -> View {
        let mut now = View::of(&self.known);
        if let Some(status) = &self.known.status {
            let moment = Moment {
                cleans: now.cleans,
                here: now.here,
                job_s: whole_seconds(status.job_s),
            };
            self.progress.take(moment, |room| swept_share(&self.known, room));
        }
        if self.known.home.is_some() {
            self.progress.keep_only(|room| now.has_area(room));
        }
        now.progress = self.progress.rows().to_vec();
        now
    }

    /// Shows what is known now, and tells what of it is new.
    fn show(&mut self, job_s: Option<f64>) {
        let now = self.view();
        let before = self.ends.shown.borrow().clone();
        if now == before {
            return;
        }
        let has_home = self.known.home.is_some();
        let is_choice_changed = has_home && self.robot.choices_mut().keep_only(|room| now.has_area(room));
        self.ends.shown.send_replace(now.clone());
        for (cluster, attribute) in changed(&before, &now) {
            self.node.notify_attr_changed(ENDPOINT, cluster, attribute);
        }
        if is_choice_changed {
            let selected = service_area::AttributeId::SelectedAreas as u32;
            self.node
                .notify_attr_changed(ENDPOINT, service_area::FULL_CLUSTER.id, selected);
        }
        self.tell_events(&before, &now, job_s);
    }

    fn tell_events(&self, before: &View, now: &View, job_s: Option<f64>) {
        if let Some(fault) = now
            .fault
            .as_ref()
            .filter(|fault| before.fault.as_ref() != Some(*fault))
        {
            let told = rvc_operational_state::OperationalError::emit_for(&self.node, ENDPOINT, |event| {
                write_fault(event.error_state()?, Some(fault))?.end()
            });
            is_told(told.is_ok());
        }
        let status = self.known.status.as_ref();
        if let (true, false, Some(status), Some(job_s)) = (before.cleans, now.cleans, status, job_s)
            && Activity::from_name(&status.state) != Some(Activity::Disconnected)
        {
            let told = rvc_operational_state::OperationCompletion::emit_for(&self.node, ENDPOINT, |event| {
                event
                    .completion_error_code(ended_by(status))?
                    .total_operational_time(Some(Nullable::some(whole_seconds(job_s.max(status.job_s)))))?
                    .paused_time(None)?
                    .end()
            });
            is_told(told.is_ok());
        }
    }
}

const fn room_of(part: &JobPart) -> Option<u16> {
    match part {
        JobPart::Room(room) => Some(*room),
        _ => None,
    }
}

/// `CompletionErrorCode` of a job that ended so: 0 unless something is the matter.
fn ended_by(status: &Status) -> u8 {
    let trouble = Trouble::of_status(status).map(|(_, trouble)| trouble);
    let trouble = trouble.or_else(|| Trouble::of(&status.reason));
    trouble.map_or(0, |trouble| trouble.words().matter_error)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast of a float to an integer saturates, and no job is as long"
)]
fn whole_seconds(seconds: f64) -> u32 {
    seconds.round() as u32
}

/// Attributes that are new, with their clusters.
fn changed(before: &View, now: &View) -> Vec<(u32, u32)> {
    use {
        power_source as power, rvc_operational_state as operation, rvc_run_mode as run, service_area as area,
    };
    let mut changed = Vec::new();
    let mut when = |is_new: bool, cluster: u32, attributes: &[u32]| {
        if is_new {
            changed.extend(attributes.iter().map(|attribute| (cluster, *attribute)));
        }
    };
    when(
        before.cleans != now.cleans,
        run::FULL_CLUSTER.id,
        &[run::AttributeId::CurrentMode as u32],
    );
    let operation_id = operation::FULL_CLUSTER.id;
    when(
        before.state != now.state,
        operation_id,
        &[operation::AttributeId::OperationalState as u32],
    );
    when(
        before.fault != now.fault,
        operation_id,
        &[operation::AttributeId::OperationalError as u32],
    );
    when(
        before.battery != now.battery,
        power::FULL_CLUSTER.id,
        &[
            power::AttributeId::Status as u32,
            power::AttributeId::BatPercentRemaining as u32,
            power::AttributeId::BatChargeLevel as u32,
            power::AttributeId::BatReplacementNeeded as u32,
            power::AttributeId::BatPresent as u32,
            power::AttributeId::BatChargeState as u32,
        ],
    );
    let area_id = area::FULL_CLUSTER.id;
    when(
        before.map != now.map,
        area_id,
        &[area::AttributeId::SupportedMaps as u32],
    );
    when(
        before.areas != now.areas || before.map != now.map,
        area_id,
        &[area::AttributeId::SupportedAreas as u32],
    );
    when(
        before.here != now.here,
        area_id,
        &[area::AttributeId::CurrentArea as u32],
    );
    when(
        before.progress != now.progress,
        area_id,
        &[area::AttributeId::Progress as u32],
    );
    changed
}

/// Whoever asked may have given up meanwhile.
fn tell(answer: Answer, result: Result<(), Refusal>) {
    if answer.send(result).is_err() {
        tracing::debug!("nobody waits for the answer any more");
    }
}

/// An event for which there is no room is missed; the attributes say the same.
fn is_told(is_told: bool) {
    if !is_told {
        tracing::warn!("an event is left out");
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::Status;

    use super::{changed, ended_by};
    use crate::view::{Area, View};

    #[test]
    fn only_what_is_new_is_told() {
        let before = View::default();
        assert_eq!(changed(&before, &before), []);
        let paused = View {
            state: 2,
            ..View::default()
        };
        assert_eq!(changed(&before, &paused), [(0x61, 4)]);
        let with_rooms = View {
            areas: vec![Area {
                id: 1,
                name: "Kitchen".to_owned(),
            }],
            ..View::default()
        };
        assert_eq!(changed(&before, &with_rooms), [(0x150, 0)]);
        let cleaning = View {
            cleans: true,
            state: 1,
            here: Some(1),
            ..View::default()
        };
        assert_eq!(changed(&before, &cleaning), [(0x54, 1), (0x61, 4), (0x150, 3)]);
    }

    #[test]
    fn a_job_that_ended_well_has_no_error() {
        let ended = |state: &str, reason: &str| {
            ended_by(&Status {
                state: state.to_owned(),
                reason: reason.to_owned(),
                ..Status::default()
            })
        };
        assert_eq!(ended("idle", "finished"), 0);
        assert_eq!(ended("docking", "battery-low"), 0x48);
        assert_eq!(ended("stuck", "slip"), 0x41);
    }
}
