//! Edits of the stored home by clients. Each edit is admitted, made in the next step of the brain, and answered when the map with it
//! is on the disk; one that cannot be made any more by then is refused by its name.

mod no_go;
mod places;
mod rooms;

use brain::{Brain, EditError, MapEdit, Pose2, Reason};
use rvac_api::LogLevel;

use super::audience::{Asker, Asking, Teller};
use super::journal::LogSource;
use super::reply::Reply;
use crate::brain_session::BrainSession;
use crate::refusal::Refusal;
use crate::{EditedMap, FloorHome};

pub(crate) use no_go::{NoGoRequest, to_no_go};
pub(crate) use places::{PlaceRequest, to_shape, with_any_places, with_places};
pub(crate) use rooms::RoomRequest;

/// Requests of clients about the home.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum HomeRequest {
    /// No-go zones and virtual walls.
    NoGo(NoGoRequest),
    /// Kept places.
    Place(PlaceRequest),
    /// Rooms: their division, names and settings.
    Room(RoomRequest),
    /// The pose of a robot on its dock.
    MoveDock(Pose2),
}

/// An edit that the map admits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AdmittedEdit {
    pub(crate) edit: MapEdit,
    /// What the client does, for the log.
    deed: &'static str,
}

impl AdmittedEdit {
    /// The edit, if the map admits it now.
    fn new(brain: &Brain, edit: MapEdit, deed: &'static str) -> Result<Self, EditError> {
        brain.map().admit(&edit)?;
        Ok(Self { edit, deed })
    }
}

/// Clients whose edits wait for the next step of the brain.
#[derive(Debug, Default)]
pub(crate) struct HomeDesk {
    waiting: Vec<Asker>,
}

impl HomeDesk {
    /// Admits an edit for the next step of the brain. The client is answered by [`Self::keep`] or when the map is on the disk.
    ///
    /// # Errors
    /// Why the request is refused.
    pub(crate) fn serve(
        &mut self,
        Asking { asker, request }: &Asking<HomeRequest>,
        brain_session: Option<&BrainSession>,
        teller: &mut Teller<'_>,
    ) -> Result<(AdmittedEdit, Reply), Refusal> {
        let edit = match request {
            HomeRequest::NoGo(request) => request.edit(brain_session),
            HomeRequest::Place(request) => request.edit(brain_session),
            HomeRequest::Room(request) => request.edit(brain_session),
            HomeRequest::MoveDock(pose) => rooms::move_dock(*pose, brain_session),
        }?;
        let text = format!("{} {}", teller.name(asker.client), edit.deed);
        teller.log(LogLevel::Info, LogSource::Client, text);
        self.waiting.push(*asker);
        Ok((edit, Reply::AfterStep))
    }

    /// After a step of the brain: the map goes to the disk with the edits that were made, in the order of the requests. Those that the
    /// edits before them have made impossible are refused.
    pub(crate) fn keep(
        &mut self,
        made: &[Result<(), EditError>],
        home: Option<&FloorHome>,
        teller: &mut Teller<'_>,
    ) {
        let answered = self.waiting.len().min(made.len());
        for (asker, made) in self.waiting.drain(..answered).zip(made) {
            match (made, home) {
                (Ok(()), Some(home)) => teller.outputs.map_edits.push(EditedMap {
                    client: asker.client,
                    id: asker.id,
                    home: home.clone(),
                }),
                (Ok(()), None) => teller.answer(asker, Err(not_kept())),
                (Err(error), _) => teller.answer(asker, Err(Refusal::from(*error))),
            }
        }
    }

    /// The oldest `count` edits are not made: the brain has another map now.
    pub(crate) fn refuse_oldest(&mut self, count: usize, teller: &mut Teller<'_>) {
        let count = count.min(self.waiting.len());
        for asker in self.waiting.drain(..count) {
            teller.answer(asker, Err(Refusal::from("map-not-taken-up")));
        }
    }

    /// As [`Self::refuse_oldest`], all of them.
    pub(crate) fn refuse_all(&mut self, teller: &mut Teller<'_>) {
        self.refuse_oldest(self.waiting.len(), teller);
    }
}

/// The brain, if it knows the home that is stored.
pub(crate) fn known_home(brain_session: Option<&BrainSession>) -> Result<&BrainSession, Refusal> {
    let brain_session = brain_session.ok_or("no-robot")?;
    brain_session.admit_edit()?;
    Ok(brain_session)
}

/// The robot got lost in the step.
fn not_kept() -> Refusal {
    Refusal {
        reason: Reason::PlaceUnknown.name(),
        text:
            "The robot has just lost its way, so its map is not kept: try again when it stands on its dock."
                .to_owned(),
    }
}
