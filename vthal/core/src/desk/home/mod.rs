//! Edits of the stored home by clients. Each edit is admitted, applied in the next step of the brain, and answered when the map with
//! it is on the disk.

mod no_go;
mod places;
mod rooms;

use brain::{Brain, EditError, MapEdit, Pose2, Reason};
use rvac_api::{Failure, LogLevel, Update};

use super::audience::{Asker, Asking, Teller};
use super::journal::LogSource;
use super::reply::Reply;
use crate::brain_session::BrainSession;
use crate::outputs::{Delivery, Recipients};
use crate::refusal::Refusal;
use crate::{EditedMap, FloorHome, Outputs};

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
    /// Whether a client waits for an edit.
    pub(crate) fn is_waited_for(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Admits an edit for the next step of the brain. The client is answered when the map is on the disk.
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

    /// After the step that applied the edits: the map goes to the disk with all of them.
    pub(crate) fn keep(&mut self, home: Option<&FloorHome>, outputs: &mut Outputs) {
        for Asker { client, id } in self.waiting.drain(..) {
            match home {
                Some(home) => outputs.map_edits.push(EditedMap {
                    client,
                    id,
                    home: home.clone(),
                }),
                None => outputs.deliveries.push(Delivery {
                    to: Recipients::One(client),
                    update: not_kept(id),
                }),
            }
        }
    }
}

/// The brain, if it knows the home that is stored.
pub(crate) fn known_home(brain_session: Option<&BrainSession>) -> Result<&BrainSession, Refusal> {
    let brain_session = brain_session.ok_or("no-robot")?;
    brain_session.admit_edit()?;
    Ok(brain_session)
}

/// The robot got lost in the step.
fn not_kept(id: Option<u32>) -> Update {
    Update::Failed(Failure {
        id,
        reason: Reason::PlaceUnknown.name().to_owned(),
        text:
            "The robot has just lost its way, so its map is not kept: try again when it stands on its dock."
                .to_owned(),
    })
}
