//! What clients ask, sorted by the desks that do it. Each desk has one closed set of requests.

use brain::Pose2;
use rvac_api::{CleaningPower, JobOrder, RequestBody as Body, Topic};

use crate::desk::driver::{HandDrive, NO_POWER};
use crate::desk::floors::FloorRequest;
use crate::desk::health::HealthRequest;
use crate::desk::history;
use crate::desk::home::{HomeRequest, NoGoRequest, PlaceRequest, RoomRequest};
use crate::desk::input_desk::LeasedInputs;
use crate::desk::learnt::{Forgetting, LearntRequest};
use crate::desk::schedules::ScheduleRequest;
use crate::{ArchiveTask, MixTask, RunTask};

/// A request, by its desk.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum DeskRequest {
    Session(SessionRequest),
    Job(JobRequest),
    Hand(HandRequest),
    Robot(RobotRequest),
    /// What the robot has felt and tried up to now.
    Evidence,
    Home(HomeRequest),
    Floors(FloorRequest),
    Schedules(ScheduleRequest),
    Health(HealthRequest),
    Learnt(LearntRequest),
    Runs(RunTask),
    Mixes(MixTask),
}

/// What a client declares about itself.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum SessionRequest {
    /// Its name.
    Hello(String),
    /// What it follows.
    Watch(Vec<Topic>),
}

/// Jobs of the robot.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum JobRequest {
    /// The whole floor, with a named strategy.
    Start(Option<String>),
    /// Parts of the home.
    Clean(JobOrder),
    /// What that would take.
    Estimate(JobOrder),
    /// The job of a schedule, now.
    OfSchedule(u32),
    Spot,
    Pause,
    Resume,
    Dock,
}

/// What a person does by hand, and what stops the robot.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum HandRequest {
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
pub(super) enum RobotRequest {
    Locate,
    /// An error or a latched inhibit of this name is seen to.
    Clear(String),
    /// A packet of the wire.
    Raw(String),
}

impl From<Body> for DeskRequest {
    // A table: one line a request.
    #[rustfmt::skip]
    fn from(body: Body) -> Self {
        match body {
            Body::Hello { name } => Self::Session(SessionRequest::Hello(name)),
            Body::Watch { topics } => Self::Session(SessionRequest::Watch(topics)),
            Body::Start { strategy } => Self::Job(JobRequest::Start(strategy)),
            Body::Clean(order) => Self::Job(JobRequest::Clean(order)),
            Body::Estimate(order) => Self::Job(JobRequest::Estimate(order)),
            Body::RunSchedule { number } => Self::Job(JobRequest::OfSchedule(number)),
            Body::Spot => Self::Job(JobRequest::Spot),
            Body::Pause => Self::Job(JobRequest::Pause),
            Body::Resume => Self::Job(JobRequest::Resume),
            Body::Dock => Self::Job(JobRequest::Dock),
            Body::Stop => Self::Hand(HandRequest::Stop),
            Body::Release => Self::Hand(HandRequest::Release),
            Body::ClaimButtons { ms } => Self::Hand(HandRequest::ClaimButtons(ms)),
            Body::Locate => Self::Robot(RobotRequest::Locate),
            Body::Clear { reason } => Self::Robot(RobotRequest::Clear(reason)),
            Body::Raw { packet } => Self::Robot(RobotRequest::Raw(packet)),
            Body::Drive { v, w, ttl, clean, power } => Self::Hand(HandRequest::Drive(HandDrive {
                speed_m_per_s: v,
                turn_rad_per_s: w,
                lease_ms: ttl,
                power: power.unwrap_or(if clean { CleaningPower::FULL } else { NO_POWER }),
            })),
            Body::SetInputs { values, ttl } => Self::Hand(HandRequest::Inputs(LeasedInputs { values, lease_ms: ttl })),
            Body::Evidence => Self::Evidence,
            Body::AddNoGo { shape, name } => no_go(NoGoRequest::Add { shape, name }),
            Body::NameNoGo { number, name } => no_go(NoGoRequest::Name { number, name }),
            Body::ReshapeNoGo { number, shape } => no_go(NoGoRequest::Reshape { number, shape }),
            Body::RemoveNoGo { number } => no_go(NoGoRequest::Remove { number }),
            Body::KeepPlace { name, shape, number } => place(PlaceRequest::Keep { name, shape, number }),
            Body::NamePlace { number, name } => place(PlaceRequest::Name { number, name }),
            Body::ReshapePlace { number, shape } => place(PlaceRequest::Reshape { number, shape }),
            Body::ForgetPlace { number } => place(PlaceRequest::Forget { number }),
            Body::NameRoom(naming) => room(RoomRequest::Name(naming)),
            Body::SetRoom { room: id, settings } => room(RoomRequest::Set { room: id, settings }),
            Body::SplitRoom(splitting) => room(RoomRequest::Split(splitting)),
            Body::JoinRooms { rooms } => room(RoomRequest::Join { rooms }),
            Body::UndoRoomChange { number } => room(RoomRequest::Undo { number }),
            Body::MoveDock { x, y, heading } => Self::Home(HomeRequest::MoveDock(Pose2 { x_m: x, y_m: y, heading_rad: heading })),
            Body::Health => Self::Health(HealthRequest::Show),
            Body::ResetHealth { component } => Self::Health(HealthRequest::Reset(component)),
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
            Body::ChangeSchedule { number, entry } => Self::Schedules(ScheduleRequest::Change { number, entry }),
            Body::RemoveSchedule { number } => Self::Schedules(ScheduleRequest::Remove { number }),
            Body::EnableSchedule { number, enabled } => Self::Schedules(ScheduleRequest::Enable { number, enabled }),
            Body::SkipNext { number, skip } => Self::Schedules(ScheduleRequest::SkipNext { number, skip }),
            Body::SetQuiet { quiet } => Self::Schedules(ScheduleRequest::SetQuiet(quiet)),
            Body::SetZone { zone } => Self::Schedules(ScheduleRequest::SetZone(zone)),
            Body::Mixes => Self::Mixes(MixTask::List),
            Body::SaveMix { profile } => Self::Mixes(MixTask::Save(profile)),
            Body::RemoveMix { name } => Self::Mixes(MixTask::Remove(name)),
            Body::Runs { before, count } => Self::Runs(RunTask::List { before, count: history::list_length(count) }),
            Body::Run { number } => Self::Runs(RunTask::Show(number)),
            Body::RunTrack { number, recording } => Self::Runs(RunTask::Track { number, recording }),
            Body::RunFile { number, recording, from } => Self::Runs(RunTask::File { number, recording, from }),
        }
    }
}

fn no_go(request: NoGoRequest) -> DeskRequest {
    DeskRequest::Home(HomeRequest::NoGo(request))
}

fn place(request: PlaceRequest) -> DeskRequest {
    DeskRequest::Home(HomeRequest::Place(request))
}

fn room(request: RoomRequest) -> DeskRequest {
    DeskRequest::Home(HomeRequest::Room(request))
}

fn archive(task: ArchiveTask) -> DeskRequest {
    DeskRequest::Floors(FloorRequest::Archive(task))
}
