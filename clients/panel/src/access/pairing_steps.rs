//! The steps by which a device proves the code.

use leptos::prelude::window;
use pairing::wire::{Begin, Begun, Finish, Finished, Invitation};
use pairing::{Code, DeviceName, Ends, Guest};

use super::http::{self, Failed};

/// Proves the code; from then on the browser has a cookie that no script can read.
///
/// # Errors
/// A sentence for the person who typed it.
pub(super) async fn pair(name: &str, code: &str) -> Result<(), String> {
    let name = DeviceName::new(name).map_err(|error| error.to_string())?;
    let code = Code::parse(code).map_err(|error| error.to_string())?;
    let random = random().ok_or("This browser gives no random numbers: try a newer one.")?;
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
    let (waiting, proof) = guest.hear(&begun.message).map_err(|error| error.to_string())?;
    let finish = Finish {
        attempt: begun.attempt,
        proof,
    };
    let finished: Finished = ask("/api/pairing/finish", &finish).await?;
    if waiting.is_proven(&finished.proof) {
        return Ok(());
    }
    Err(
        "The answer is not that of the robot whose code this is: somebody may stand between. Do not go on."
            .to_owned(),
    )
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
