//! The steps by which a device proves the code.

use leptos::prelude::window;
use pairing::wire::{Begin, Begun, Finish, Finished, Invitation};
use pairing::{Code, DeviceName, Ends, Guest, NameError};

use super::http::{self, Failed};

use crate::language::words;

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

fn name_problem(error: NameError) -> String {
    let told = &words().access;
    match error {
        NameError::Empty => told.name_empty,
        NameError::Long => told.name_long,
        NameError::Control => told.name_control,
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
