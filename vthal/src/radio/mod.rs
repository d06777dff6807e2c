//! A radio on the Linux board that measures how far beacons are, or how strongly it receives them.
//!
//! Terms. *Beacon*: a radio at an unknown place in the home. *Form*: the format in which the radio
//! sends its readings ([`RadioForm`]). *RadioDecoder*: what makes signals of its bytes. *Port*: where the bytes come from.
//!
//! A task keeps the port open and sends signals as events. It does not depend on the robot; what is not received is missing, and
//! the robot goes by its wheels.

mod decoder;
mod dwm1001;
mod json;
mod lines;
mod port;
mod reading;
mod roster;

use std::io;
use std::path::PathBuf;
use std::time::Duration;

use brain::observation::BeaconSignal;
use tokio::sync::mpsc::Sender;
use tokio::sync::mpsc::error::TrySendError;
use tokio::time::{Instant, sleep, timeout};

use crate::event::{Event, ReceiverGone};
use decoder::{RadioDecoder, Refused};
use dwm1001::Waker;
use port::Port;
pub use reading::{BeaconName, NoName};

/// Pause before a lost radio is opened again.
const RETRY: Duration = Duration::from_secs(2);
/// Bytes are fetched at most this often: twice for each of the robot's reports, so that no radio takes the processor.
const READ_EVERY: Duration = Duration::from_millis(10);
/// A radio that is silent for this long is reported.
const SILENCE: Duration = Duration::from_secs(60);
/// Longest wait for a radio that does not take the words which make it speak.
const WRITE_WAIT: Duration = Duration::from_secs(1);

/// Deviation of a range where neither radio nor configuration gives one, metres: ultra-wideband in motion (Sensors 22
/// (2022) 2927).
pub const SIGMA_M: f64 = 0.2;

/// Beacons that may be listed, and that get a number when none are; a home has some, and a street has hundreds.
pub const BEACONS_MAX: usize = 32;

/// The format in which a radio reports its measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadioForm {
    /// `{"beacon":"kitchen","range_m":3.21}` or `{"beacon":"kitchen","rssi_dbm":-63}`, a line each.
    Lines,
    /// The shell of a DWM1001 module with its stock firmware.
    Dwm1001,
}

impl RadioForm {
    /// The form with this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "lines" => Some(Self::Lines),
            "dwm1001" => Some(Self::Dwm1001),
            _ => None,
        }
    }
}

/// Which radio, and what is known of its beacons.
#[derive(Clone, Debug, PartialEq)]
pub struct RadioSettings {
    /// A serial device, a FIFO or a socket; may appear later.
    pub device: PathBuf,
    /// Bits per second of a serial device.
    pub baud: u32,
    /// What it says.
    pub form: RadioForm,
    /// Beacons that count; all when it is empty.
    pub beacons: Vec<BeaconName>,
    /// Deviation of a range for which the radio reports none, metres.
    pub sigma_m: f64,
    /// How much higher than the robot's antenna the beacons hang, metres.
    pub height_m: f64,
}

impl RadioSettings {
    /// What holds unless something else is said.
    #[must_use]
    pub const fn new(device: PathBuf) -> Self {
        Self {
            device,
            baud: 115_200,
            form: RadioForm::Lines,
            beacons: Vec::new(),
            sigma_m: SIGMA_M,
            height_m: 0.0,
        }
    }
}

/// From the radio.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RadioEvent {
    /// It sends data: for the first time, or again.
    Speaks,
    /// What was measured.
    Heard(Vec<BeaconSignal>),
    /// A beacon was received for the first time; its name and number.
    NewBeacon(String, u16),
    /// Lines could not be used.
    Refused(Refused),
    /// It is not there, was lost, or names no beacons; reported once per outage, with the reason.
    Absent(String),
}

/// Why the port is no longer used.
enum Loss {
    HungUp,
    Failed(io::Error),
}

/// Listens until the daemon's event queue closes.
pub(crate) async fn serve(settings: RadioSettings, events: Sender<Event>) {
    let mut listener = Listener {
        decoder: RadioDecoder::new(&settings),
        events,
        started: Instant::now(),
        spoke_at: Duration::ZERO,
        outage: Outage::Unknown,
    };
    loop {
        let reason = match Port::open(&settings.device, settings.baud).await {
            Ok(mut port) => match listener.listen(&mut port, settings.form).await {
                Err(ReceiverGone) => return,
                Ok(Loss::HungUp) => "it hung up".to_owned(),
                Ok(Loss::Failed(error)) => error.to_string(),
            },
            Err(error) => error.to_string(),
        };
        if listener.tell_absent(reason).await.is_err() {
            return;
        }
        sleep(RETRY).await;
    }
}

/// The last reported state of the radio.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outage {
    /// Nothing yet.
    Unknown,
    Speaks,
    Absent,
}

struct Listener {
    decoder: RadioDecoder,
    events: Sender<Event>,
    started: Instant,
    /// When it spoke of a beacon last, or the port was opened.
    spoke_at: Duration,
    outage: Outage,
}

impl Listener {
    async fn listen(&mut self, port: &mut Port, form: RadioForm) -> Result<Loss, ReceiverGone> {
        let mut buffer = [0; 4096];
        self.decoder.begin();
        self.spoke_at = self.started.elapsed();
        let mut waker = match form {
            RadioForm::Lines => None,
            RadioForm::Dwm1001 => Some(Waker::opened(self.spoke_at)),
        };
        loop {
            let wait = self.wait(waker.as_ref());
            match timeout(wait, port.read(&mut buffer)).await {
                Ok(Ok(0)) => return Ok(Loss::HungUp),
                Ok(Ok(count)) => {
                    let spoke = self.take(buffer.get(..count).unwrap_or_default()).await?;
                    if let Some(waker) = waker.as_mut().filter(|_| spoke) {
                        waker.heard(self.spoke_at);
                    }
                    sleep(READ_EVERY).await;
                }
                Ok(Err(error)) => return Ok(Loss::Failed(error)),
                Err(_) => {}
            }
            let now = self.started.elapsed();
            if let Some(bytes) = waker.as_mut().and_then(|waker| waker.send(now))
                && let Ok(Err(error)) = timeout(WRITE_WAIT, port.write(bytes)).await
            {
                return Ok(Loss::Failed(error));
            }
            if now >= self.spoke_at + SILENCE {
                self.tell_absent("it says nothing of beacons".to_owned()).await?;
            }
        }
    }

    fn wait(&self, waker: Option<&Waker>) -> Duration {
        let due = waker.map_or(Duration::MAX, Waker::due);
        let silent = match self.outage {
            Outage::Absent => Duration::MAX,
            Outage::Unknown | Outage::Speaks => self.spoke_at + SILENCE,
        };
        due.min(silent).saturating_sub(self.started.elapsed())
    }

    /// Whether it spoke of a beacon.
    async fn take(&mut self, bytes: &[u8]) -> Result<bool, ReceiverGone> {
        let now = self.started.elapsed();
        let heard = self.decoder.take(now, bytes);
        if heard.is_speaking {
            self.spoke_at = now;
            if self.outage != Outage::Speaks {
                self.outage = Outage::Speaks;
                self.tell(RadioEvent::Speaks).await?;
            }
        }
        for (name, number) in heard.new {
            self.tell(RadioEvent::NewBeacon(name, number)).await?;
        }
        if let Some(refused) = heard.refused {
            self.tell(RadioEvent::Refused(refused)).await?;
        }
        // A loop that is busy gets the next ones: an old signal is worthless.
        let signals = Event::Radio(RadioEvent::Heard(heard.signals));
        match self.events.try_send(signals) {
            Err(TrySendError::Closed(_)) => Err(ReceiverGone),
            Ok(()) | Err(TrySendError::Full(_)) => Ok(heard.is_speaking),
        }
    }

    async fn tell_absent(&mut self, reason: String) -> Result<(), ReceiverGone> {
        if self.outage == Outage::Absent {
            return Ok(());
        }
        self.outage = Outage::Absent;
        self.tell(RadioEvent::Absent(reason)).await
    }

    async fn tell(&self, event: RadioEvent) -> Result<(), ReceiverGone> {
        self.events
            .send(Event::Radio(event))
            .await
            .map_err(|_| ReceiverGone)
    }
}
