//! Edits of the stored home by clients. Each edit is admitted, applied in the next step of the brain, and answered when the map with
//! it is on the disk.

mod no_go;
mod places;
mod rooms;

use brain::{Brain, EditError, MapEdit, Pose2, Reason};
use rvac_api::{Failure, LogLevel, Update};

use super::audience::{Asker, Asking, Teller};
use super::journal::Part;
use super::reply::Reply;
use crate::mind::Mind;
use crate::outputs::{Delivery, Recipients};
use crate::refusal::Refusal;
use crate::{EditedMap, FloorHome, Outputs};

pub(crate) use no_go::{NoGoRequest, to_no_go};
pub(crate) use places::{PlaceRequest, to_shape, with_any_places, with_places};
pub(crate) use rooms::RoomRequest;

/// What clients say of the home.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum HomeRequest {
    /// Floor is forbidden, or allowed again.
    NoGo(NoGoRequest),
    /// Places are kept under names.
    Place(PlaceRequest),
    /// Rooms are other ones, are called otherwise or are cleaned otherwise.
    Room(RoomRequest),
    /// A robot on its dock stands here.
    MoveDock(Pose2),
}

/// An edit that the map admits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AdmittedEdit {
    pub(crate) edit: MapEdit,
    /// What whoever asks for it does, for the log.
    deed: &'static str,
}

impl AdmittedEdit {
    /// The edit, if the map admits it now.
    fn new(brain: &Brain, edit: MapEdit, deed: &'static str) -> Result<Self, EditError> {
        brain.map().admit(&edit)?;
        Ok(Self { edit, deed })
    }
}

/// Whoever changed the map since the brain's last step.
#[derive(Debug, Default)]
pub(crate) struct HomeDesk {
    waiting: Vec<Asker>,
}

impl HomeDesk {
    /// Whether somebody waits for a change.
    pub(crate) fn is_waited_for(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Takes a change of the map, which the brain gets next; whoever wants it hears of it when it is on the disk.
    ///
    /// # Errors
    /// Why the request is refused.
    pub(crate) fn serve(
        &mut self,
        Asking { asker, request }: &Asking<HomeRequest>,
        mind: Option<&Mind>,
        teller: &mut Teller<'_>,
    ) -> Result<(AdmittedEdit, Reply), Refusal> {
        let edit = match request {
            HomeRequest::NoGo(request) => request.edit(mind),
            HomeRequest::Place(request) => request.edit(mind),
            HomeRequest::Room(request) => request.edit(mind),
            HomeRequest::MoveDock(pose) => rooms::move_dock(*pose, mind),
        }?;
        let text = format!("{} {}", teller.name(asker.client), edit.deed);
        teller.log(LogLevel::Info, Part::Client, text);
        self.waiting.push(*asker);
        Ok((edit, Reply::AfterStep))
    }

    /// After the step in which the brain took them up: the map goes to the disk with all changes.
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

/// The brain, in the home that is kept.
pub(crate) fn known_home(mind: Option<&Mind>) -> Result<&Mind, Refusal> {
    let mind = mind.ok_or("no-robot")?;
    mind.admit_edit()?;
    Ok(mind)
}

/// The robot got lost within the step.
fn not_kept(id: Option<u32>) -> Update {
    Update::Failed(Failure {
        id,
        reason: Reason::PlaceUnknown.name().to_owned(),
        text:
            "The robot has just lost its way, so its map is not kept: try again when it stands on its dock."
                .to_owned(),
    })
}
