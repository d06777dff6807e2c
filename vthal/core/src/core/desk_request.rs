//! What clients ask, sorted by the desks that do it. Each desk has one closed set of requests; what it can take as it is stands here as
//! the desk's own change.

use brain::{MapEdit, NoGo, NoGoEdit, PlaceEdit, Point2, Pose2, RoomEdit, RoomName};
use rvac_api::{
    CleaningPower, JobOrder, NoGoShape, RequestBody as Body, RoomNaming, RoomSplitting, Topic, short_number,
};

use crate::api_forms;
use crate::desk::calibration::CalibrationRequest;
use crate::desk::driver::{HandDrive, NO_POWER};
use crate::desk::floors::FloorRequest;
use crate::desk::health::HealthRequest;
use crate::desk::history;
use crate::desk::home::{HomeEdit, SeenBefore, to_line, to_no_go, to_place, to_shape};
use crate::desk::input_desk::LeasedInputs;
use crate::desk::learnt::{Forgetting, LearntRequest};
use crate::desk::room_power::{to_api, to_brain};
use crate::desk::schedules::ScheduleRequest;
use crate::desk::words::to_name;
use crate::refusal::Refusal;
use crate::schedule::ScheduleEdit;
use crate::{ArchiveTask, MixTask, RunTask};

/// A request, by its desk.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DeskRequest {
    Session(SessionRequest),
    Job(JobRequest),
    Hand(HandRequest),
    Robot(RobotRequest),
    /// What the robot has felt and tried up to now.
    Evidence,
    Home(HomeEdit),
    Floors(FloorRequest),
    Schedules(ScheduleRequest),
    Health(HealthRequest),
    Learnt(LearntRequest),
    Runs(RunTask),
    Mixes(MixTask),
}

/// What a client declares about itself.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SessionRequest {
    /// Its name.
    Hello(String),
    /// What it follows.
    Watch(Vec<Topic>),
}

/// Jobs of the robot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum JobRequest {
    /// The whole floor, with a named strategy.
    Start(Option<String>),
    /// Parts of the home.
    Clean(JobOrder),
    /// What that would take.
    Estimate(JobOrder),
    /// The job of a schedule, now.
    OfSchedule(u32),
    Spot,
    GoTo(Point2),
    Pause,
    Resume,
    Dock,
}

/// What a person does by hand, and what stops the robot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum HandRequest {
    Stop,
    Drive(HandDrive),
    /// The driver's seat is left.
    Release,
    /// What inputs of control mixes read.
    Inputs(LeasedInputs),
    /// Presses of buttons are for the client, for so many ms.
    ClaimButtons(u32),
}

/// What is asked of the device itself.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RobotRequest {
    Locate,
    /// An error or a latched inhibit of this name is seen to.
    Clear(String),
    /// A packet of the wire.
    Raw(String),
    /// Measuring values of it.
    Calibration(CalibrationRequest),
    /// The serial line, for a client that writes firmware.
    BorrowLink(RobotAnswers),
}

/// Whether the robot can be asked where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RobotAnswers {
    /// It is to be asked.
    Expected,
    /// It is silent, and the owner has looked.
    Silent,
}

impl DeskRequest {
    /// A table: one line a request or a pair of short ones, and with each edit of the map what the client does, for the log.
    ///
    /// # Errors
    /// The request names something that cannot be.
    #[rustfmt::skip]
    pub(crate) fn of(body: Body) -> Result<Self, Refusal> {
        Ok(match body {
            Body::Hello { name } => Self::Session(SessionRequest::Hello(name)),
            Body::Watch { topics } => Self::Session(SessionRequest::Watch(topics)),
            Body::Start { strategy } => Self::Job(JobRequest::Start(strategy)),
            Body::Clean(order) => Self::Job(JobRequest::Clean(order)),
            Body::Estimate(order) => Self::Job(JobRequest::Estimate(order)),
            Body::RunSchedule { number } => Self::Job(JobRequest::OfSchedule(number)),
            Body::Spot => Self::Job(JobRequest::Spot), Body::GoTo { x, y } => Self::Job(JobRequest::GoTo(Point2 { x_m: x, y_m: y })),
            Body::Pause => Self::Job(JobRequest::Pause), Body::Resume => Self::Job(JobRequest::Resume),
            Body::Stop => Self::Hand(HandRequest::Stop), Body::Release => Self::Hand(HandRequest::Release),
            Body::ClaimButtons { ms } => Self::Hand(HandRequest::ClaimButtons(ms)),
            Body::Dock => Self::Job(JobRequest::Dock), Body::Locate => Self::Robot(RobotRequest::Locate),
            Body::Clear { reason } => Self::Robot(RobotRequest::Clear(reason)),
            Body::Raw { packet } => Self::Robot(RobotRequest::Raw(packet)),
            Body::BorrowLink { silent } => Self::Robot(RobotRequest::BorrowLink(if silent { RobotAnswers::Silent } else { RobotAnswers::Expected })),
            Body::Calibration => calibration(CalibrationRequest::Show),
            Body::BeginCalibration { names } => calibration(CalibrationRequest::Begin(names)),
            Body::AnswerCalibration { page, answer } => calibration(CalibrationRequest::Answer(page, answer)),
            Body::HoldCalibration { held } => calibration(CalibrationRequest::Hold(held)),
            Body::EndCalibration => calibration(CalibrationRequest::End),
            Body::Drive { v, w, ttl, clean, power } => Self::Hand(HandRequest::Drive(HandDrive { speed_m_per_s: v, turn_rad_per_s: w, lease_ms: ttl, power: power.unwrap_or(if clean { CleaningPower::FULL } else { NO_POWER }) })),
            Body::SetInputs { values, ttl } => Self::Hand(HandRequest::Inputs(LeasedInputs { values, lease_ms: ttl })),
            Body::Evidence => Self::Evidence,
            Body::AddNoGo { shape, name } => no_go(NoGoEdit::Add(named_no_go(&shape, name)?), "forbids floor of the map"),
            Body::NameNoGo { number, name } => no_go(NoGoEdit::Name { number, name: name_if_any(name)? }, "names forbidden floor"),
            Body::ReshapeNoGo { number, shape, was } => no_go(NoGoEdit::Reshape { number, no_go: to_no_go(&shape)? }, "reshapes forbidden floor").seen(was.map(SeenBefore::NoGo)),
            Body::RemoveNoGo { number } => no_go(NoGoEdit::Remove { number }, "allows floor of the map again"),
            Body::KeepPlace { name, shape, number } => place(PlaceEdit::Keep { place: to_place(&name, &shape)?, number }, "keeps a place"),
            Body::NamePlace { number, name } => place(PlaceEdit::Name { number, name: to_name(&name)? }, "names a place"),
            Body::ReshapePlace { number, shape, was } => place(PlaceEdit::Reshape { number, shape: to_shape(&shape)? }, "moves a place").seen(was.map(SeenBefore::Place)),
            Body::ForgetPlace { number } => place(PlaceEdit::Forget { number }, "keeps a place no longer"),
            Body::NameRoom(RoomNaming { room: id, name }) => room(RoomEdit::Name { room: id, name: name_if_any(name)? }, "names a room"),
            Body::SetRoom { room: id, settings, was } => room(RoomEdit::Set { room: id, settings: settings.map(to_brain).transpose()? }, "says how a room is cleaned").seen(was.map(|was| SeenBefore::Room(was.settings))),
            Body::SplitRoom(RoomSplitting { room: id, line }) => room(RoomEdit::Split { room: id, line: to_line(line)? }, "splits a room"),
            Body::JoinRooms { rooms } => room(RoomEdit::Join { rooms }, "joins two rooms"),
            Body::UndoRoomChange { number } => room(RoomEdit::Undo { number }, "takes a change of the rooms back"),
            Body::MoveDock { x, y, heading } => edit(MapEdit::Dock(Pose2 { x_m: x, y_m: y, heading_rad: to_heading(heading)? }), "says where the dock stands"),
            Body::Health => Self::Health(HealthRequest::Show),
            Body::ResetHealth { component } => Self::Health(HealthRequest::Reset(component)),
            Body::RenewPart { component } => Self::Health(HealthRequest::Renew(component)),
            Body::UndoRenewPart { component } => Self::Health(HealthRequest::UndoRenew(component)),
            Body::Learnt => Self::Learnt(LearntRequest::Show),
            Body::ForgetLearnt { device, part } => Self::Learnt(LearntRequest::Forget(Forgetting { device, part })),
            Body::Maps { floor } => Self::Floors(FloorRequest::Maps { floor }),
            Body::RestoreMap { number, floor } => Self::Floors(FloorRequest::RestoreMap { floor, number }),
            Body::ChooseFloor { floor } => Self::Floors(FloorRequest::Choose { floor }),
            Body::NewFloor { name } => Self::Floors(FloorRequest::New { name }),
            Body::NameFloor { floor, name } => Self::Floors(FloorRequest::Name { floor, name }),
            Body::RemoveFloor { floor } => Self::Floors(FloorRequest::Remove { floor }),
            Body::RestoreFloor { floor } => Self::Floors(FloorRequest::Restore { floor }),
            Body::ExportFloors { floor, from } => archive(ArchiveTask::Export { floor, from }),
            Body::ImportFloors { from, size, data } => archive(ArchiveTask::Import { from, size, data }),
            Body::AddSchedule(entry) => Self::Schedules(ScheduleRequest::Add(entry)),
            Body::ChangeSchedule { number, entry, was } => Self::Schedules(ScheduleRequest::Change { number, entry, was }),
            Body::RemoveSchedule { number } => schedule(ScheduleEdit::Remove(number)),
            Body::EnableSchedule { number, enabled } => schedule(ScheduleEdit::Enable(number, enabled)),
            Body::SkipNext { number, skip } => schedule(ScheduleEdit::SkipNext(number, skip)),
            Body::SetQuiet { quiet } => schedule(ScheduleEdit::quiet_from_api(quiet.as_ref())?),
            Body::SetZone { zone } => schedule(ScheduleEdit::zone_from_api(zone.as_deref())?),
            Body::Mixes => Self::Mixes(MixTask::List),
            Body::SaveMix { profile, was } => Self::Mixes(MixTask::Save { profile, was }),
            Body::RemoveMix { name } => Self::Mixes(MixTask::Remove(name)),
            Body::Runs { before, count } => Self::Runs(RunTask::List { before, count: history::list_length(count)? }),
            Body::Statistics => Self::Runs(RunTask::Statistics),
            Body::Run { number } => Self::Runs(RunTask::Show(number)),
            Body::RunTrack { number, recording } => Self::Runs(RunTask::Track { number, recording }),
            Body::RunFile { number, recording, from } => Self::Runs(RunTask::File { number, recording, from }),
        })
    }
}

impl DeskRequest {
    /// The same edit of the home, of a client that has seen this before it.
    fn seen(self, was: Option<SeenBefore>) -> Self {
        match self {
            Self::Home(edit) => Self::Home(HomeEdit { was, ..edit }),
            other => other,
        }
    }
}

/// What a client would ask for this edit: the form in which recordings keep it.
pub(crate) fn body_of(edit: &MapEdit) -> Body {
    match edit {
        MapEdit::NoGo(edit) => body_of_no_go(edit),
        MapEdit::Place(edit) => body_of_place(edit),
        MapEdit::Room(edit) => body_of_room(edit),
        MapEdit::Dock(pose) => Body::MoveDock {
            x: pose.x_m,
            y: pose.y_m,
            heading: pose.heading_rad,
        },
    }
}

fn body_of_no_go(edit: &NoGoEdit) -> Body {
    match edit {
        NoGoEdit::Add(no_go) => Body::AddNoGo {
            shape: api_forms::no_go(no_go),
            name: text_of(no_go.name()),
        },
        NoGoEdit::Name { number, name } => Body::NameNoGo {
            number: *number,
            name: text_of(name.as_ref()),
        },
        NoGoEdit::Reshape { number, no_go } => Body::ReshapeNoGo {
            number: *number,
            shape: api_forms::no_go(no_go),
            was: None,
        },
        NoGoEdit::Remove { number } => Body::RemoveNoGo { number: *number },
    }
}

fn body_of_place(edit: &PlaceEdit) -> Body {
    match edit {
        PlaceEdit::Keep { place, number } => Body::KeepPlace {
            name: place.name().as_str().to_owned(),
            shape: api_forms::place(place.shape()),
            number: *number,
        },
        PlaceEdit::Name { number, name } => Body::NamePlace {
            number: *number,
            name: name.as_str().to_owned(),
        },
        PlaceEdit::Reshape { number, shape } => Body::ReshapePlace {
            number: *number,
            shape: api_forms::place(shape),
            was: None,
        },
        PlaceEdit::Forget { number } => Body::ForgetPlace { number: *number },
    }
}

fn body_of_room(edit: &RoomEdit) -> Body {
    match edit {
        RoomEdit::Name { room, name } => Body::NameRoom(RoomNaming {
            room: *room,
            name: text_of(name.as_ref()),
        }),
        RoomEdit::Set { room, settings } => Body::SetRoom {
            room: *room,
            settings: settings.as_ref().map(to_api),
            was: None,
        },
        RoomEdit::Split { room, line } => Body::SplitRoom(RoomSplitting {
            room: *room,
            line: line.ends().map(|end| [end.x_m, end.y_m]),
        }),
        RoomEdit::Join { rooms } => Body::JoinRooms { rooms: *rooms },
        RoomEdit::Undo { number } => Body::UndoRoomChange { number: *number },
    }
}

fn text_of(name: Option<&RoomName>) -> Option<String> {
    name.map(|name| name.as_str().to_owned())
}

fn name_if_any(name: Option<String>) -> Result<Option<RoomName>, Refusal> {
    name.as_deref().map(to_name).transpose()
}

fn named_no_go(shape: &NoGoShape, name: Option<String>) -> Result<NoGo, Refusal> {
    let name = name_if_any(name)?;
    Ok(to_no_go(shape)?.with_name(name))
}

/// A heading within a turn either way: what is far beyond has lost its meaning in the digits that are left.
fn to_heading(heading_rad: f64) -> Result<f64, Refusal> {
    if heading_rad.abs() <= core::f64::consts::TAU {
        return Ok(heading_rad);
    }
    Err(Refusal {
        reason: "range",
        text: format!(
            "The heading is {}: write radians from -6.28 to 6.28.",
            short_number(heading_rad)
        ),
    })
}

const fn edit(edit: MapEdit, deed: &'static str) -> DeskRequest {
    DeskRequest::Home(HomeEdit {
        edit,
        deed,
        was: None,
    })
}

const fn no_go(change: NoGoEdit, deed: &'static str) -> DeskRequest {
    edit(MapEdit::NoGo(change), deed)
}

const fn place(change: PlaceEdit, deed: &'static str) -> DeskRequest {
    edit(MapEdit::Place(change), deed)
}

const fn room(change: RoomEdit, deed: &'static str) -> DeskRequest {
    edit(MapEdit::Room(change), deed)
}

const fn calibration(request: CalibrationRequest) -> DeskRequest {
    DeskRequest::Robot(RobotRequest::Calibration(request))
}

const fn schedule(change: ScheduleEdit) -> DeskRequest {
    DeskRequest::Schedules(ScheduleRequest::Edit(change))
}

fn archive(task: ArchiveTask) -> DeskRequest {
    DeskRequest::Floors(FloorRequest::Archive(task))
}
