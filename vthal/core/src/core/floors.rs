//! What clients say of floors, and what they are told.

use brain::{RoomName, StoredMap};
use rvac_api::{FloorQuestion, FloorsView, LogLevel, RequestBody};

use super::orders::to_name;
use super::refusal::Refusal;
use super::{Core, recorder, refusal};
use crate::floors::{Floors, KeptFloor};
use crate::journal::Part;
use crate::mind::{FloorNews, Mind};
use crate::{ArchiveOrder, ArchiveTask, ClientId, FloorOrder, FloorTask, MapOrder, Outputs};

/// Who asks, and the number of the request.
type Asker = (ClientId, Option<u32>);

impl Core {
    /// The floors, and on which of them the robot is.
    #[must_use]
    pub fn floors_view(&self) -> FloorsView {
        FloorsView {
            floors: self.floors.views().to_vec(),
            here: self.floor(),
            sought: self.mind.as_ref().is_some_and(Mind::seeks_floor),
            question: self.question(),
        }
    }

    pub(super) fn is_new_of_floors(&self, told: Option<&FloorsView>) -> bool {
        told.is_none_or(|told| {
            told.here != self.floor()
                || told.sought != self.mind.as_ref().is_some_and(Mind::seeks_floor)
                || told.question.as_ref().map(|question| question.reason.as_str())
                    != self.mind.as_ref().and_then(Mind::asked).map(|asked| asked.name())
                || told.floors != self.floors.views()
        })
    }

    pub(super) fn floor(&self) -> Option<u16> {
        self.mind.as_ref().and_then(Mind::floor)
    }

    fn question(&self) -> Option<FloorQuestion> {
        let reason = self.mind.as_ref()?.asked()?.name();
        Some(FloorQuestion {
            reason: reason.to_owned(),
            text: refusal::text(reason),
        })
    }

    /// The floor that a request names, else the one on which the robot is, else the first one.
    fn floor_meant(&self, named: Option<u16>) -> Result<u16, Refusal> {
        match named {
            Some(number) => self.floor_named(number).map(|floor| floor.number),
            None => Ok(self.floor().unwrap_or_else(|| self.floors.first())),
        }
    }

    pub(super) fn floor_named(&self, number: u16) -> Result<&KeptFloor, Refusal> {
        self.floors
            .get(number)
            .ok_or_else(|| no_such_floor(number, &self.floors))
    }

    /// What a job rests on must not change under it.
    fn admit_other_map(&self) -> Result<(), Refusal> {
        match &self.mind {
            Some(mind) if !mind.rests() => Err(Refusal::from("job-runs")),
            _ => Ok(()),
        }
    }

    /// What a client asks of floors and their maps.
    pub(super) fn ask_floors(
        &mut self,
        now_us: u64,
        (asker, body): (Asker, RequestBody),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        match body {
            RequestBody::Maps { floor } => self.list_maps(asker, floor, outputs),
            RequestBody::RestoreMap { number, floor } => self.restore_map(asker, (floor, number), outputs),
            RequestBody::ChooseFloor { floor } => self.choose_floor(now_us, floor, outputs),
            RequestBody::ExportFloors { floor, from } => self.export_floors(asker, (floor, from), outputs),
            RequestBody::ImportFloors { from, size, data } => {
                let task = ArchiveTask::Import { from, size, data };
                order_archive(asker, task, outputs);
                Ok(())
            }
            body => self.change_floors((asker, body), outputs),
        }
    }

    fn list_maps(
        &self,
        (client, id): Asker,
        floor: Option<u16>,
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let floor = self.floor_meant(floor)?;
        outputs.map_orders.push(MapOrder::List { client, id, floor });
        Ok(())
    }

    fn export_floors(
        &self,
        asker: Asker,
        (floor, from): (Option<u16>, u64),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        if let Some(number) = floor {
            self.floor_named(number)?;
        }
        order_archive(asker, ArchiveTask::Export { floor, from }, outputs);
        Ok(())
    }

    /// The shell does it, and answers the client.
    fn change_floors(
        &self,
        ((client, id), body): (Asker, RequestBody),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let task = match body {
            RequestBody::NewFloor { name } => {
                if self.floor().is_some() && !self.is_lost() {
                    self.admit_other_map()?;
                }
                FloorTask::New(self.free_name(name, None)?)
            }
            RequestBody::NameFloor { floor, name } => {
                self.floor_named(floor)?;
                FloorTask::Name(floor, self.free_name(name, Some(floor))?)
            }
            RequestBody::RemoveFloor { floor } => {
                self.floor_named(floor)?;
                if self.floor() == Some(floor) {
                    self.admit_other_map()?;
                }
                if self.floors.present().nth(1).is_none() {
                    return Err(Refusal::from("last-floor"));
                }
                FloorTask::Remove(floor)
            }
            RequestBody::RestoreFloor { floor } if self.floors.is_removed(floor) => FloorTask::Restore(floor),
            RequestBody::RestoreFloor { .. } => return Err(Refusal::from("not-removed")),
            _ => return Ok(()),
        };
        outputs.floor_orders.push(FloorOrder { client, id, task });
        Ok(())
    }

    fn is_lost(&self) -> bool {
        let brain = self.mind.as_ref().map(Mind::brain);
        brain.is_some_and(|brain| brain.estimate().lost)
    }

    fn free_name(&self, name: Option<String>, of: Option<u16>) -> Result<Option<RoomName>, Refusal> {
        let name = name.as_deref().map(to_name).transpose()?;
        let is_taken = self
            .floors
            .present()
            .any(|floor| name.is_some() && floor.name == name && Some(floor.number) != of);
        if is_taken {
            let text = "Another floor is called so: take another name.".to_owned();
            return Err(Refusal::because(brain::Reason::NameTaken, text));
        }
        Ok(name)
    }

    fn choose_floor(&mut self, now_us: u64, number: u16, outputs: &mut Outputs) -> Result<(), Refusal> {
        let is_mapped = self.floor_named(number)?.home.is_some();
        if self.floor() == Some(number) && !self.is_lost() {
            return Ok(());
        }
        if self.floor().is_some() {
            self.admit_other_map()?;
        }
        let recording = self.config.recording;
        let Some(mind) = &mut self.mind else {
            return Err(Refusal::from("no-robot"));
        };
        let recorder = &mut recorder(recording, outputs);
        if is_mapped {
            mind.choose_floor(now_us, number, recorder);
        } else {
            mind.begin_floor(now_us, number, recorder);
        }
        let text = format!("a person says that the robot is on {}", self.title(number));
        self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
        Ok(())
    }

    fn title(&self, number: u16) -> String {
        let floor = self.floors.get(number);
        floor.map_or_else(|| format!("floor {number}"), KeptFloor::title)
    }

    /// The shell has carried out what a client wanted of the floors.
    pub(super) fn floors_kept(
        &mut self,
        now_us: u64,
        (task, floors, made): (&FloorTask, Vec<KeptFloor>, Option<u16>),
        outputs: &mut Outputs,
    ) {
        self.floors.renew(floors);
        let recording = self.config.recording;
        let text = match (task, made) {
            (FloorTask::New(_), Some(number)) => {
                if let Some(mind) = &mut self.mind {
                    mind.begin_floor(now_us, number, &mut recorder(recording, outputs));
                }
                format!("{} begins, and the robot is on it", self.title(number))
            }
            (FloorTask::Remove(number), _) => {
                if let Some(mind) = &mut self.mind {
                    mind.lose_floor(now_us, *number, &mut recorder(recording, outputs));
                }
                format!("floor {number} is removed; it can be restored")
            }
            (FloorTask::Restore(number), _) => format!("{} is back", self.title(*number)),
            (FloorTask::Name(number, _), _) => format!("floor {number} is called {}", self.title(*number)),
            (FloorTask::New(_), None) => return,
        };
        self.log(now_us, (LogLevel::Info, Part::Vthal, text), outputs);
    }

    /// Floors of an archive are on the disk.
    pub(super) fn floors_taken_in(
        &mut self,
        now_us: u64,
        (floors, taken): (Vec<KeptFloor>, &[u16]),
        outputs: &mut Outputs,
    ) {
        self.floors.renew(floors);
        let titles: Vec<String> = taken.iter().map(|number| self.title(*number)).collect();
        let text = format!("taken in from an archive: {}", titles.join(", "));
        self.log(now_us, (LogLevel::Info, Part::Vthal, text), outputs);
    }

    fn restore_map(
        &self,
        (client, id): Asker,
        (floor, number): (Option<u16>, u64),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        self.admit_other_map()?;
        let floor = self.floor_meant(floor)?;
        outputs.map_orders.push(MapOrder::Restore {
            client,
            id,
            floor,
            number,
        });
        Ok(())
    }

    pub(super) fn map_restored(
        &mut self,
        now_us: u64,
        (floor, number, home): (u16, u64, StoredMap),
        outputs: &mut Outputs,
    ) {
        let recording = self.config.recording;
        self.floors.take_home(floor, &home);
        if let Some(mind) = &mut self.mind {
            mind.offer(now_us, floor, &mut recorder(recording, outputs));
        }
        let text = format!(
            "map {number} of {} is restored; the robot takes it up when it stands on its dock",
            self.title(floor)
        );
        self.log(now_us, (LogLevel::Info, Part::Vthal, text), outputs);
    }

    /// What goes to the disk is what the floor's map is from now on.
    pub(super) fn note_kept_home(&mut self, outputs: &Outputs) {
        if let Some(kept) = &outputs.home {
            self.floors.take_home(kept.floor, &kept.home);
        }
    }

    pub(super) fn log_floor(&mut self, now_us: u64, news: FloorNews, outputs: &mut Outputs) {
        if !matches!(news, FloorNews::Asked(_)) {
            self.feed.tell_home_now();
        }
        let line = match news {
            FloorNews::Docked(number) => {
                let text = format!(
                    "takes up the map of the home that was kept: {}",
                    self.title(number)
                );
                (LogLevel::Info, Part::Brain, text)
            }
            FloorNews::Found(number) => {
                let text = format!(
                    "knows by its way that it is on {}, and goes on there",
                    self.title(number)
                );
                (LogLevel::Info, Part::Brain, text)
            }
            FloorNews::Asked(question) => {
                let text = refusal::text(question.name());
                (LogLevel::Warn, Part::Brain, text)
            }
        };
        self.log(now_us, line, outputs);
    }
}

/// The shell does it, and answers the client.
fn order_archive((client, id): Asker, task: ArchiveTask, outputs: &mut Outputs) {
    outputs.archive_orders.push(ArchiveOrder { client, id, task });
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
