//! A robot on its dock in a large known home, the daemon, and two servers before it.

use anyhow::bail;
use std::time::{Duration, Instant};

use panel_bench::{Door, PATIENCE, keep_large_home};
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, Daemon, Scratch, SyntheticRobot, needed_beside};

use crate::peer::{Asker, LOOK, Peer};

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
        keep_large_home(&scratch)?;
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
            Some(door) => {
                let (socket, line) = door.open_socket(&door.owner(), PATIENCE)?;
                line.set_read_timeout(Some(LOOK))?;
                Peer::Socket(Box::new(socket))
            }
        })
    }

    /// Someone who asks the server, or the daemon where there is no server.
    pub(crate) fn asker(&self, kind: Kind) -> anyhow::Result<Asker> {
        Ok(match self.door(kind) {
            None => Asker::Daemon(self.peer(kind)?),
            Some(door) => Asker::Server {
                stream: door.connect(&door.owner())?,
                headers: door.headers(&door.owner()),
            },
        })
    }
}
