//! Whether a robot answers on a serial device, and what else is heard there.

use std::path::Path;
use std::time::{Duration, Instant};

use rvac_protocol::PacketBuffer;
use rvac_protocol::message::BinaryKinds;
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::Tick;
use serial2::SerialPort;

/// What the daemon takes without a word in its configuration: the rate of the SR8730 and of simulators.
pub(super) const USUAL_BAUD: u32 = 230_400;
/// Rates of the robots that there is firmware for: the usual one, the Relax, and an SR8730 whose input is sampled.
const RATES_BAUD: [u32; 3] = [USUAL_BAUD, 38_400, 57_600];
/// A robot that starts answers the handshake within this time.
const PATIENCE: Duration = Duration::from_millis(2_500);
/// Longest wait for bytes before the session is looked after.
const LOOK: Duration = Duration::from_millis(20);
/// So many bytes are no accident.
const NOISE_BYTES: u64 = 20;

/// What is on a device.
#[derive(Debug)]
pub(super) enum Heard {
    Robot(Answering),
    Nothing(Silence),
}

/// A robot that answers.
#[derive(Debug)]
pub(super) struct Answering {
    /// Its model.
    pub(super) device: String,
    pub(super) baud: u32,
}

/// Why nobody is found on a device.
#[derive(Debug)]
pub(super) enum Silence {
    /// It cannot be opened.
    Closed(std::io::Error),
    /// No byte came.
    Quiet,
    /// Bytes came, and no packet: this share of them is text.
    Noise { bytes: u64, text_share: f64 },
}

impl Silence {
    /// The likely cause, with a remedy.
    pub(super) fn in_words(&self) -> String {
        match self {
            Self::Closed(error) => {
                format!("cannot be opened: {error}; another program may have it, or you need sudo")
            }
            Self::Quiet => "nothing comes at all: no robot, no power, or crossed or missing wires".to_owned(),
            Self::Noise { bytes, text_share } if *text_share > 0.9 => {
                format!("{bytes} bytes of text and no packet: a login console or another device speaks there")
            }
            Self::Noise { bytes, .. } => {
                format!(
                    "{bytes} bytes and no packet: something speaks at another rate, or the ground wire is missing"
                )
            }
        }
    }
}

/// Looks for a robot at each rate.
pub(super) fn look(device: &Path) -> Heard {
    let mut best = Silence::Quiet;
    for baud in RATES_BAUD {
        match look_at(device, baud) {
            Ok(Heard::Robot(found)) => return Heard::Robot(found),
            Ok(Heard::Nothing(noise @ Silence::Noise { .. })) => best = noise,
            Ok(Heard::Nothing(_)) => {}
            Err(error) => return Heard::Nothing(Silence::Closed(error)),
        }
    }
    Heard::Nothing(best)
}

fn look_at(device: &Path, baud: u32) -> std::io::Result<Heard> {
    let mut port = SerialPort::open(device, baud)?;
    port.set_read_timeout(LOOK)?;
    let mut session = HostSession::new(BinaryKinds::default(), Tick(0));
    let start = Instant::now();
    let (mut bytes, mut letters) = (0_u64, 0_u64);
    let mut chunk = [0; 512];
    let mut found = None;
    while found.is_none() && start.elapsed() < PATIENCE {
        let now = Tick(start.elapsed().as_millis() as u32);
        let mut heard = session.poll(now);
        let mut packet = PacketBuffer::new();
        while session.next_packet(&mut packet) {
            port.write_all(packet.as_bytes())?;
        }
        let count = match port.read(&mut chunk) {
            Ok(count) => count,
            Err(error) if error.kind() == std::io::ErrorKind::TimedOut => 0,
            Err(error) => return Err(error),
        };
        for byte in chunk.iter().take(count) {
            bytes += 1;
            letters += u64::from(byte.is_ascii_graphic() || byte.is_ascii_whitespace());
            heard = session.receive(*byte, now).or(heard);
            if let Some(HostEvent::Opened(hello)) = &heard {
                found = Some(hello.device.as_str().to_owned());
            }
        }
    }
    Ok(match found {
        Some(device) => Heard::Robot(Answering { device, baud }),
        None if bytes < NOISE_BYTES => Heard::Nothing(Silence::Quiet),
        None => Heard::Nothing(Silence::Noise {
            bytes,
            text_share: letters as f64 / bytes as f64,
        }),
    })
}
