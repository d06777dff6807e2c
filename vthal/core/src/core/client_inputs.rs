//! Clients tell inputs of control mixes, and those who drive by them hear of it.

use std::collections::BTreeMap;

use rvac_api::{LogLevel, Topic, Update};

use super::Core;
use super::refusal::Refusal;
use crate::client_inputs::InputDenied;
use crate::journal::Part;
use crate::outputs::{Delivery, Recipients};
use crate::{ClientId, Outputs};

impl Core {
    /// # Errors
    /// The named reason why it may not.
    pub(super) fn set_inputs(
        &mut self,
        now_us: u64,
        (client, values, lease_ms): (ClientId, BTreeMap<String, f64>, u16),
        outputs: &mut Outputs,
    ) -> Result<(), Refusal> {
        let names: Vec<String> = values.keys().cloned().collect();
        let told = self.client_inputs.tell(now_us, client, (values, lease_ms));
        if told.map_err(denied)? {
            let text = format!(
                "{} tells the inputs {}",
                self.clients.name(client),
                names.join(", ")
            );
            self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
        }
        Ok(())
    }

    /// Whoever drives by what this client told hears it in the same moment.
    pub(super) fn forget_inputs(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        if self.client_inputs.forget(client) {
            self.log_inputs_gone(now_us, client, outputs);
        }
    }

    pub(super) fn expire_inputs(&mut self, now_us: u64, outputs: &mut Outputs) {
        for client in self.client_inputs.expire(now_us) {
            self.log_inputs_gone(now_us, client, outputs);
        }
    }

    pub(super) fn feed_inputs(&mut self, now_us: u64, outputs: &mut Outputs) {
        if self.client_inputs.take_news() && self.clients.any(Topic::Inputs) {
            outputs.deliveries.push(Delivery {
                to: Recipients::Followers(Topic::Inputs),
                update: self.inputs_view(now_us),
            });
        }
    }

    pub(super) fn inputs_view(&self, now_us: u64) -> Update {
        Update::Inputs {
            inputs: self.client_inputs.view(now_us),
        }
    }

    fn log_inputs_gone(&mut self, now_us: u64, client: ClientId, outputs: &mut Outputs) {
        let text = format!("the inputs of {} are gone", self.clients.name(client));
        self.log(now_us, (LogLevel::Info, Part::Client, text), outputs);
    }
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
