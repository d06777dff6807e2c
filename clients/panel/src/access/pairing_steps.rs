//! The steps by which a device proves the code.

use js_sys::Promise;
use leptos::prelude::window;
use pairing::wire::{AskMatched, Begin, Begun, Finish, Finished, Invitation, Join, Joined, Matched};
use pairing::{Code, DeviceName, Ends, Guest, NameError};
use wasm_bindgen::JsValue;
use wasm_bindgen_futures::JsFuture;

use crate::http::{self, Failed};

use crate::language::words;

/// While presses are waited for, the robot is asked this often.
const ASK_EVERY_MS: i32 = 500;

/// Proves the code; from then on the browser has a cookie that no script can read.
///
/// # Errors
/// A sentence for the person who typed it.
pub(super) async fn pair(name: &str, code: &str) -> Result<(), String> {
    let name = DeviceName::new(name).map_err(name_problem)?;
    let code = Code::parse(code).map_err(|_| words().access.bad_code.to_owned())?;
    let random = random().ok_or(words().access.no_random)?;
    let invitation: Invitation = http::get("/api/pairing").await.map_err(|failed| failed.text())?;
    let ends = Ends {
        guest: &name,
        robot: &invitation.robot,
    };
    let (guest, message) = Guest::begin(&code, ends, random);
    let begin = Begin {
        name: name.clone(),
        message,
    };
    let begun: Begun = ask("/api/pairing/begin", &begin).await?;
    let (waiting, proof) = guest
        .hear(&begun.message)
        .map_err(|_| words().access.malformed.to_owned())?;
    let finish = Finish {
        attempt: begun.attempt,
        proof,
    };
    let finished: Finished = ask("/api/pairing/finish", &finish).await?;
    if waiting.is_proven(&finished.proof) {
        return Ok(());
    }
    Err(words().access.impostor.to_owned())
}

/// Whether and how a device can be let in now, if the robot can be asked.
pub(super) async fn invitation() -> Option<Invitation> {
    http::get("/api/pairing").await.ok()
}

/// Asks for presses.
///
/// # Errors
/// As of [`pair`].
pub(super) async fn join(name: &str) -> Result<Joined, String> {
    let name = DeviceName::new(name).map_err(name_problem)?;
    ask("/api/pairing/match", &Join { name }).await
}

/// Waits until the presses came; from then on the browser has a cookie that no script can read.
///
/// # Errors
/// As of [`pair`].
pub(super) async fn wait_for_presses(joined: &Joined) -> Result<(), String> {
    let session = joined.session;
    loop {
        let matched: Matched = ask("/api/pairing/matched", &AskMatched { session }).await?;
        if matched.role.is_some() {
            return Ok(());
        }
        pause(ASK_EVERY_MS).await;
    }
}

async fn pause(ms: i32) {
    let over = Promise::new(&mut |over, _| {
        let timer = window().set_timeout_with_callback_and_timeout_and_arguments_0(&over, ms);
        // A page that gets no timer asks again at once.
        if timer.is_err() {
            over.call0(&JsValue::NULL).ok();
        }
    });
    JsFuture::from(over).await.ok();
}

fn name_problem(error: NameError) -> String {
    let texts = &words().access;
    match error {
        NameError::Empty => texts.name_empty,
        NameError::Long => texts.name_long,
        NameError::Control => texts.name_control,
    }
    .to_owned()
}

async fn ask<T: serde::de::DeserializeOwned>(path: &str, body: &impl serde::Serialize) -> Result<T, String> {
    http::post(path, body)
        .await
        .map_err(|failed: Failed| failed.text())
}

fn random() -> Option<[u8; 64]> {
    let mut bytes = [0; 64];
    window()
        .crypto()
        .ok()?
        .get_random_values_with_u8_array(&mut bytes)
        .ok()?;
    Some(bytes)
}
