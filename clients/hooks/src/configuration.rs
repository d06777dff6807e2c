//! What the owner says: `/etc/rvac-hooks.toml`.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;

use bridge::dial::HttpPlace;
use bridge::service::ConfigurationError;
use serde::Deserialize;

use crate::watcher::Occasion;

/// The file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Configuration {
    /// Unix socket of the daemon.
    #[serde(default = "usual_vthal")]
    pub(crate) vthal: PathBuf,
    /// What people call the robot.
    #[serde(default = "usual_name")]
    pub(crate) name: String,
    /// Where the calendar is served; absent = nowhere.
    #[serde(default)]
    pub(crate) calendar: Option<CalendarPlace>,
    /// Who is told.
    #[serde(default)]
    pub(crate) target: Vec<Target>,
}

/// Where the calendar is served.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CalendarPlace {
    /// Address to listen on.
    #[serde(default = "loopback")]
    pub(crate) bind: IpAddr,
    /// Port to listen on; 0 takes any free one.
    #[serde(default = "usual_port")]
    pub(crate) port: u16,
}

/// Who is told, and when.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Target {
    /// How.
    #[serde(flatten)]
    pub(crate) route: Route,
    /// Of what; absent = of everything.
    #[serde(default = "everything")]
    pub(crate) when: Vec<Occasion>,
}

/// How somebody is told.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Route {
    /// A topic of an ntfy server.
    Ntfy {
        /// Address of the topic.
        url: String,
        /// Access token, if the topic wants one.
        #[serde(default)]
        token: Option<String>,
    },
    /// Any server that takes JSON.
    Webhook {
        /// Its address.
        url: String,
    },
    /// A mail, by the program that this computer has for it.
    Mail {
        /// To whom.
        to: String,
        /// The program.
        #[serde(default = "usual_sendmail")]
        sendmail: PathBuf,
    },
}

fn usual_vthal() -> PathBuf {
    "/run/vthal/vthal.sock".into()
}

fn usual_name() -> String {
    "The robot".to_owned()
}

fn usual_port() -> u16 {
    9780
}

fn usual_sendmail() -> PathBuf {
    "/usr/sbin/sendmail".into()
}

const fn loopback() -> IpAddr {
    IpAddr::V4(Ipv4Addr::LOCALHOST)
}

fn everything() -> Vec<Occasion> {
    Occasion::ALL.to_vec()
}

impl Configuration {
    /// Checks what a file of the right form may still say wrong.
    pub(crate) fn check(&self) -> Result<(), ConfigurationError> {
        let is_line =
            |text: &str| !text.is_empty() && text.len() <= 200 && !text.chars().any(char::is_control);
        if !is_line(&self.name) {
            return Err(ConfigurationError::Unfit("name must be one line".to_owned()));
        }
        for target in &self.target {
            let fits = match &target.route {
                Route::Ntfy { url, token } => {
                    HttpPlace::read(url).is_some() && token.as_deref().is_none_or(is_line)
                }
                Route::Webhook { url } => HttpPlace::read(url).is_some(),
                Route::Mail { to, .. } => is_line(to) && to.contains('@') && !to.starts_with('-'),
            };
            if !fits {
                let text = format!("this target cannot be: {:?}", target.route);
                return Err(ConfigurationError::Unfit(text));
            }
        }
        Ok(())
    }
}
