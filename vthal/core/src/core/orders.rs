//! What clients order for parts of the home, and what they say of the home.

use brain::zone::FAR_M;
use brain::{CleaningOrder, Command, HomePart, NoGo, Point2, Pose2, Reason, RoomName, Zone};
use rvac_api::{
    Failure, JobEstimate, JobOrder, JobPart, LogLevel, NoGoShape, RequestBody, RoomNaming, Update,
};

use super::Core;
use super::places::with_places;
use super::refusal::Refusal;
use super::room_power::{to_pattern, to_power};
use crate::journal::Part;
use crate::mind::Mind;
use crate::outputs::{Delivery, Recipients};
use crate::{ClientId, MapEdit, Outputs};

/// A client draws a spot as large as the brain cleans it.
const _: () = assert!(rvac_api::SPOT_RADIUS_M == brain::SPOT_RADIUS_M);

/// Who asks, and the number of the request.
pub(super) type Asker = (ClientId, Option<u32>);

impl Core {
    pub(super) fn clean(
        &mut self,
        now_us: u64,
        (client, order): (ClientId, &JobOrder),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        self.require_robot()?;
        let command = self.clean_command(order)?;
        Ok(self.job(now_us, (client, command), outputs)?)
    }

    /// What the brain is told to clean parts of the home; refused as the brain would refuse it.
    pub(super) fn clean_command(&self, order: &JobOrder) -> Result<Command, Refusal> {
        let brain = self.known_home()?.brain();
        let order = to_order(&with_places(order, brain)?)?;
        let command = Command::CleanParts { order: order.clone() };
        match brain.admit(&command) {
            Ok(()) => Ok(command),
            Err(reason) => Err(Refusal::of_order(reason, &order, brain)),
        }
    }

    /// A plan of the whole order takes long enough to be felt by wheels that turn, so none is made while they may.
    pub(super) fn estimate(
        &self,
        (client, id): Asker,
        order: &JobOrder,
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        self.require_robot()?;
        let mind = self.known_home()?;
        let brain = mind.brain();
        let order = to_order(&with_places(order, brain)?)?;
        if !mind.rests() {
            return Err("job-runs".into());
        }
        let found = brain
            .estimate_order(&order)
            .map_err(|reason| Refusal::of_order(reason, &order, brain))?;
        outputs.deliveries.push(Delivery {
            to: Recipients::One(client),
            update: Update::JobEstimate(JobEstimate {
                id,
                floor_m2: found.floor_m2,
                time_s: found.time_s,
                charge: found.charge,
                share: found.share,
                share_low: found.share_low,
            }),
        });
        Ok(())
    }

    /// Changes what people have said of the home; nothing else comes here.
    pub(super) fn change_home(
        &mut self,
        now_us: u64,
        (asker, body): (Asker, RequestBody),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        match body {
            RequestBody::AddNoGo { shape, name } => {
                let name = name.as_deref().map(to_name).transpose()?;
                let no_go = to_no_go(&shape)?.with_name(name);
                self.add_no_go(now_us, (asker, no_go), outputs)
            }
            RequestBody::NameNoGo { number, name } => {
                self.name_no_go(now_us, (asker, number, name.as_deref()), outputs)
            }
            RequestBody::ReshapeNoGo { number, shape } => {
                let no_go = to_no_go(&shape)?;
                self.reshape_no_go(now_us, (asker, number, no_go), outputs)
            }
            RequestBody::RemoveNoGo { number } => self.remove_no_go(now_us, (asker, number), outputs),
            RequestBody::NameRoom(naming) => self.name_room(now_us, (asker, &naming), outputs),
            RequestBody::SetRoom { room, settings } => {
                self.set_room(now_us, (asker, (room, settings)), outputs)
            }
            RequestBody::SplitRoom(splitting) => self.split_room(now_us, (asker, &splitting), outputs),
            RequestBody::JoinRooms { rooms } => self.join_rooms(now_us, (asker, rooms), outputs),
            RequestBody::UndoRoomChange { number } => self.undo_room_change(now_us, (asker, number), outputs),
            RequestBody::MoveDock { x, y, heading } => {
                let pose = Pose2 {
                    x_m: x,
                    y_m: y,
                    heading_rad: heading,
                };
                self.move_dock(now_us, (asker, pose), outputs)
            }
            _ => Ok(()),
        }
    }

    fn add_no_go(
        &mut self,
        now_us: u64,
        (asker, no_go): (Asker, NoGo),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let brain = self.known_home()?.brain();
        let command = Command::AddNoGo { no_go };
        brain
            .admit(&command)
            .map_err(|reason| of_forbidden(reason, brain))?;
        self.edit(now_us, (asker, command, "forbids floor of the map"), outputs);
        Ok(())
    }

    fn reshape_no_go(
        &mut self,
        now_us: u64,
        (asker, number, no_go): (Asker, u16, NoGo),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let brain = self.known_home()?.brain();
        let command = Command::ReshapeNoGo { number, no_go };
        brain.admit(&command).map_err(|reason| match reason {
            Reason::NoSuchNoGo => Refusal::because(reason, no_such_no_go(number, brain)),
            _ => of_forbidden(reason, brain),
        })?;
        self.edit(now_us, (asker, command, "reshapes forbidden floor"), outputs);
        Ok(())
    }

    fn remove_no_go(
        &mut self,
        now_us: u64,
        (asker, number): (Asker, u16),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let brain = self.known_home()?.brain();
        let command = Command::RemoveNoGo { number };
        brain
            .admit(&command)
            .map_err(|reason| Refusal::because(reason, no_such_no_go(number, brain)))?;
        self.edit(now_us, (asker, command, "allows floor of the map again"), outputs);
        Ok(())
    }

    fn name_no_go(
        &mut self,
        now_us: u64,
        (asker, number, name): (Asker, u16, Option<&str>),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let name = name.map(to_name).transpose()?;
        let brain = self.known_home()?.brain();
        let command = Command::NameNoGo { number, name };
        brain.admit(&command).map_err(|reason| match reason {
            Reason::NameTaken => another_no_go(),
            _ => Refusal::because(reason, no_such_no_go(number, brain)),
        })?;
        self.edit(now_us, (asker, command, "names forbidden floor"), outputs);
        Ok(())
    }

    fn name_room(
        &mut self,
        now_us: u64,
        (asker, naming): (Asker, &RoomNaming),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let room = naming.room;
        let name = naming.name.as_deref().map(to_name).transpose()?;
        let brain = self.known_home()?.brain();
        let command = Command::NameRoom { room, name };
        brain.admit(&command).map_err(|reason| match reason {
            Reason::NoSuchRoom => Refusal::no_such_room(room, brain),
            Reason::NameTaken => {
                Refusal::because(reason, "Another room is called so: take another name.".to_owned())
            }
            _ => Refusal::from(reason),
        })?;
        self.edit(now_us, (asker, command, "names a room"), outputs);
        Ok(())
    }

    /// The brain, in the home that is kept.
    pub(super) fn known_home(&self) -> Result<&Mind, Refusal> {
        let mind = self.mind.as_ref().ok_or("no-robot")?;
        mind.admit_edit()?;
        Ok(mind)
    }

    /// Gives the brain a change of the map; whoever wants it hears of it when it is on the disk.
    pub(super) fn edit(
        &mut self,
        now_us: u64,
        (asker, command, what): (Asker, Command, &'static str),
        outputs: &mut Outputs,
    ) {
        let text = format!("{} {what}", self.clients.name(asker.0));
        self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
        self.command_brain(now_us, command, outputs);
        self.edits.push(asker);
    }

    /// After the step in which the brain took them up: the map goes to the disk with all changes.
    pub(super) fn keep_edits(&mut self, outputs: &mut Outputs) {
        if self.edits.is_empty() || self.commands_wait {
            return;
        }
        self.feed.tell_home_now();
        let home = self.mind.as_ref().and_then(Mind::home_to_keep);
        if let Some(kept) = &home {
            self.floors.take_home(kept.floor, &kept.home);
        }
        for (client, id) in self.edits.drain(..) {
            match &home {
                Some(home) => outputs.map_edits.push(MapEdit {
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

/// An order whose places are zones and spots by now.
pub(crate) fn to_order(order: &JobOrder) -> Result<CleaningOrder, Refusal> {
    let part = |(place, part): (usize, &JobPart)| match part {
        JobPart::Room(id) => Ok(HomePart::Room(*id)),
        JobPart::Zone(corners) => to_zone(&format!("Part {}", place + 1), corners).map(HomePart::Zone),
        JobPart::Spot([x_m, y_m]) => Ok(HomePart::Spot(Point2 { x_m: *x_m, y_m: *y_m })),
        JobPart::Place(_) => Err(Reason::NoSuchPlace.into()),
    };
    let parts: Result<Vec<HomePart>, Refusal> = order.parts.iter().enumerate().map(part).collect();
    let whole = CleaningOrder::new(parts?, order.passes).map_err(|reason| {
        let text = format!(
            "{} parts and {} passes were ordered: a job has up to 32 parts and 1 to 3 passes.",
            order.parts.len(),
            order.passes
        );
        Refusal::because(reason, text)
    })?;
    let avoid: Result<Vec<NoGo>, Refusal> = order.avoid.iter().map(to_no_go).collect();
    let whole = whole.avoiding(avoid?).map_err(|reason| {
        let text = format!(
            "{} places are to be avoided: a job keeps out of up to 16.",
            order.avoid.len()
        );
        Refusal::because(reason, text)
    })?;
    with_settings(whole, order)
}

/// An order with what it says of how it is carried out.
fn with_settings(whole: CleaningOrder, order: &JobOrder) -> Result<CleaningOrder, Refusal> {
    let whole = match order.pattern {
        Some(pattern) => whole.with_pattern(to_pattern(pattern)),
        None => whole,
    };
    match &order.power {
        Some(power) => Ok(whole.with_power(to_power(power)?)?),
        None => Ok(whole),
    }
}

pub(super) fn to_zone(what: &str, corners: &[[f64; 2]]) -> Result<Zone, Refusal> {
    let points = corners.iter().map(|&[x_m, y_m]| Point2 { x_m, y_m });
    Zone::new(points.collect()).map_err(|reason| {
        let far = corners
            .iter()
            .find(|[x, y]| !(x.abs() < FAR_M && y.abs() < FAR_M));
        let text = match far {
            Some([x, y]) => {
                format!("{what} has a corner at x {x} m, y {y} m: they must lie within {FAR_M} m.")
            }
            None => format!(
                "{what} is a zone with {} corners: it must have 3 to 64.",
                corners.len()
            ),
        };
        Refusal::because(reason, text)
    })
}

pub(crate) fn to_no_go(shape: &NoGoShape) -> Result<NoGo, Refusal> {
    match shape {
        NoGoShape::Zone(corners) => Ok(NoGo::zone(&to_zone("The no-go zone", corners)?)?),
        NoGoShape::Wall([[x, y], [to_x, to_y]]) => {
            let (from, to) = (
                Point2 { x_m: *x, y_m: *y },
                Point2 {
                    x_m: *to_x,
                    y_m: *to_y,
                },
            );
            NoGo::wall(from, to).map_err(|reason| {
                let text = format!(
                    "The virtual wall from x {x} m, y {y} m to x {to_x} m, y {to_y} m cannot be: its ends must be two \
                     places within {FAR_M} m."
                );
                Refusal::because(reason, text)
            })
        }
    }
}

pub(super) fn to_name(text: &str) -> Result<RoomName, Refusal> {
    RoomName::new(text).map_err(|reason| {
        let text = format!(
            "The name has {} characters: it must be one line of 1 to 40.",
            text.trim().chars().count()
        );
        Refusal::because(reason, text)
    })
}

/// Why floor is not forbidden.
fn of_forbidden(reason: Reason, brain: &brain::Brain) -> Refusal {
    match reason {
        Reason::NoFloorThere => Refusal::no_floor_there("in it", brain),
        Reason::DockInside => Refusal::because(reason, dock_inside(brain)),
        Reason::NameTaken => another_no_go(),
        _ => Refusal::from(reason),
    }
}

fn dock_inside(brain: &brain::Brain) -> String {
    let place = brain.map().dock().unwrap_or_default();
    format!(
        "The dock stands there (x {:.2} m, y {:.2} m), and the robot could not reach it any more: leave room around it.",
        place.x_m, place.y_m
    )
}

fn another_no_go() -> Refusal {
    let text = "Another no-go zone or virtual wall is called so: take another name.";
    Refusal::because(Reason::NameTaken, text.to_owned())
}

fn no_such_no_go(number: u16, brain: &brain::Brain) -> String {
    let numbers: Vec<String> = brain
        .map()
        .annotations()
        .no_go()
        .map(|(number, _)| number.to_string())
        .collect();
    if numbers.is_empty() {
        return format!("There is no no-go zone {number}: the map has none.");
    }
    format!(
        "There is no no-go zone {number}: the map has {}.",
        numbers.join(", ")
    )
}
