//! What a client asks.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::{
    CalibrationAnswer, CleaningPower, JobOrder, LearntPart, NoGoShape, PlaceShape, QuietHours, RoomBefore,
    RoomNaming, RoomSettings, RoomSplitting, ScheduleEntry, Topic,
};

/// A request, optionally numbered: a numbered one is answered by [`crate::Update::Done`] or [`crate::Update::Failed`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// Number chosen by the client.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u32>,
    /// What.
    #[serde(flatten)]
    pub body: RequestBody,
}

/// The closed set of requests; on the wire `{"c":"start","strategy":"bounce"}` and so on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "c", rename_all = "kebab-case")]
pub enum RequestBody {
    /// Introduces the client; answered by [`crate::Update::Hello`].
    Hello {
        /// Name for the log.
        name: String,
    },
    /// Replaces the set of topics this client follows.
    Watch {
        /// Topics.
        topics: Vec<Topic>,
    },
    /// Starts cleaning.
    Start {
        /// Strategy by name; the configured default when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        strategy: Option<String>,
    },
    /// Cleans rooms and zones of the home, in the order in which they stand.
    Clean(JobOrder),
    /// Asks what such a job will take from where the robot stands; answered by [`crate::Update::JobEstimate`]. Refused
    /// while a job runs.
    Estimate(JobOrder),
    /// Forbids floor to all ways that are planned, from now on. Answered when the map with it is on the disk.
    AddNoGo {
        /// Where.
        shape: NoGoShape,
        /// What it is called, 1 to 40 characters.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    /// Names what is forbidden. Answered when the map with the name is on the disk.
    NameNoGo {
        /// Number, as in [`crate::HomeView::no_go`].
        number: u16,
        /// 1 to 40 characters; absent = it has none any more.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    /// Lets it forbid other floor, under its number and name. Answered when the map with it is on the disk.
    ReshapeNoGo {
        /// Number, as in [`crate::HomeView::no_go`].
        number: u16,
        /// Where it is from now on.
        shape: NoGoShape,
        /// Where it was when the change began: refused as `changed-meanwhile` if it is another now. Absent = whatever it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        was: Option<NoGoShape>,
    },
    /// Allows it again.
    RemoveNoGo {
        /// Number, as in [`crate::HomeView::no_go`].
        number: u16,
    },
    /// Keeps a zone or spot under a name, so that jobs can name it. Answered when the map with it is on the disk.
    KeepPlace {
        /// 1 to 40 characters that no other place has.
        name: String,
        /// Where it is.
        shape: PlaceShape,
        /// The number that it had before it was forgotten, so that schedules find it again; absent = a new one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        number: Option<u16>,
    },
    /// Gives a kept place another name.
    NamePlace {
        /// Number, as in [`crate::HomeView::places`].
        number: u16,
        /// 1 to 40 characters that no other place has.
        name: String,
    },
    /// Lets a kept place be elsewhere, under its number and name.
    ReshapePlace {
        /// Number, as in [`crate::HomeView::places`].
        number: u16,
        /// Where it is from now on.
        shape: PlaceShape,
        /// Where it was when the change began: refused as `changed-meanwhile` if it is another now. Absent = whatever it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        was: Option<PlaceShape>,
    },
    /// Keeps a place no longer.
    ForgetPlace {
        /// Number, as in [`crate::HomeView::places`].
        number: u16,
    },
    /// Names a room. Answered when the map with the name is on the disk.
    NameRoom(RoomNaming),
    /// Says how a room is cleaned. Answered when the map with it is on the disk.
    SetRoom {
        /// Identity of the room.
        room: u16,
        /// How; absent = as any other.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        settings: Option<RoomSettings>,
        /// How it was cleaned when the change began: refused as `changed-meanwhile` if it is another now. Absent = whatever it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        was: Option<RoomBefore>,
    },
    /// Cuts a room in two along a line. Answered, as all changes of rooms, when the map with it is on the disk; refused while
    /// a job runs or waits.
    SplitRoom(RoomSplitting),
    /// Makes two rooms that lie beside each other one.
    JoinRooms {
        /// Their identities.
        rooms: [u16; 2],
    },
    /// Takes a change of the rooms back on which no later one builds.
    UndoRoomChange {
        /// Its number, as in [`crate::HomeView::room_changes`].
        number: u16,
    },
    /// Says where the dock stands now, by eye. A robot that is on it stands there, too; one that docks there finds out where it
    /// really is. Answered when the map with it is on the disk; refused while a job runs or waits.
    MoveDock {
        /// Place of a robot on the dock, metres.
        x: f64,
        /// Place of a robot on the dock, metres.
        y: f64,
        /// Where it looks then, towards the dock's back, radians counter-clockwise from the x axis.
        heading: f64,
    },
    /// Asks what the robot has felt and tried up to now, for example after it refused something; answered by
    /// [`crate::Update::Evidence`].
    Evidence,
    /// Asks how worn or dirty parts are; answered by [`crate::Update::Health`].
    Health,
    /// Says that a part was cleaned or changed: its load is learnt anew. Answered when that is on the disk.
    ResetHealth {
        /// Name, as in [`crate::ComponentHealth::component`].
        component: String,
    },
    /// Says that a part was replaced, or cleaned if that is what is done with it: its hours begin anew. Answered when that is on the
    /// disk.
    RenewPart {
        /// Name, as in [`crate::ComponentHealth::component`], of one with [`crate::ComponentHealth::hours`].
        component: String,
    },
    /// Takes the last of that back: the part has the hours that it had, and those since. Answered when that is on the disk.
    UndoRenewPart {
        /// Name, as in [`RequestBody::RenewPart`].
        component: String,
    },
    /// Asks what is kept of what robots have learnt of themselves; answered by [`crate::Update::Learnt`].
    Learnt,
    /// Has something of that forgotten, because the gyro or the pack was changed. Answered when that is on the disk.
    ForgetLearnt {
        /// Name of the robot, as in [`crate::LearntView::device`].
        device: String,
        /// What; absent = all.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        part: Option<LearntPart>,
    },
    /// Cleans a small disc around the present place.
    Spot,
    /// Drives to a place on the map without cleaning, and stands there.
    GoTo {
        /// Place on the map, metres.
        x: f64,
        /// Place on the map, metres.
        y: f64,
    },
    /// Stands still, keeps the job.
    Pause,
    /// Goes on with the paused job.
    Resume,
    /// Ends the job. Any client may say so at any time.
    Stop,
    /// Docks when the way leads there.
    Dock,
    /// Drives by hand under a lease. The first asks for the driver's seat; refused with `driver-busy` while another client
    /// holds it.
    Drive {
        /// Forward speed, m/s.
        v: f64,
        /// Turn rate, rad/s, counter-clockwise positive.
        w: f64,
        /// Lease in ms, 1..=400.
        ttl: u16,
        /// Brushes and suction run.
        #[serde(default)]
        clean: bool,
        /// How hard each of them runs, in place of `clean`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        power: Option<CleaningPower>,
    },
    /// Leaves the driver's seat; the wheels stop at once.
    Release,
    /// Tells what inputs of control mixes read, under a lease, for another client to drive by; in place of all that this client
    /// told before. They end with the lease and with the client's connection. The first who tells a name has it meanwhile.
    SetInputs {
        /// Names as in the input `client-NAME` of a mix, with what each reads, -1..=1; none ends them.
        values: BTreeMap<String, f64>,
        /// Lease in ms, 1..=400.
        ttl: u16,
    },
    /// Beeps so that a person finds the robot.
    Locate,
    /// Asks the daemon to let go of the serial line, so that this client can write the robot's firmware over it. The daemon takes it
    /// again by itself when the connection of this client ends. Refused unless the robot stands on its dock with a charge of 40 %.
    BorrowLink {
        /// The robot does not answer, and the owner says that it stands where it should: nothing can be checked.
        #[serde(default)]
        silent: bool,
    },
    /// Asks what was measured of the robot; answered by [`crate::Update::Calibration`].
    Calibration,
    /// Measures values of the robot, step by step. Each step is a [`crate::Update::CalibrationPage`] to this client. Meanwhile the
    /// robot counts as disconnected. It ends with this client's connection, and with `stop` of anybody.
    BeginCalibration {
        /// Names of values; none = all that are not measured.
        #[serde(default)]
        names: Vec<String>,
    },
    /// Answers a page of the calibration.
    AnswerCalibration {
        /// [`crate::CalibrationPage::page`].
        page: u32,
        /// What.
        answer: CalibrationAnswer,
    },
    /// A person holds the motors on, for half a second, or lets go. Without it no motor runs in a calibration.
    HoldCalibration {
        /// Held, or let go.
        held: bool,
    },
    /// Ends the calibration. What was kept stays.
    EndCalibration,
    /// Presses of buttons on the robot start nothing for so long, because somebody counts them for another purpose; what runs they
    /// stop as ever. Ends by itself, and with the client's connection.
    ClaimButtons {
        /// Milliseconds, at most three minutes; 0 ends it.
        ms: u32,
    },
    /// Acknowledges an error or clears a latched inhibit by name.
    Clear {
        /// Name, as in [`crate::Status::reason`].
        reason: String,
    },
    /// Asks which versions of the map of a floor are kept; answered by [`crate::Update::Maps`].
    Maps {
        /// Number of the floor; absent = the one on which the robot is, else the first one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        floor: Option<u16>,
    },
    /// Takes up a version of the map of a floor again, and keeps it as the newest. Refused while a job runs or waits.
    RestoreMap {
        /// Number of the version.
        number: u64,
        /// Number of the floor, as in [`RequestBody::Maps`].
        #[serde(default, skip_serializing_if = "Option::is_none")]
        floor: Option<u16>,
    },
    /// Says on which floor the robot is.
    ChooseFloor {
        /// Its number.
        floor: u16,
    },
    /// Says that the robot is on a floor of which nothing is kept; what it has drawn, not knowing where it was, becomes the
    /// map of it. Answered, as all changes of floors, when it is on the disk.
    NewFloor {
        /// What people call it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    /// Names a floor.
    NameFloor {
        /// Its number.
        floor: u16,
        /// Its name; absent = none any more.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    /// Removes a floor. Its maps are kept, and it can come back.
    RemoveFloor {
        /// Its number.
        floor: u16,
    },
    /// Brings a removed floor back.
    RestoreFloor {
        /// Its number.
        floor: u16,
    },
    /// Asks for a piece of an archive of floors with the newest versions of their maps; answered by
    /// [`crate::Update::FloorArchive`].
    ExportFloors {
        /// Number of the only floor that it shall hold; absent = all that have a map.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        floor: Option<u16>,
        /// First byte of the piece.
        from: u64,
    },
    /// Hands over a piece of an archive of floors, one after the other, each when the one before it is answered. With the last
    /// one the archive is checked, and its floors are kept beside those that there are; before that nothing is.
    ImportFloors {
        /// First byte of the piece; 0 begins anew.
        from: u64,
        /// Bytes of the whole archive, at most [`crate::ARCHIVE_BYTES_MAX`].
        size: u64,
        /// The bytes, at most [`crate::ARCHIVE_UPLOAD_BYTES`] of them, in base 64.
        data: String,
    },
    /// Asks which control mixes are kept; answered by [`crate::Update::Mixes`].
    Mixes,
    /// Keeps a control mix under the name that is in it.
    SaveMix {
        /// The profile as JSON text, see the crate `mixer`.
        profile: String,
        /// What was kept under its name when the change began, as JSON text: refused as `changed-meanwhile` if that is another now.
        /// Empty = nothing was. Absent = whatever it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        was: Option<String>,
    },
    /// Removes a control mix.
    RemoveMix {
        /// Its name.
        name: String,
    },
    /// Keeps a new schedule. Answered, as all changes of schedules, when it is on the disk.
    AddSchedule(ScheduleEntry),
    /// Replaces a schedule.
    ChangeSchedule {
        /// Its number.
        number: u32,
        /// What it shall be.
        #[serde(flatten)]
        entry: ScheduleEntry,
        /// What it was when the change began: refused as `changed-meanwhile` if it is another one now. Absent = whatever it is.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        was: Option<Box<ScheduleEntry>>,
    },
    /// Removes a schedule.
    RemoveSchedule {
        /// Its number.
        number: u32,
    },
    /// Lets a schedule start by itself, or no longer.
    EnableSchedule {
        /// Its number.
        number: u32,
        /// Which.
        enabled: bool,
    },
    /// Leaves out the next run of a schedule, or no longer.
    SkipNext {
        /// Its number.
        number: u32,
        /// Which.
        skip: bool,
    },
    /// Starts what a schedule starts, now, as if this client had asked for the job itself.
    RunSchedule {
        /// Its number.
        number: u32,
    },
    /// Sets the quiet hours.
    SetQuiet {
        /// Which; absent = none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        quiet: Option<QuietHours>,
    },
    /// Sets the time zone of the schedules.
    SetZone {
        /// Its name in the IANA database, for example `Europe/Tallinn`; absent = the system's.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        zone: Option<String>,
    },
    /// Asks for runs that are over, newest first; answered by [`crate::Update::Runs`].
    Runs {
        /// Only runs with lower numbers; absent = from the newest on.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        before: Option<u64>,
        /// At most so many, 1..=50; absent = 20.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        count: Option<u8>,
    },
    /// Asks what all runs since the first one come to; answered by [`crate::Update::Statistics`].
    Statistics,
    /// Asks for all that is kept of a run; answered by [`crate::Update::Run`].
    Run {
        /// Its number.
        number: u64,
    },
    /// Asks for what the recordings of a run tell, in few numbers; answered by [`crate::Update::RunTrack`].
    RunTrack {
        /// Number of the run.
        number: u64,
        /// Which of its recordings, from 0; absent = all of them, one after the other.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        recording: Option<u32>,
    },
    /// Asks for a piece of the recording of a run; answered by [`crate::Update::RunFile`].
    RunFile {
        /// Number of the run.
        number: u64,
        /// Which of its recordings, from 0; absent = all of them as one file.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        recording: Option<u32>,
        /// First byte of the piece.
        from: u64,
    },
    /// Sends a raw packet of the wire, text without a CRC, to the robot. Only where the configuration allows it.
    Raw {
        /// The JSON object as text.
        packet: String,
    },
}
