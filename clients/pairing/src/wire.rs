//! What browsers and the server say to each other about being let in; JSON over HTTPS.

use serde::{Deserialize, Serialize};

use crate::exchange::{MESSAGE, PROOF};
use crate::{DeviceName, Paired, Pattern, Role, TokenId, hex};

/// `GET /api/pairing`: whether anybody can be let in now, and by whom.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Invitation {
    /// Whether a window is open.
    pub open: bool,
    /// Whether it is one for presses of the robot's button, in which codes count for nothing.
    #[serde(default)]
    pub presses: bool,
    /// The robot's full number, which goes into the proof.
    pub robot: String,
    /// Why the robot has no paired devices any more, until an administrator is paired.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub forgotten: Option<Forgotten>,
}

/// By what all devices were forgotten.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Forgotten {
    /// START and DOCK were held.
    Buttons,
    /// There was a file on the card that the robot's computer starts from.
    File,
    /// The owner said so at the console.
    Console,
}

/// `POST /api/pairing/begin`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Begin {
    /// How the device shall be called.
    pub name: DeviceName,
    /// The guest's message.
    #[serde(with = "hex")]
    pub message: [u8; MESSAGE],
}

/// Its answer.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Begun {
    /// Names this attempt.
    #[serde(with = "hex")]
    pub attempt: [u8; 16],
    /// The robot's message.
    #[serde(with = "hex")]
    pub message: [u8; MESSAGE],
}

/// `POST /api/pairing/finish`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Finish {
    /// Which attempt.
    #[serde(with = "hex")]
    pub attempt: [u8; 16],
    /// The guest's proof.
    #[serde(with = "hex")]
    pub proof: [u8; PROOF],
}

/// Its answer; the token comes as a cookie that no script can read.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Finished {
    /// The robot's proof.
    #[serde(with = "hex")]
    pub proof: [u8; PROOF],
    /// What the device may do.
    pub role: Role,
}

/// `POST /api/pairing/match`: the device asks to be paired by presses.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Join {
    /// How it shall be called.
    pub name: DeviceName,
}

/// Its answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Joined {
    /// Names the device until it is paired. Whoever has it is paired in its place.
    #[serde(with = "hex")]
    pub session: [u8; 16],
    /// How often START is to be pressed before and after the pause.
    pub presses: Pattern,
}

/// `POST /api/pairing/matched`: whether its presses came.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AskMatched {
    /// As [`Joined::session`].
    #[serde(with = "hex")]
    pub session: [u8; 16],
}

/// Its answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Matched {
    /// What the device may do, once it is let in; then its token comes as a cookie.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<Role>,
}

/// `GET /api/session`: who the asking client is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Session {
    /// What it may do.
    pub role: Role,
    /// Its number; none on the robot's own computer, where no pairing is needed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub client: Option<TokenId>,
    /// To be sent first on the WebSocket, once; none where no pairing is needed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nonce: Option<String>,
}

/// The first message on a WebSocket.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Greeting {
    /// As [`Session::nonce`].
    pub nonce: String,
}

/// A client as lists show it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClientRow {
    /// Its number.
    pub id: TokenId,
    /// What its owner calls it.
    pub name: DeviceName,
    /// What it may do.
    pub role: Role,
    /// When it was let in, seconds since 1970.
    pub since_s: u64,
}

impl From<&Paired> for ClientRow {
    fn from(client: &Paired) -> Self {
        Self {
            id: client.id,
            name: client.name.clone(),
            role: client.role,
            since_s: client.since_s,
        }
    }
}

/// `POST /api/clients/revoke`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Revoke {
    /// Whom.
    pub id: TokenId,
}

/// `POST /api/clients/role`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct SetRole {
    /// Whose.
    pub id: TokenId,
    /// Which.
    pub role: Role,
}

/// `POST /api/pairing/open`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct OpenWindow {
    /// What the new device may do.
    pub role: Role,
}

/// The window that was opened.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Opened {
    /// The code, in two groups of digits.
    pub code: String,
    /// How long it holds, seconds.
    pub seconds: u32,
}

/// The answer of the server, which has its own address.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OpenedHere {
    /// Code and time.
    #[serde(flatten)]
    pub opened: Opened,
    /// Where devices find the robot.
    pub addresses: Vec<String>,
}

impl OpenedHere {
    /// The address for a camera: one that phones find without resolving the robot's name.
    #[must_use]
    pub fn to_scan(&self) -> Option<&str> {
        self.addresses.iter().map(String::as_str).find(|address| {
            let host = address.trim_start_matches("https://");
            host.starts_with(|first: char| first == '[' || first.is_ascii_digit())
        })
    }
}

/// Why something was refused.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refused {
    /// One word for programs.
    pub reason: String,
    /// A sentence for people.
    pub text: String,
}
