//! A robot on its dock in a large known home, the daemon, and two servers before it.

use anyhow::bail;
use std::time::{Duration, Instant};

use brain::{Cell, CellKnowledge, Pose2, Raster, StoredMap};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, Daemon, Scratch, SyntheticRobot, needed_beside};

use crate::door::Door;
use crate::peer::{Asker, Peer};

/// Side of the home in cells of 2.5 cm: 400 square metres.
const SIDE_CELLS: usize = 800;
/// Cells between two walls.
const ROOM_CELLS: usize = 160;
/// Cells of a wall that are left open.
const DOOR_CELLS: usize = 40;

/// All of it; gone when it is dropped.
pub(crate) struct Stage {
    pub(crate) robot: SyntheticRobot,
    plain: Door,
    guarded: Door,
    _daemon: Daemon,
    scratch: Scratch,
}

/// A route from a client to the robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Route {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    /// Of the server on the route.
    pub(crate) process: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The daemon's own socket.
    Direct,
    /// The server for this computer.
    Plain,
    /// The server for paired devices.
    Guarded,
}

impl Stage {
    pub(crate) fn set() -> anyhow::Result<Self> {
        let scratch = Scratch::new()?;
        let maps = scratch.join("state/maps");
        std::fs::create_dir_all(&maps)?;
        std::fs::write(maps.join("000001.map"), home())?;
        let mut robot = SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::NONE, 1)?;
        robot.dock();
        let vthal = needed_beside("vthal")?;
        let daemon = Daemon::start(&vthal, &scratch, &["--seed", "1"])?;
        let deadline = Instant::now() + Duration::from_secs(20);
        if !robot.live_until(deadline, SyntheticRobot::is_sealed)? {
            bail!("the daemon opened no session");
        }
        let (plain, guarded) = (Door::start(&scratch, false)?, Door::start(&scratch, true)?);
        // The map is loaded while the robot reports that it is on its dock.
        robot.live_until(Instant::now() + Duration::from_secs(3), |_| false)?;
        Ok(Self {
            robot,
            plain,
            guarded,
            _daemon: daemon,
            scratch,
        })
    }

    pub(crate) fn routes(&self) -> [Route; 3] {
        let route = |name, kind, door: Option<&Door>| Route {
            name,
            kind,
            process: door.map(Door::id),
        };
        [
            route("vthal", Kind::Direct, None),
            route("panel", Kind::Plain, Some(&self.plain)),
            route("panel, TLS", Kind::Guarded, Some(&self.guarded)),
        ]
    }

    fn door(&self, kind: Kind) -> Option<&Door> {
        match kind {
            Kind::Direct => None,
            Kind::Plain => Some(&self.plain),
            Kind::Guarded => Some(&self.guarded),
        }
    }

    /// A new client.
    pub(crate) fn peer(&self, kind: Kind) -> anyhow::Result<Peer> {
        Ok(match self.door(kind) {
            None => Peer::Direct(Client::connect(&self.scratch.join("vthal.sock"))?),
            Some(door) => Peer::Socket(Box::new(door.open_socket()?)),
        })
    }

    /// Someone who asks the server, or the daemon where there is no server.
    pub(crate) fn asker(&self, kind: Kind) -> anyhow::Result<Asker> {
        Ok(match self.door(kind) {
            None => Asker::Daemon(self.peer(kind)?),
            Some(door) => Asker::Server {
                stream: door.connect()?,
                headers: door.headers(),
            },
        })
    }
}

/// Rooms in rows and columns, each with a door to its neighbours, and the dock in one of them.
fn home() -> Vec<u8> {
    let corner = Cell { x: -40, y: -40 };
    let mut floor = Raster::filled(corner, SIDE_CELLS, SIDE_CELLS, CellKnowledge::Free);
    for (index, cell) in floor.values_mut().iter_mut().enumerate() {
        let [along, across] = [index % SIDE_CELLS, index / SIDE_CELLS].map(|at| at % ROOM_CELLS);
        let is_wall = (along == 0 && across >= DOOR_CELLS) || (across == 0 && along >= DOOR_CELLS);
        if is_wall {
            *cell = CellKnowledge::Occupied;
        }
    }
    vthal_core::stored_map::encode(&StoredMap::from_raster(&floor, Some(Pose2::IDENTITY)))
}
