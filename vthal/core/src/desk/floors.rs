//! Requests of clients about floors, and what clients receive of them.

use brain::{RoomName, StoredMap};
use rvac_api::{FloorQuestion, FloorsView, LogLevel};

use super::audience::{Asker, Asking, Teller};
use super::journal::LogSource;
use super::reply::Reply;
use super::words::to_name;
use crate::brain_session::{BrainSession, FloorNews};
use crate::floors::{Floors, KeptFloor};
use crate::refusal::{self, Refusal};
use crate::{ArchiveOrder, ArchiveTask, FloorHome, FloorOrder, FloorTask, MapOrder};

/// What clients ask of floors and their maps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FloorRequest {
    /// Which versions of the map of a floor are kept.
    Maps { floor: Option<u16> },
    /// A version shall be the newest again.
    RestoreMap { floor: Option<u16>, number: u64 },
    /// The robot is on this floor.
    Choose { floor: u16 },
    /// The robot is on a floor of which nothing is kept.
    New { name: Option<String> },
    /// Names a floor, or takes its name away.
    Name { floor: u16, name: Option<String> },
    /// Removes a floor.
    Remove { floor: u16 },
    /// Brings a removed floor back.
    Restore { floor: u16 },
    /// Archives of floors are given or taken.
    Archive(ArchiveTask),
}

/// What the shell has done with the floors.
pub(crate) struct KeptFloors<'a> {
    pub(crate) task: &'a FloorTask,
    pub(crate) floors: Vec<KeptFloor>,
    /// The new floor, if there is one.
    pub(crate) made: Option<u16>,
}

/// A version of the map of a floor that is the newest again.
pub(crate) struct RestoredMap {
    /// Number of the version, for the log.
    pub(crate) number: u64,
    pub(crate) kept: FloorHome,
}

impl RestoredMap {
    /// No run has left it.
    pub(crate) const fn new(number: u64, floor: u16, home: StoredMap) -> Self {
        let kept = FloorHome {
            floor,
            home,
            trial: None,
        };
        Self { number, kept }
    }
}

/// The floors of the home.
#[derive(Debug)]
pub(crate) struct FloorDesk {
    floors: Floors,
}

impl FloorDesk {
    pub(crate) fn new(floors: Vec<KeptFloor>) -> Self {
        Self {
            floors: Floors::new(floors),
        }
    }

    /// The floors that are kept.
    pub(crate) fn floors(&self) -> &Floors {
        &self.floors
    }

    /// The floors, and on which of them the robot is.
    pub(crate) fn view(&self, brain_session: Option<&BrainSession>) -> FloorsView {
        FloorsView {
            floors: self.floors.views().to_vec(),
            here: brain_session.and_then(BrainSession::floor),
            sought: brain_session.is_some_and(BrainSession::seeks_floor),
            question: brain_session.and_then(question),
        }
    }

    /// Whether [`Self::view`] differs from what clients have received.
    pub(crate) fn is_news(&self, sent: Option<&FloorsView>, brain_session: Option<&BrainSession>) -> bool {
        sent.is_none_or(|sent| {
            sent.here != brain_session.and_then(BrainSession::floor)
                || sent.sought != brain_session.is_some_and(BrainSession::seeks_floor)
                || sent.question.as_ref().map(|question| question.reason.as_str())
                    != brain_session
                        .and_then(BrainSession::asked)
                        .map(|asked| asked.name())
                || sent.floors != self.floors.views()
        })
    }

    /// The floor of this number.
    ///
    /// # Errors
    /// There is none.
    pub(crate) fn named(&self, number: u16) -> Result<&KeptFloor, Refusal> {
        self.floors
            .get(number)
            .ok_or_else(|| no_such_floor(number, &self.floors))
    }

    /// The floor that a request names, else the one on which the robot is, else the first one.
    fn meant(&self, named: Option<u16>, brain_session: Option<&BrainSession>) -> Result<u16, Refusal> {
        match named {
            Some(number) => self.named(number).map(|floor| floor.number),
            None => Ok(brain_session
                .and_then(BrainSession::floor)
                .unwrap_or_else(|| self.floors.first())),
        }
    }

    fn title(&self, number: u16) -> String {
        let floor = self.floors.get(number);
        floor.map_or_else(|| format!("floor {number}"), KeptFloor::title)
    }

    /// # Errors
    /// Why the request is refused.
    pub(crate) fn serve(
        &self,
        Asking { asker, request }: Asking<FloorRequest>,
        brain_session: Option<&mut BrainSession>,
        teller: &mut Teller<'_>,
    ) -> Result<Reply, Refusal> {
        let Asker { client, id } = asker;
        let outputs = &mut *teller.outputs;
        match request {
            FloorRequest::Choose { floor } => return self.choose(floor, brain_session, teller),
            FloorRequest::Maps { floor } => {
                let floor = self.meant(floor, brain_session.as_deref())?;
                outputs.map_orders.push(MapOrder::List { client, id, floor });
            }
            FloorRequest::RestoreMap { floor, number } => {
                admit_other_map(brain_session.as_deref())?;
                let floor = self.meant(floor, brain_session.as_deref())?;
                outputs.map_orders.push(MapOrder::Restore {
                    client,
                    id,
                    floor,
                    number,
                });
            }
            FloorRequest::New { name } => {
                let task = self.new_floor(name, brain_session.as_deref())?;
                outputs.floor_orders.push(FloorOrder { client, id, task });
            }
            FloorRequest::Name { floor, name } => {
                self.named(floor)?;
                let task = FloorTask::Name(floor, self.free_name(name, Some(floor))?);
                outputs.floor_orders.push(FloorOrder { client, id, task });
            }
            FloorRequest::Remove { floor } => {
                let task = self.remove(floor, brain_session.as_deref())?;
                outputs.floor_orders.push(FloorOrder { client, id, task });
            }
            FloorRequest::Restore { floor } if self.floors.is_removed(floor) => {
                let task = FloorTask::Restore(floor);
                outputs.floor_orders.push(FloorOrder { client, id, task });
            }
            FloorRequest::Restore { .. } => return Err(Refusal::from("not-removed")),
            FloorRequest::Archive(task) => {
                if let ArchiveTask::Export {
                    floor: Some(number), ..
                } = task
                {
                    self.named(number)?;
                }
                outputs.archive_orders.push(ArchiveOrder { client, id, task });
            }
        }
        Ok(Reply::ByShell)
    }

    fn new_floor(
        &self,
        name: Option<String>,
        brain_session: Option<&BrainSession>,
    ) -> Result<FloorTask, Refusal> {
        if brain_session.and_then(BrainSession::floor).is_some() && !brain_session.is_some_and(is_lost) {
            admit_other_map(brain_session)?;
        }
        Ok(FloorTask::New(self.free_name(name, None)?))
    }

    fn remove(&self, floor: u16, brain_session: Option<&BrainSession>) -> Result<FloorTask, Refusal> {
        self.named(floor)?;
        if brain_session.and_then(BrainSession::floor) == Some(floor) {
            admit_other_map(brain_session)?;
        }
        if self.floors.present().nth(1).is_none() {
            return Err(Refusal::from("last-floor"));
        }
        Ok(FloorTask::Remove(floor))
    }

    fn free_name(&self, name: Option<String>, of: Option<u16>) -> Result<Option<RoomName>, Refusal> {
        let name = name.as_deref().map(to_name).transpose()?;
        let is_taken = self
            .floors
            .present()
            .any(|floor| name.is_some() && floor.name == name && Some(floor.number) != of);
        if is_taken {
            let text = "Another floor is called so: take another name.".to_owned();
            return Err(Refusal::because(brain::EditError::NameTaken, text));
        }
        Ok(name)
    }

    fn choose(
        &self,
        number: u16,
        brain_session: Option<&mut BrainSession>,
        teller: &mut Teller<'_>,
    ) -> Result<Reply, Refusal> {
        let is_mapped = self.named(number)?.home.is_some();
        let here = brain_session.as_deref().and_then(BrainSession::floor);
        if here == Some(number) && !brain_session.as_deref().is_some_and(is_lost) {
            return Ok(Reply::Done);
        }
        if here.is_some() {
            admit_other_map(brain_session.as_deref())?;
        }
        let Some(brain_session) = brain_session else {
            return Err(Refusal::from("no-robot"));
        };
        if is_mapped {
            brain_session.choose_floor(teller.now_us, number, &mut teller.recorder());
        } else {
            brain_session.begin_floor(teller.now_us, number, &mut teller.recorder());
        }
        teller.follow_run(brain_session);
        let text = format!("a person says that the robot is on {}", self.title(number));
        teller.log(LogLevel::Info, LogSource::Client, text);
        Ok(Reply::Done)
    }

    /// The shell has carried out a client's order about floors.
    pub(crate) fn kept(
        &mut self,
        KeptFloors { task, floors, made }: KeptFloors<'_>,
        brain_session: Option<&mut BrainSession>,
        teller: &mut Teller<'_>,
    ) {
        self.floors.renew(floors);
        let now_us = teller.now_us;
        let text = match (task, made) {
            (FloorTask::New(_), Some(number)) => {
                if let Some(brain_session) = brain_session {
                    brain_session.begin_floor(now_us, number, &mut teller.recorder());
                    teller.follow_run(brain_session);
                }
                format!("{} begins, and the robot is on it", self.title(number))
            }
            (FloorTask::Remove(number), _) => {
                if let Some(brain_session) = brain_session {
                    brain_session.lose_floor(now_us, *number, &mut teller.recorder());
                    teller.follow_run(brain_session);
                }
                format!("floor {number} is removed; it can be restored")
            }
            (FloorTask::Restore(number), _) => format!("{} is back", self.title(*number)),
            (FloorTask::Name(number, _), _) => format!("floor {number} is called {}", self.title(*number)),
            (FloorTask::New(_), None) => return,
        };
        teller.log(LogLevel::Info, LogSource::Vthal, text);
    }

    /// Floors of an archive are on the disk.
    pub(crate) fn taken_in(&mut self, floors: Vec<KeptFloor>, taken: &[u16], teller: &mut Teller<'_>) {
        self.floors.renew(floors);
        let titles: Vec<String> = taken.iter().map(|number| self.title(*number)).collect();
        let text = format!("taken in from an archive: {}", titles.join(", "));
        teller.log(LogLevel::Info, LogSource::Vthal, text);
    }

    /// A version of the map of a floor is the newest one again.
    pub(crate) fn map_restored(
        &mut self,
        RestoredMap { number, kept }: &RestoredMap,
        brain_session: Option<&mut BrainSession>,
        teller: &mut Teller<'_>,
    ) {
        self.note_kept(kept);
        if let Some(brain_session) = brain_session {
            brain_session.offer(teller.now_us, kept.floor, &mut teller.recorder());
            teller.follow_run(brain_session);
        }
        let text = format!(
            "map {number} of {} is restored; the robot takes it up when it stands on its dock",
            self.title(kept.floor)
        );
        teller.log(LogLevel::Info, LogSource::Vthal, text);
    }

    /// What goes to the disk is what the floor's map is from now on.
    pub(crate) fn note_kept(&mut self, kept: &FloorHome) {
        self.floors.take_home(kept.floor, &kept.home);
    }

    /// Tells what has become known of the robot's floor.
    pub(crate) fn announce(&self, news: FloorNews, teller: &mut Teller<'_>) {
        let (level, text) = match news {
            FloorNews::Docked(number) => {
                let title = self.title(number);
                let text = format!("takes up the map of the home that was kept: {title}");
                (LogLevel::Info, text)
            }
            FloorNews::Found(number) => {
                let title = self.title(number);
                let text = format!("knows by its way that it is on {title}, and goes on there");
                (LogLevel::Info, text)
            }
            FloorNews::Asked(question) => (LogLevel::Warn, refusal::text(question.name())),
        };
        teller.log(level, LogSource::Brain, text);
    }
}

/// What a job rests on must not change under it.
fn admit_other_map(brain_session: Option<&BrainSession>) -> Result<(), Refusal> {
    match brain_session {
        Some(brain_session) if !brain_session.rests() => Err(Refusal::from("job-runs")),
        _ => Ok(()),
    }
}

fn is_lost(brain_session: &BrainSession) -> bool {
    brain_session.brain().estimate().lost
}

fn question(brain_session: &BrainSession) -> Option<FloorQuestion> {
    let reason = brain_session.asked()?.name();
    Some(FloorQuestion {
        reason: reason.to_owned(),
        text: refusal::text(reason),
    })
}

fn no_such_floor(number: u16, floors: &Floors) -> Refusal {
    let known: Vec<String> = floors
        .present()
        .map(|floor| match &floor.name {
            Some(name) => format!("{} ({})", floor.number, name.as_str()),
            None => floor.number.to_string(),
        })
        .collect();
    Refusal {
        reason: "no-such-floor",
        text: format!("There is no floor {number}: there are {}.", known.join(", ")),
    }
}
