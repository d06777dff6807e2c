//! Edits of the stored home by clients. Each edit is admitted, made in the next step of the brain, and answered when the map with it
//! is on the disk; one that cannot be made any more by then is refused by its name.

mod no_go;
mod places;
mod rooms;

use brain::{Brain, EditError, MapEdit, NoGoEdit, PlaceEdit, Reason, RoomEdit};
use rvac_api::{LogLevel, NoGoShape, PlaceShape, RoomSettings};

use super::audience::{Asker, Asking, Teller};
use super::journal::LogSource;
use super::reply::Reply;
use super::room_power::to_api;
use crate::api_forms;
use crate::brain_session::BrainSession;
use crate::refusal::Refusal;
use crate::{EditedMap, FloorHome};

pub(crate) use no_go::to_no_go;
pub(crate) use places::{to_place, to_shape, with_any_places, with_places};
pub(crate) use rooms::to_line;

/// An edit that a client asks for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HomeEdit {
    pub(crate) edit: MapEdit,
    /// What the client does, for the log.
    pub(crate) deed: &'static str,
    /// What the client has seen of it before, if it says so.
    pub(crate) was: Option<SeenBefore>,
}

/// What a client has seen of a part of the home when it began to change it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SeenBefore {
    NoGo(NoGoShape),
    Place(PlaceShape),
    Room(Option<RoomSettings>),
}

impl SeenBefore {
    /// Whether the part that this edit changes still is what the client has seen.
    fn is_still(&self, edit: &MapEdit, brain: &Brain) -> bool {
        let annotations = brain.map().annotations();
        match (self, edit) {
            (Self::NoGo(shape), MapEdit::NoGo(NoGoEdit::Reshape { number, .. })) => annotations
                .no_go()
                .find(|(own, _)| own == number)
                .is_none_or(|(_, no_go)| api_forms::no_go(no_go) == *shape),
            (Self::Place(shape), MapEdit::Place(PlaceEdit::Reshape { number, .. })) => annotations
                .place(*number)
                .is_none_or(|place| api_forms::place(place.shape()) == *shape),
            (Self::Room(settings), MapEdit::Room(RoomEdit::Set { room, .. })) => {
                annotations.settings(*room).map(to_api) == *settings
            }
            _ => true,
        }
    }
}

/// What a step of the brain did with the oldest edits that waited for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EditedStep<'step> {
    /// In the order of the requests.
    pub(crate) results: &'step [Result<(), EditError>],
    /// After the step.
    pub(crate) brain: &'step Brain,
    /// The map with the edits, for the disk; `None` if the robot got lost.
    pub(crate) home: Option<&'step FloorHome>,
}

/// Clients whose edits wait for the next step of the brain.
#[derive(Debug, Default)]
pub(crate) struct HomeDesk {
    /// In the order in which the brain gets them.
    waiting: Vec<Waiting>,
}

#[derive(Debug)]
struct Waiting {
    asker: Asker,
    edit: MapEdit,
}

impl HomeDesk {
    /// Admits an edit for the next step of the brain. The client is answered by [`Self::keep`] or when the map is on the disk.
    ///
    /// # Errors
    /// Why the request is refused.
    pub(crate) fn serve(
        &mut self,
        Asking { asker, request }: Asking<HomeEdit>,
        brain_session: Option<&BrainSession>,
        teller: &mut Teller<'_>,
    ) -> Result<(MapEdit, Reply), Refusal> {
        let HomeEdit { edit, deed, was } = request;
        let brain = home_for(&edit, brain_session)?.brain();
        let is_unchanged = was.is_none_or(|was| was.is_still(&edit, brain) && !self.waits_for(&edit));
        if !is_unchanged {
            return Err(Refusal {
                reason: "changed-meanwhile",
                text: "Somebody else has changed this meanwhile: look at what it is now, and save again."
                    .to_owned(),
            });
        }
        let admitted = brain.map().admit(&edit);
        admitted.map_err(|error| refusal(error, &edit, brain))?;
        let text = format!("{} {deed}", teller.name(asker.client));
        teller.log(LogLevel::Info, LogSource::Client, text);
        self.waiting.push(Waiting {
            asker,
            edit: edit.clone(),
        });
        Ok((edit, Reply::AfterStep))
    }

    /// Whether an edit of the same part waits for the next step.
    fn waits_for(&self, edit: &MapEdit) -> bool {
        let target = |edit: &MapEdit| match edit {
            MapEdit::NoGo(NoGoEdit::Reshape { number, .. }) => Some((0, *number)),
            MapEdit::Place(PlaceEdit::Reshape { number, .. }) => Some((1, *number)),
            MapEdit::Room(RoomEdit::Set { room, .. }) => Some((2, *room)),
            _ => None,
        };
        let own = target(edit);
        own.is_some() && self.waiting.iter().any(|waiting| target(&waiting.edit) == own)
    }

    /// After a step of the brain: the map goes to the disk with the edits that were made, in the order of the requests. Those that the
    /// edits before them have made impossible are refused.
    pub(crate) fn keep(&mut self, step: EditedStep<'_>, teller: &mut Teller<'_>) {
        let answered = self.waiting.len().min(step.results.len());
        for (Waiting { asker, edit }, result) in self.waiting.drain(..answered).zip(step.results) {
            match (result, step.home) {
                (Ok(()), Some(home)) => teller.outputs.map_edits.push(EditedMap {
                    client: asker.client,
                    id: asker.id,
                    home: home.clone(),
                }),
                (Ok(()), None) => teller.answer(asker, Err(not_kept())),
                (Err(error), _) => teller.answer(asker, Err(refusal(*error, &edit, step.brain))),
            }
        }
    }

    /// The oldest `count` edits are not made: the brain has another map now.
    pub(crate) fn refuse_oldest(&mut self, count: usize, teller: &mut Teller<'_>) {
        let count = count.min(self.waiting.len());
        for Waiting { asker, .. } in self.waiting.drain(..count) {
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

/// The brain, if it knows the home that is stored and may make this edit now.
fn home_for<'session>(
    edit: &MapEdit,
    brain_session: Option<&'session BrainSession>,
) -> Result<&'session BrainSession, Refusal> {
    let brain_session = known_home(brain_session)?;
    let rests = brain_session.rests() && !brain_session.holds_commands();
    if edit.needs_rest() && !rests {
        return Err("job-runs".into());
    }
    Ok(brain_session)
}

/// What is wrong with an edit, in words.
fn refusal(error: EditError, edit: &MapEdit, brain: &Brain) -> Refusal {
    match edit {
        MapEdit::NoGo(edit) => no_go::refusal(error, edit, brain),
        MapEdit::Place(edit) => places::refusal(error, edit, brain),
        MapEdit::Room(edit) => rooms::refusal(error, edit, brain),
        MapEdit::Dock(pose) => rooms::dock_refusal(error, *pose, brain),
    }
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
