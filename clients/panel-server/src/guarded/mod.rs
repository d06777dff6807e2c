//! The paired clients of a server: who asks, who may be paired, and what of it is on the disk.

mod console;
mod cookie;
mod nonces;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use axum::http::HeaderMap;
use pairing::wire::{
    AskMatched, Begin, Begun, Finish, Finished, Forgotten, Join, Joined, OpenWindow, Opened,
};
use pairing::{
    AskingDevice, Door, Moment, Presence, Refusal, Register, RobotId, Role, StoredError, Token, TokenId,
    Wanted,
};
use tokio::sync::{Notify, broadcast, watch};
use tracing::{error, info, warn};

pub(crate) use console::{listen as listen_console, refused, serve_console};
pub(crate) use cookie::set_cookie;
use nonces::Nonces;

/// Notices that wait for a slow relay; a home sees a few in a year.
const NOTICES_MAX: usize = 16;

/// Why the clients cannot be known.
#[derive(Debug, thiserror::Error)]
pub enum ClientsError {
    /// A newer version wrote the file.
    #[error(
        "{path} cannot be used as the list of devices ({source}): install the version that wrote it, or remove it, after which devices must pair anew"
    )]
    Newer {
        /// Which.
        path: PathBuf,
        /// Why.
        source: StoredError,
    },
    /// There is no randomness.
    #[error("the system gives no random numbers: {0}; nothing can be kept secret without")]
    Random(#[from] getrandom::Error),
}

/// Why a change was not made.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NotDone {
    #[error(transparent)]
    Refused(#[from] Refusal),
    #[error("The robot cannot write its list of devices: {0}.")]
    Disk(io::Error),
    #[error("The robot's system gives no random numbers: {0}.")]
    Random(#[from] getrandom::Error),
    #[error("The robot got no new identity: {0}.")]
    Identity(#[from] crate::identity::IdentityError),
}

/// Somebody known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Known {
    pub(crate) id: TokenId,
    pub(crate) role: Role,
}

/// A new device, as it is announced to all clients.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Newcomer {
    pub(crate) name: String,
    pub(crate) role: Role,
    pub(crate) from: String,
}

/// The clients of one robot.
#[derive(Debug)]
pub(crate) struct Guarded {
    path: PathBuf,
    began: Instant,
    door: tokio::sync::Mutex<Door>,
    register: watch::Sender<Register>,
    notices: broadcast::Sender<Newcomer>,
    nonces: Mutex<Nonces>,
    presses_wanted: Notify,
    presence: Mutex<Presence>,
}

impl Guarded {
    /// The clients as they are kept at `path`.
    pub(crate) fn at(path: &Path, robot: RobotId) -> Result<Self, ClientsError> {
        let unsound = |source| ClientsError::Newer {
            path: path.to_owned(),
            source,
        };
        // What a newer version wrote is not damaged, and stays.
        let present = kept_file::read_text(path).ok();
        let opened = present.map(|text| Door::new(0, robot.clone(), Some(&text)));
        if let Some(Err(error @ StoredError::Version(_))) = opened {
            return Err(unsound(error));
        }
        let found = kept_file::newest(path, "the list of devices", |text| {
            Door::new(0, robot.clone(), Some(text)).map_err(|error| error.to_string())
        });
        for complaint in &found.complaints {
            error!("{complaint}. Look whether the list has a device that you have removed");
        }
        let door = match found.value {
            Some(door) => door,
            None => Door::new(0, robot, None).map_err(unsound)?,
        };
        random::<8>()?;
        Ok(Self {
            path: path.to_owned(),
            began: Instant::now(),
            register: watch::Sender::new(door.register().clone()),
            door: tokio::sync::Mutex::new(door),
            notices: broadcast::Sender::new(NOTICES_MAX),
            nonces: Mutex::default(),
            presses_wanted: Notify::new(),
            presence: Mutex::default(),
        })
    }

    /// Who sends these headers, as far as the token in them is right.
    pub(crate) fn identify(&self, headers: &HeaderMap) -> Option<Known> {
        let token = cookie::token_of(headers)?;
        let register = self.register.borrow();
        let client = register.admit(&token)?;
        Some(Known {
            id: client.id,
            role: client.role,
        })
    }

    /// The clients, now and whenever they change.
    pub(crate) fn watch(&self) -> watch::Receiver<Register> {
        self.register.subscribe()
    }

    /// Everybody who is let in from now on.
    pub(crate) fn notices(&self) -> broadcast::Receiver<Newcomer> {
        self.notices.subscribe()
    }

    /// A word that opens one WebSocket of this client.
    pub(crate) fn nonce(&self, id: TokenId) -> Result<String, NotDone> {
        let random = random()?;
        Ok(self.nonces().make(self.now_us(), id, &random))
    }

    /// Whether the word was this client's; it is none any more.
    pub(crate) fn take_nonce(&self, id: TokenId, nonce: &str) -> bool {
        self.nonces().take(self.now_us(), id, nonce)
    }

    fn nonces(&self) -> std::sync::MutexGuard<'_, Nonces> {
        self.nonces.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether pairing is possible now, and the robot's number.
    pub(crate) async fn invitation(&self) -> pairing::wire::Invitation {
        let door = self.door.lock().await;
        let now_us = self.now_us();
        pairing::wire::Invitation {
            open: door.is_open(now_us),
            presses: door.is_open_for_presses(now_us),
            robot: door.robot().full().to_owned(),
            forgotten: door.forgotten(),
        }
    }

    pub(crate) async fn open(&self, wanted: OpenWindow) -> Result<Opened, NotDone> {
        let random = random()?;
        let opened = self
            .change(|door, now_us| door.open(now_us, wanted.role, random))
            .await?;
        info!(role = %wanted.role, "a window for a new device is open");
        Ok(opened)
    }

    /// Opens a window because a person holds START.
    pub(crate) async fn open_by_button(&self) -> Result<(), NotDone> {
        let random = random()?;
        self.change(|door, now_us| door.open_by_button(now_us, random))
            .await?;
        info!("a window for a new device is open, by the button");
        Ok(())
    }

    pub(crate) async fn join(&self, join: Join, from: &str) -> Result<Joined, NotDone> {
        let random = random()?;
        let joined = self
            .change(|door, now_us| {
                door.join(
                    now_us,
                    AskingDevice {
                        name: join.name,
                        from,
                    },
                    random,
                )
            })
            .await?;
        info!(from, "a device waits for its presses");
        self.presses_wanted.notify_one();
        Ok(joined)
    }

    pub(crate) async fn ask_matched(
        &self,
        asked: &AskMatched,
        from: &str,
    ) -> Result<Option<(Role, Token)>, NotDone> {
        let random = random()?;
        let outcome = self
            .change(|door, now_us| {
                let unix_s = unix_s();
                door.ask_matched(Moment { now_us, unix_s }, &asked.session, &random)
            })
            .await;
        if let Ok(Some((_, token))) = &outcome {
            self.tell(token.id(), from);
        }
        outcome
    }

    /// A device has begun to wait for its presses.
    pub(crate) async fn presses_wanted(&self) {
        self.presses_wanted.notified().await;
    }

    /// A button was pressed. A press for pairing does not prove presence for another request.
    pub(crate) async fn press(&self, is_start: bool) {
        let now_us = self.now_us();
        let mut door = self.door.lock().await;
        if door.waits_for_presses(now_us) {
            if is_start {
                door.press(now_us);
            }
        } else if let Some(id) = self.presence().press(now_us) {
            info!(%id, "a button was pressed: somebody is beside the robot");
        }
    }

    /// Judges what was pressed up to now; whether more is waited for.
    pub(crate) async fn judge_presses(&self) -> bool {
        let now_us = self.now_us();
        let mut door = self.door.lock().await;
        door.judge_presses(now_us);
        door.waits_for_presses(now_us) || self.presence().is_waited(now_us)
    }

    /// Whether the presence of a person beside the robot is proven for this client.
    pub(crate) fn is_present(&self, id: TokenId) -> bool {
        self.presence().is_proven(self.now_us(), id)
    }

    /// The next press of a button says that the person who uses this client is beside the robot.
    pub(crate) fn ask_presence(&self, id: TokenId) {
        self.presence().ask(self.now_us(), id);
        self.presses_wanted.notify_one();
    }

    /// Somebody at the console says so.
    pub(crate) fn vouch(&self, id: TokenId) -> Result<(), NotDone> {
        if self.register.borrow().get(id).is_none() {
            return Err(Refusal::NoClient.into());
        }
        self.presence().prove(self.now_us(), id);
        info!(%id, "somebody at the console vouches for the device");
        Ok(())
    }

    fn presence(&self) -> std::sync::MutexGuard<'_, Presence> {
        self.presence.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Forgets all clients: their connections end.
    pub(crate) async fn forget_all(&self, why: Forgotten) -> Result<(), NotDone> {
        self.change(|door, now_us| {
            door.forget_all(now_us, why);
            Ok(())
        })
        .await?;
        *self.presence() = Presence::default();
        // The predecessor of the file still has them: written once more, it has not either.
        let stored = self.door.lock().await.stored();
        self.write(stored).await.map_err(NotDone::Disk)?;
        warn!(?why, "all devices were forgotten");
        Ok(())
    }

    /// The robot has another identity from now on.
    pub(crate) async fn rename(&self, robot: RobotId) {
        self.door.lock().await.rename(robot);
    }

    pub(crate) async fn begin(&self, begin: Begin) -> Result<Begun, NotDone> {
        let random = random()?;
        self.change(|door, now_us| door.begin(now_us, begin, &random))
            .await
    }

    pub(crate) async fn finish(&self, finish: &Finish, from: &str) -> Result<(Finished, Token), NotDone> {
        let random = random()?;
        let outcome = self
            .change(|door, now_us| {
                let unix_s = unix_s();
                door.finish(Moment { now_us, unix_s }, finish, &random)
            })
            .await;
        match &outcome {
            Ok((_, token)) => self.tell(token.id(), from),
            Err(error) => warn!(%error, from, "a device was not let in"),
        }
        outcome
    }

    pub(crate) async fn add(&self, wanted: Wanted) -> Result<Token, NotDone> {
        let random = random()?;
        let token = self.change(|door, _| door.add(unix_s(), wanted, &random)).await?;
        self.tell(token.id(), "console");
        Ok(token)
    }

    pub(crate) async fn revoke(&self, id: TokenId) -> Result<(), NotDone> {
        self.change(|door, _| door.revoke(id)).await?;
        info!(%id, "a device was shut out");
        Ok(())
    }

    pub(crate) async fn set_role(&self, id: TokenId, role: Role) -> Result<(), NotDone> {
        self.change(|door, _| door.set_role(id, role)).await?;
        info!(%id, %role, "a device has another role");
        Ok(())
    }

    /// Tells everybody who was let in.
    fn tell(&self, id: TokenId, from: &str) {
        let register = self.register.borrow();
        let Some(client) = register.get(id) else { return };
        info!(%id, name = %client.name, role = %client.role, from, "a device was let in");
        // No client may be connected to receive it.
        self.notices
            .send(Newcomer {
                name: client.name.to_string(),
                role: client.role,
                from: from.to_owned(),
            })
            .ok();
    }

    /// Changes the door and writes what changed before anybody is informed, also after a refusal: attempts are counted so.
    async fn change<T>(&self, act: impl FnOnce(&mut Door, u64) -> Result<T, Refusal>) -> Result<T, NotDone> {
        let mut door = self.door.lock().await;
        let now_us = self.now_us();
        let before = door.stored();
        let outcome = act(&mut door, now_us);
        let after = door.stored();
        if after == before {
            // A guess that is refused must not wake the connections of all who are paired.
            return Ok(outcome?);
        }
        if let Err(error) = self.write(after).await {
            let robot = door.robot().clone();
            if let Ok(unchanged) = Door::new(now_us, robot, Some(&before)) {
                *door = unchanged;
            }
            return Err(NotDone::Disk(error));
        }
        self.register.send_replace(door.register().clone());
        Ok(outcome?)
    }

    async fn write(&self, text: String) -> io::Result<()> {
        let path = self.path.clone();
        tokio::task::spawn_blocking(move || kept_file::replace_secret(&path, text.as_bytes()))
            .await
            .map_err(io::Error::other)?
    }

    fn now_us(&self) -> u64 {
        u64::try_from(self.began.elapsed().as_micros()).unwrap_or(u64::MAX)
    }
}

/// Random bytes of the system.
fn random<const N: usize>() -> Result<[u8; N], getrandom::Error> {
    let mut bytes = [0; N];
    getrandom::fill(&mut bytes)?;
    Ok(bytes)
}

/// The system's time, seconds since 1970.
#[must_use]
pub fn unix_s() -> u64 {
    std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .map_or(0, |since| since.as_secs())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use pairing::wire::Begin;
    use pairing::{DeviceName, Door, RobotId};

    use super::{ClientsError, Guarded};

    #[tokio::test]
    async fn who_guesses_wakes_nobody_who_is_paired() {
        let folder = crate::folder::Folder::new();
        let robot = RobotId::of_public_key(b"a key");
        let guarded = Guarded::at(&folder.join("clients.json"), robot).unwrap();
        let paired = guarded.watch();
        for _ in 0..100 {
            let name = DeviceName::new("guess").unwrap();
            let begin = Begin {
                name,
                message: [7; 33],
            };
            guarded.begin(begin).await.unwrap_err();
        }
        assert!(!paired.has_changed().unwrap());
    }

    #[test]
    fn a_damaged_list_is_put_aside_for_the_one_before_and_a_newer_versions_stays() {
        let folder = std::env::temp_dir().join(format!("panel-server-guarded-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("clients.json");
        let robot = RobotId::of_public_key(b"a key");
        let whole = Door::new(0, robot.clone(), None).unwrap().stored();
        kept_file::replace(&path, whole.as_bytes()).unwrap();
        kept_file::replace(&path, b"{ zeroes").unwrap();
        Guarded::at(&path, robot.clone()).unwrap();
        let aside = fs::read(folder.join("clients.json.damaged-1")).unwrap();
        assert_eq!(aside, b"{ zeroes");
        let newer = whole.replace("\"version\": 1", "\"version\": 99");
        assert_ne!(newer, whole);
        kept_file::replace(&path, newer.as_bytes()).unwrap();
        let error = Guarded::at(&path, robot).unwrap_err();
        assert!(matches!(error, ClientsError::Newer { .. }), "{error}");
        assert!(error.to_string().contains("version 99"), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), newer);
        fs::remove_dir_all(&folder).unwrap();
    }
}
