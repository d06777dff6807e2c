//! Two networks with a cable between them: the robot's and the home's.

use std::path::Path;
use std::process::Command;

use crate::program::output;

/// Both networks; gone when it is dropped.
#[derive(Debug)]
pub(crate) struct Link {
    robot: String,
    home: String,
}

impl Link {
    pub(crate) fn lay() -> anyhow::Result<Self> {
        let process = std::process::id();
        let link = Self {
            robot: format!("rvac-{process}-r"),
            home: format!("rvac-{process}-h"),
        };
        let ends = [(&link.robot, "10.77.0.1/24"), (&link.home, "10.77.0.2/24")];
        for (network, _) in ends {
            ip(&["netns", "add", network])?;
        }
        let (robot, home) = (link.robot.as_str(), link.home.as_str());
        ip(&[
            "-n", robot, "link", "add", "wlan0", "type", "veth", "peer", "name", "wlan0", "netns", home,
        ])?;
        for (network, address) in ends {
            // Nobody else is on the cable who could have the address already.
            std_output(
                Command::new("ip").args(["netns", "exec", network, "sysctl", "-qw"]),
                "net.ipv6.conf.all.accept_dad=0 net.ipv6.conf.wlan0.accept_dad=0",
            )?;
            ip(&["-n", network, "address", "add", address, "dev", "wlan0"])?;
            ip(&["-n", network, "link", "set", "lo", "up"])?;
            ip(&["-n", network, "link", "set", "wlan0", "up"])?;
            ip(&["-n", network, "route", "add", "224.0.0.0/4", "dev", "wlan0"])?;
        }
        Ok(link)
    }

    /// A program on the robot's side.
    pub(crate) fn on_robot(&self, program: &Path) -> Command {
        within(&self.robot, program)
    }

    /// A program on the home's side.
    pub(crate) fn at_home(&self, program: &Path) -> Command {
        within(&self.home, program)
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        for network in [&self.robot, &self.home] {
            // It may never have been made.
            ip(&["netns", "delete", network]).ok();
        }
    }
}

fn within(network: &str, program: &Path) -> Command {
    let mut command = Command::new("ip");
    command.args(["netns", "exec", network]).arg(program);
    command
}

fn ip(words: &[&str]) -> anyhow::Result<()> {
    output(Command::new("ip").args(words)).map(drop)
}

fn std_output(command: &mut Command, words: &str) -> anyhow::Result<()> {
    output(command.args(words.split(' '))).map(drop)
}
