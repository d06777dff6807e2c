//! Clients report inputs of control mixes; drivers that use them receive the reports.

use std::collections::BTreeMap;

use rvac_api::{LogLevel, Topic, Update};

use super::audience::Teller;
use super::client_inputs::{ClientInputs, InputDenied};
use super::journal::LogSource;
use super::reply::Reply;
use crate::ClientId;
use crate::refusal::Refusal;

/// The inputs that a client reports, in place of all that it reported before.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LeasedInputs {
    pub(crate) values: BTreeMap<String, f64>,
    /// How long it counts, in ms.
    pub(crate) lease_ms: u16,
}

/// The inputs of all clients.
#[derive(Debug, Default)]
pub(crate) struct InputDesk {
    inputs: ClientInputs,
}

impl InputDesk {
    /// When the next lease ends.
    pub(crate) fn lease_end_us(&self) -> Option<u64> {
        self.inputs.lease_end_us()
    }

    /// # Errors
    /// Why the client may not send this.
    pub(crate) fn take(
        &mut self,
        client: ClientId,
        inputs: LeasedInputs,
        teller: &mut Teller<'_>,
    ) -> Result<Reply, Refusal> {
        let LeasedInputs { values, lease_ms } = inputs;
        let names: Vec<String> = values.keys().cloned().collect();
        let result = self.inputs.set(teller.now_us, client, (values, lease_ms));
        if result.map_err(denied)? {
            let text = format!("{} tells the inputs {}", teller.name(client), names.join(", "));
            teller.log(LogLevel::Info, LogSource::Client, text);
        }
        Ok(Reply::Done)
    }

    /// A driver that uses this client's inputs receives them at once.
    pub(crate) fn forget(&mut self, client: ClientId, teller: &mut Teller<'_>) {
        if self.inputs.forget(client) {
            log_gone(client, teller);
        }
    }

    pub(crate) fn expire(&mut self, teller: &mut Teller<'_>) {
        for client in self.inputs.expire(teller.now_us) {
            log_gone(client, teller);
        }
    }

    /// Tells followers what is new.
    pub(crate) fn feed(&mut self, teller: &mut Teller<'_>) {
        if self.inputs.take_news() && teller.has_followers(Topic::Inputs) {
            let update = self.view(teller.now_us);
            teller.tell(Topic::Inputs, update);
        }
    }

    /// The inputs that are reported now.
    pub(crate) fn view(&self, now_us: u64) -> Update {
        Update::Inputs {
            inputs: self.inputs.view(now_us),
        }
    }
}

fn log_gone(client: ClientId, teller: &mut Teller<'_>) {
    let text = format!("the inputs of {} are gone", teller.name(client));
    teller.log(LogLevel::Info, LogSource::Client, text);
}

const fn denied(denied: InputDenied) -> &'static str {
    match denied {
        InputDenied::LeaseRange => "lease-range",
        InputDenied::Name => "input-name",
        InputDenied::Value => "input-range",
        InputDenied::TooMany => "too-many-inputs",
        InputDenied::Taken => "input-taken",
    }
}
