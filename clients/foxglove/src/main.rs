//! `rvac-foxglove`: the robot live in Foxglove.
#![forbid(unsafe_code)]

mod channels;
mod draw;

use std::io::Write as _;
use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use bridge::service::{self, ConfigurationError};
use bridge::{Change, Daemon, Knowledge, News};
use channels::Channels;
use clap::Parser;
use foxglove::messages::Timestamp;
use foxglove::{Context, WebSocketServer};
use rvac_api::{PlannedPath, Topic, Update};
use tokio::time::{MissedTickBehavior, interval};

const TOPICS: [Topic; 6] = [
    Topic::Status,
    Topic::Pose,
    Topic::Device,
    Topic::Home,
    Topic::PlannedPath,
    Topic::Log,
];
/// What seldom changes is said again so often, for those who began to look later.
const AGAIN: Duration = Duration::from_secs(2);

/// Serves the robot live to Foxglove.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Unix socket of vthal
    #[arg(long, value_name = "SOCKET", default_value = "/run/vthal/vthal.sock")]
    vthal: PathBuf,
    /// Address to listen on; whoever reaches it sees the home and where the robot is
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// Port to listen on; 0 takes any free one
    #[arg(long, default_value_t = 8765)]
    port: u16,
}

fn main() -> ExitCode {
    service::start("rvac-foxglove", run)
}

async fn run(arguments: Arguments) -> anyhow::Result<()> {
    let context = Context::new();
    let channels = Channels::open(&context)?;
    let server = WebSocketServer::new()
        .name("LibreRVAC")
        .bind(arguments.bind.to_string(), arguments.port)
        .context(&context)
        .tokio_runtime(&tokio::runtime::Handle::current())
        .start()
        .await
        .map_err(|error| {
            ConfigurationError::Unfit(format!(
                "cannot listen on {} port {}: {error}; choose another --bind or --port",
                arguments.bind, arguments.port
            ))
        })?;
    writeln!(
        std::io::stdout(),
        "ready ws://{}:{}",
        arguments.bind,
        server.port()
    )?;
    service::tell_ready();
    let mut relay = Relay {
        channels,
        known: Knowledge::default(),
        plan: PlannedPath::default(),
    };
    relay.follow(&arguments.vthal).await;
    Ok(())
}

struct Relay {
    channels: Channels,
    known: Knowledge,
    plan: PlannedPath,
}

impl Relay {
    async fn follow(&mut self, socket: &Path) {
        let mut daemon = Daemon::new(socket.to_owned(), "rvac-foxglove", &TOPICS);
        let mut again = interval(AGAIN);
        again.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                news = daemon.next() => match news {
                    News::Connected => {}
                    News::Lost => self.known.forget_state(),
                    News::Update(update) => {
                        self.take(&update);
                        if self.known.wants_hello() {
                            // A daemon that is away says it when it is there again.
                            daemon.hello().await.ok();
                        }
                    }
                },
                _ = again.tick() => self.say_again(),
            }
        }
    }

    fn take(&mut self, update: &Update) {
        match update {
            Update::Log(entry) => self.channels.log.log(&draw::line(entry, Timestamp::now())),
            Update::PlannedPath(path) => {
                self.plan = path.clone();
                self.tell_plan();
            }
            _ => {}
        }
        match self.known.take(update) {
            Change::Pose => self.tell_pose(),
            Change::Home => self.tell_map(),
            Change::Robot => self.tell_robot(),
            Change::Status => self.tell_status(),
            Change::Device => self.tell_device(),
            _ => {}
        }
    }

    fn say_again(&self) {
        self.tell_robot();
        self.tell_map();
        self.tell_plan();
        self.tell_status();
        self.tell_pose();
    }

    fn tell_pose(&self) {
        // On the dock it tells no pose, and stands where the dock does.
        if let Some(pose) = self.known.place() {
            let now = Timestamp::now();
            self.channels.pose.log(&draw::pose(pose, now));
            self.channels.transform.log(&draw::transform(pose, now));
        }
    }

    fn tell_map(&self) {
        if let Some(home) = self.known.home.as_ref().filter(|_| self.channels.map.has_sinks()) {
            self.channels.map.log(&draw::map(home, Timestamp::now()));
        }
    }

    fn tell_robot(&self) {
        if let Some(robot) = &self.known.robot {
            self.channels.robot.log(&draw::robot(robot, Timestamp::now()));
        }
    }

    fn tell_plan(&self) {
        self.channels.plan.log(&draw::plan(&self.plan, Timestamp::now()));
    }

    fn tell_status(&self) {
        if let Some(status) = &self.known.status
            && let Ok(text) = serde_json::to_vec(status)
        {
            self.channels.status.log(&text);
        }
    }

    fn tell_device(&self) {
        if let Some(device) = &self.known.device
            && let Ok(text) = serde_json::to_vec(device)
        {
            self.channels.device.log(&text);
        }
    }
}
