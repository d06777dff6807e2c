//! The robot's name on the home network: multicast DNS, by which `https://rvac-....local/` is found without a name server.
//!
//! It is a hint and no more: the certificate, not the name, says who answers.

use std::time::Duration;

use mdns_sd::{ServiceDaemon, ServiceInfo};
use tokio::time::sleep;
use tracing::{info, warn};

use crate::gate::Gate;

/// The kind of service, by which programs find robots.
const SERVICE: &str = "_librervac._tcp.local.";
/// A robot whose identity was made anew has another name.
const LOOK: Duration = Duration::from_secs(10);

/// Announces the robot for ever, under the name that it has at the moment. A computer without multicast does without.
pub(crate) async fn announce(gate: &Gate, port: u16) {
    let responder = match Responder::start() {
        Ok(responder) => responder,
        Err(error) => {
            warn!(%error, "the robot's name is not announced: use its address");
            return;
        }
    };
    let mut announced = None;
    loop {
        let host_name = gate.host_name();
        if announced.as_ref() != Some(&host_name) {
            match responder.announce(&host_name, port) {
                Ok(()) => info!(%host_name, "announced"),
                Err(error) => warn!(%error, %host_name, "the robot's name is not announced: use its address"),
            }
            announced = Some(host_name);
        }
        sleep(LOOK).await;
    }
}

/// Answers who asks for the name, on a thread of its own, and says goodbye when it is dropped.
struct Responder(ServiceDaemon);

impl Responder {
    fn start() -> Result<Self, mdns_sd::Error> {
        Ok(Self(ServiceDaemon::new()?))
    }

    fn announce(&self, host_name: &str, port: u16) -> Result<(), mdns_sd::Error> {
        self.0.register(service(host_name, port)?)
    }
}

impl Drop for Responder {
    fn drop(&mut self) {
        // Whoever does not hear the goodbye forgets the name after two minutes.
        self.0.shutdown().ok();
    }
}

/// What is announced: the addresses are those that the computer has at each moment.
fn service(host_name: &str, port: u16) -> Result<ServiceInfo, mdns_sd::Error> {
    let instance = host_name.trim_end_matches(".local");
    let dotted = format!("{host_name}.");
    let nothing = [("path", "/")];
    Ok(ServiceInfo::new(SERVICE, instance, &dotted, "", port, &nothing[..])?.enable_addr_auto())
}

#[cfg(test)]
mod tests {
    use super::service;

    #[test]
    fn the_name_is_that_of_the_certificate() {
        let told = service("rvac-7k2qm4xa.local", 443).expect("a service");
        assert_eq!(told.get_hostname(), "rvac-7k2qm4xa.local.");
        assert_eq!(told.get_fullname(), "rvac-7k2qm4xa._librervac._tcp.local.");
        assert_eq!(told.get_port(), 443);
        assert!(told.is_addr_auto());
    }
}
