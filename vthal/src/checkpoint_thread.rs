//! The thread that writes checkpoints, maps, schedules, records of runs and control mixes and reads maps and mixes, so that a slow disk never delays a wheel.

use std::collections::BTreeMap;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::Instant;

use brain::{MapTrial, StoredMap};
use rvac_api::{KeptMap, RunRecord};
use tokio::sync::mpsc::Sender;
use vthal_core::{
    ArchiveOrder, ArchiveTask, Checkpoint, ClientId, EditedMap, FloorHome, FloorOrder, FloorTask,
    HealthOrder, KeptFloor, LearntOrder, MapOrder, MixOrder, MixTask, ScheduleOrder,
};

use crate::archive_desk::ArchiveDesk;
use crate::checkpoint_file::{self, BootTime};
use crate::event::Event;
use crate::floor_folder::{FloorError, FloorFolder};
use crate::health_file;
use crate::kept_store::KeptPaths;
use crate::learnt_file;
use crate::mix_folder::{MixError, MixFolder};
use crate::schedule_file;

/// What waits for the thread, at most.
const QUEUE_MAX: usize = 16;
/// Of these questions, at most: who asks without end must not keep others from changing something.
const QUESTIONS_MAX: usize = 12;

/// Something in the queue.
struct Queued {
    kept: Kept,
    /// Held until it is answered.
    place: Option<QuestionSlot>,
}

/// One of the places that questions may have.
#[derive(Debug)]
struct QuestionSlot(Arc<AtomicUsize>);

impl QuestionSlot {
    fn take(taken: &Arc<AtomicUsize>) -> Option<Self> {
        let one_more = |count| (count < QUESTIONS_MAX).then_some(count + 1);
        taken
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, one_more)
            .ok()?;
        Some(Self(Arc::clone(taken)))
    }
}

impl Drop for QuestionSlot {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Something to be kept, or asked of what is kept.
enum Kept {
    Checkpoint(Box<Checkpoint>),
    Home(Box<FloorHome>),
    Doubt(u16),
    FloorOrder(FloorOrder),
    ArchiveOrder(ArchiveOrder),
    Edit(Box<EditedMap>),
    Order(MapOrder),
    MixOrder(MixOrder),
    Schedules(Box<ScheduleOrder>),
    Health(Box<HealthOrder>),
    Learnt(Box<LearntOrder>),
    Run(Box<RunRecord>),
}

/// What came of an order for the kept control mixes.
#[derive(Debug)]
pub(crate) struct MixAnswer {
    /// Who asked.
    pub(crate) client: ClientId,
    /// Number of the request.
    pub(crate) id: Option<u32>,
    /// What came of it.
    pub(crate) outcome: Result<MixOutcome, MixError>,
}

/// See [`MixAnswer`].
#[derive(Debug)]
pub(crate) enum MixOutcome {
    /// The profiles.
    Listed(Vec<String>),
    /// One is kept, or removed; those that there are now.
    Changed(Vec<String>),
}

/// What came of an order for the kept maps.
#[derive(Debug)]
pub(crate) struct MapAnswer {
    /// Who asked.
    pub(crate) client: ClientId,
    /// Number of the request.
    pub(crate) id: Option<u32>,
    /// What came of it.
    pub(crate) outcome: MapOutcome,
}

/// See [`MapAnswer`].
#[derive(Debug)]
pub(crate) enum MapOutcome {
    /// The versions of this floor, newest first.
    Listed(u16, Vec<KeptMap>),
    /// The version of this floor with this number is the newest now.
    Restored(u16, u64, Box<StoredMap>),
    /// The map is the newest now.
    Kept,
    /// It could not be done: name and sentence.
    Refused(&'static str, String),
}

/// What came of an order for the floors.
#[derive(Debug)]
pub(crate) struct FloorAnswer {
    /// Who asked.
    pub(crate) client: ClientId,
    /// Number of the request.
    pub(crate) id: Option<u32>,
    /// What was to be done.
    pub(crate) task: FloorTask,
    /// All floors, and the number of the new one.
    pub(crate) outcome: Result<(Vec<KeptFloor>, Option<u16>), FloorError>,
}

/// Sends checkpoints, maps and orders to the thread.
#[derive(Debug)]
pub(crate) struct CheckpointHandle {
    queue: Option<SyncSender<Queued>>,
    thread: Option<JoinHandle<()>>,
    questions: Arc<AtomicUsize>,
}

/// Starts the thread. Answers to orders become events.
///
/// # Errors
/// When the system gives no thread.
pub(crate) fn start(paths: KeptPaths, events: Sender<Event>) -> io::Result<CheckpointHandle> {
    let (sender, queue) = sync_channel(QUEUE_MAX);
    let thread = std::thread::Builder::new()
        .name("checkpoint".to_owned())
        .spawn(move || serve(&paths, &queue, &events))?;
    Ok(CheckpointHandle {
        queue: Some(sender),
        thread: Some(thread),
        questions: Arc::default(),
    })
}

impl CheckpointHandle {
    /// Hands a checkpoint over. While the disk is slow some are left out: the next one says the same and more.
    pub(crate) fn send(&self, checkpoint: Checkpoint) {
        self.try_send(Kept::Checkpoint(Box::new(checkpoint)));
    }

    /// Hands a map over. If the disk is so slow that it is left out, the one after the next run says more.
    pub(crate) fn send_home(&self, home: FloorHome) {
        self.try_send(Kept::Home(Box::new(home)));
    }

    /// Says that the newest map of a floor is doubted. If the disk is so slow that it is left out, the end of the run says it again.
    pub(crate) fn send_doubt(&self, floor: u16) {
        self.try_send(Kept::Doubt(floor));
    }

    /// Hands a changed map over, in place of older ones that wait; `false` when the disk is too slow to take it now.
    #[must_use]
    pub(crate) fn edit(&self, edit: EditedMap) -> bool {
        self.try_send(Kept::Edit(Box::new(edit)))
    }

    /// Hands an order over; `false` when the disk is too slow to take it now.
    #[must_use]
    pub(crate) fn order(&self, order: MapOrder) -> bool {
        match order {
            MapOrder::List { .. } => self.try_ask(Kept::Order(order)),
            MapOrder::Restore { .. } => self.try_send(Kept::Order(order)),
        }
    }

    /// Hands an order for the floors over; `false` when the disk is too slow to take it now.
    #[must_use]
    pub(crate) fn order_floor(&self, order: FloorOrder) -> bool {
        self.try_send(Kept::FloorOrder(order))
    }

    /// Hands an order for an archive of floors over; `false` when the disk is too slow to take it now.
    #[must_use]
    pub(crate) fn order_archive(&self, order: ArchiveOrder) -> bool {
        match order.task {
            ArchiveTask::Export { .. } => self.try_ask(Kept::ArchiveOrder(order)),
            ArchiveTask::Import { .. } => self.try_send(Kept::ArchiveOrder(order)),
        }
    }

    /// Hands an order for the control mixes over; `false` when the disk is too slow to take it now.
    #[must_use]
    pub(crate) fn order_mix(&self, order: MixOrder) -> bool {
        match order.task {
            MixTask::List => self.try_ask(Kept::MixOrder(order)),
            MixTask::Save { .. } | MixTask::Remove(_) => self.try_send(Kept::MixOrder(order)),
        }
    }

    /// Hands schedules over; `false` when the disk is too slow to take them now.
    #[must_use]
    pub(crate) fn keep_schedules(&self, order: ScheduleOrder) -> bool {
        self.try_send(Kept::Schedules(Box::new(order)))
    }

    /// Hands loads of motors over; `false` when the disk is too slow to take them now.
    #[must_use]
    pub(crate) fn keep_health(&self, order: HealthOrder) -> bool {
        self.try_send(Kept::Health(Box::new(order)))
    }

    /// Hands over what robots have learnt; `false` when the disk is too slow to take it now.
    #[must_use]
    pub(crate) fn keep_learnt(&self, order: LearntOrder) -> bool {
        self.try_send(Kept::Learnt(Box::new(order)))
    }

    /// Hands the record of a run over; `false` when the disk is too slow to take it now.
    #[must_use]
    pub(crate) fn keep_run(&self, record: Box<RunRecord>) -> bool {
        self.try_send(Kept::Run(record))
    }

    fn try_ask(&self, kept: Kept) -> bool {
        let place = QuestionSlot::take(&self.questions);
        place.is_some() && self.queue_up(Queued { kept, place })
    }

    fn try_send(&self, kept: Kept) -> bool {
        self.queue_up(Queued { kept, place: None })
    }

    fn queue_up(&self, queued: Queued) -> bool {
        self.queue
            .as_ref()
            .is_some_and(|queue| queue.try_send(queued).is_ok())
    }

    /// Waits until the newest ones are on disk. Nobody must wait for answers any more: the receiver of events is gone.
    pub(crate) fn finish(mut self) {
        self.queue = None;
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the writer of checkpoints has failed");
        }
    }
}

/// Sends it to the daemon's loop. There is no receiver when the daemon ends.
fn answer(event: Event, events: &Sender<Event>) {
    events.blocking_send(event).ok();
}

fn serve(paths: &KeptPaths, queue: &Receiver<Queued>, events: &Sender<Event>) {
    let mut healthy = true;
    let mut desk = ArchiveDesk::default();
    while let Ok(first) = queue.recv() {
        let (mut checkpoint, mut orders, mut runs) = (None, Vec::new(), Vec::new());
        // The newest one of each floor.
        let mut homes: BTreeMap<u16, NewestHome> = BTreeMap::new();
        // Whoever waits until the home is kept.
        let (mut waiting, mut floor_orders) = (Vec::new(), Vec::new());
        let mut archive_orders = Vec::new();
        let mut places = Vec::new();
        // What comes faster than it is carried out must not keep the rest from the disk.
        for queued in core::iter::once(first).chain(queue.try_iter().take(QUEUE_MAX)) {
            places.extend(queued.place);
            match queued.kept {
                Kept::Checkpoint(newer) => checkpoint = Some(newer),
                Kept::Home(newer) => take_newer(&mut homes, *newer),
                // Before a map that comes later is the newest.
                Kept::Doubt(floor) => note_doubt(floor, &paths.floors),
                Kept::Edit(edit) => {
                    take_newer(&mut homes, edit.home);
                    waiting.push((edit.client, edit.id));
                }
                Kept::FloorOrder(order) => floor_orders.push(order),
                Kept::ArchiveOrder(order) => archive_orders.push(order),
                Kept::Order(order) => orders.push(order),
                Kept::Run(record) => runs.push(record),
                // Small, and never in a queue behind a map that waits to be written.
                Kept::MixOrder(order) => answer(Event::Mixes(obey_mix(order, &paths.mixes)), events),
                Kept::Schedules(order) => answer(keep_schedules(&order, paths), events),
                Kept::Health(order) => answer(keep_health(&order, paths), events),
                Kept::Learnt(order) => answer(keep_learnt(&order, paths), events),
            }
        }
        if let Some(checkpoint) = checkpoint {
            healthy = keep_checkpoint(&checkpoint, healthy, paths);
        }
        let kept = keep(&homes, &paths.floors);
        for record in runs {
            let (number, result) = (record.run.number, paths.keep_run(*record));
            answer(Event::RunKept(number, result), events);
        }
        for (client, id) in waiting {
            let outcome = match &kept {
                Ok(()) => MapOutcome::Kept,
                Err(error) => MapOutcome::Refused("map-unwritable", unkept(error)),
            };
            answer(Event::Maps(MapAnswer { client, id, outcome }), events);
        }
        for order in orders {
            answer(Event::Maps(obey(order, &paths.floors)), events);
        }
        for order in floor_orders {
            answer(Event::Floors(Box::new(obey_floor(order, &paths.floors))), events);
        }
        for order in archive_orders {
            let archive = desk.obey(order, &paths.floors, Instant::now());
            answer(Event::Archive(Box::new(archive)), events);
        }
        drop(places);
    }
}

/// Whether that worked. A fault is logged once, until it has worked again.
fn keep_checkpoint(checkpoint: &Checkpoint, healthy: bool, paths: &KeptPaths) -> bool {
    let result = BootTime::now().and_then(|now| checkpoint_file::save(&paths.checkpoint, checkpoint, now));
    if let Err(error) = &result
        && healthy
    {
        tracing::error!(
            "cannot write the checkpoint {}: {error}; a crash would end the job",
            paths.checkpoint.display()
        );
    }
    result.is_ok()
}

/// The newest map of a floor that waits for the disk, and what the run that left it, or one before it, has shown of the map before.
struct NewestHome {
    home: StoredMap,
    trial: Option<MapTrial>,
}

fn take_newer(homes: &mut BTreeMap<u16, NewestHome>, newer: FloorHome) {
    let FloorHome { floor, home, trial } = newer;
    let trial = trial.or(homes.get(&floor).and_then(|older| older.trial));
    homes.insert(floor, NewestHome { home, trial });
}

fn note_doubt(floor: u16, floors: &FloorFolder) {
    let maps = floors.maps(floor);
    if let Err(error) = maps.note_doubt() {
        tracing::warn!(
            "cannot write in {} that its newest map is doubted: {error}",
            maps.path().display()
        );
    }
}

/// Writes the maps; the last thing that went wrong, if anything did.
fn keep(homes: &BTreeMap<u16, NewestHome>, floors: &FloorFolder) -> io::Result<()> {
    let mut kept = Ok(());
    for (floor, NewestHome { home, trial }) in homes {
        let maps = floors.maps(*floor);
        if let Err(error) = maps.save_after(home, *trial) {
            tracing::error!(
                "cannot write a map in {}: {error}; the robot will have to make it again",
                maps.path().display()
            );
            kept = Err(error);
        }
    }
    kept
}

fn obey_floor(FloorOrder { client, id, task }: FloorOrder, floors: &FloorFolder) -> FloorAnswer {
    let outcome = floors.change(&task).map(|made| (floors.load().0, made));
    FloorAnswer {
        client,
        id,
        task,
        outcome,
    }
}

/// Sentence for whoever changed a map that cannot be written.
fn unkept(error: &io::Error) -> String {
    format!(
        "The robot knows it now, but the map cannot be written: {error}. Check the disk and the state folder; after a \
         restart it would be forgotten."
    )
}

fn keep_schedules(order: &ScheduleOrder, paths: &KeptPaths) -> Event {
    let result = schedule_file::save(&paths.schedules, &order.book);
    Event::Schedules(order.number, result.map_err(|error| unkept_schedules(&error)))
}

fn keep_health(order: &HealthOrder, paths: &KeptPaths) -> Event {
    let result = health_file::save(&paths.health, &order.health);
    Event::Health(order.number, result.map_err(|error| unkept_health(&error)))
}

fn keep_learnt(order: &LearntOrder, paths: &KeptPaths) -> Event {
    let result = learnt_file::save(&paths.learnt, &order.learnt);
    Event::Learnt(order.number, result.map_err(|error| unkept_learnt(&error)))
}

fn unkept_learnt(error: &io::Error) -> String {
    format!(
        "What the robot has learnt cannot be written: {error}. Check the disk and the state folder; it is as it was before."
    )
}

fn unkept_health(error: &io::Error) -> String {
    format!(
        "The loads of the motors cannot be written: {error}. Check the disk and the state folder; they are as they were before."
    )
}

fn unkept_schedules(error: &io::Error) -> String {
    format!(
        "The schedules cannot be written: {error}. Check the disk and the state folder; they are as they were before."
    )
}

fn obey(order: MapOrder, floors: &FloorFolder) -> MapAnswer {
    match order {
        MapOrder::List { client, id, floor } => MapAnswer {
            client,
            id,
            outcome: MapOutcome::Listed(floor, floors.maps(floor).list()),
        },
        MapOrder::Restore {
            client,
            id,
            floor,
            number,
        } => MapAnswer {
            client,
            id,
            outcome: match floors.maps(floor).restore(number) {
                Ok(home) => MapOutcome::Restored(floor, number, Box::new(home)),
                Err(error) => MapOutcome::Refused(error.name(), error.to_string()),
            },
        },
    }
}

fn obey_mix(MixOrder { client, id, task }: MixOrder, mixes: &MixFolder) -> MixAnswer {
    let outcome = match task {
        MixTask::List => Ok(MixOutcome::Listed(mixes.list())),
        MixTask::Save { profile, was } => mixes
            .save(&profile, was.as_deref())
            .map(|()| MixOutcome::Changed(mixes.list())),
        MixTask::Remove(name) => mixes.remove(&name).map(|()| MixOutcome::Changed(mixes.list())),
    };
    MixAnswer { client, id, outcome }
}

#[cfg(test)]
mod tests;
