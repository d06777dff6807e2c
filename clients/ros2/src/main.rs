//! `rvac-ros2`: the robot as a node of ROS 2, without an installation of ROS.
#![forbid(unsafe_code)]

mod action;
mod convert;
mod docking;
mod frames;
mod messages;
mod node;
mod order;
mod place;
mod relay;
mod velocity;

use std::io::Write as _;
use std::net::IpAddr;
use std::path::PathBuf;
use std::process::ExitCode;

use bridge::service::{self, ConfigurationError};
use clap::Parser;
use node::{Middleware, Site};

/// Joins the robot to a domain of ROS 2.
#[derive(Debug, Parser)]
#[command(version)]
struct Arguments {
    /// Unix socket of vthal
    #[arg(long, value_name = "SOCKET", default_value = "/run/vthal/vthal.sock")]
    vthal: PathBuf,
    /// Domain to join
    #[arg(long, env = "ROS_DOMAIN_ID", value_name = "NUMBER", default_value_t = 0,
          value_parser = clap::value_parser!(u16).range(0..=232))]
    domain: u16,
    /// Namespace of the robot's topics and services, for homes with several robots, for example /kitchen
    #[arg(long, value_name = "NAME", default_value = "/")]
    namespace: String,
    /// Put before the names of the frames map, odom and base_link, for homes with several robots, for example kitchen/
    #[arg(long, value_name = "PREFIX", default_value = "")]
    frame_prefix: String,
    /// Address of a network to use; may be given several times; all when none is given
    #[arg(long = "network", value_name = "ADDRESS")]
    networks: Vec<IpAddr>,
    /// Implementation of DDS by which the others call services
    #[arg(long, value_enum, default_value_t = Middleware::Fast)]
    middleware: Middleware,
    /// Brushes and suction run while the robot is driven by /cmd_vel
    #[arg(long)]
    clean: bool,
}

fn main() -> ExitCode {
    service::start("rvac-ros2", run)
}

async fn run(arguments: Arguments) -> anyhow::Result<()> {
    let site = Site {
        domain: arguments.domain,
        namespace: arguments.namespace,
        networks: arguments.networks,
        middleware: arguments.middleware,
    };
    let robot = node::join(&site).map_err(|error| ConfigurationError::Unfit(format!("{error:#}")))?;
    writeln!(std::io::stdout(), "ready in domain {}", site.domain)?;
    service::tell_ready();
    relay::run(
        robot,
        &arguments.vthal,
        relay::Wishes {
            frame_prefix: arguments.frame_prefix,
            clean: arguments.clean,
        },
    )
    .await
}
