//! The proof of the code: SPAKE2, in which neither end shows it and each try is one guess.
//!
//! Both ends mix in the names of guest and robot, so that a proof for one robot is none for another. Then each shows by a MAC over both
//! messages that it has the same key, the guest first: whoever does not know the code learns nothing but that it was wrong.

use curve25519_dalek::edwards::CompressedEdwardsY;
use hkdf::Hkdf;
use hmac::{Hmac, Mac as _};
use rand_core::{CryptoRng, Error, RngCore};
use sha2::Sha256;
use spake2::{Ed25519Group, Identity, Password, Spake2};
use subtle::ConstantTimeEq as _;

use crate::{Code, DeviceName};

/// Length of a SPAKE2 message: a side and a point.
pub(crate) const MESSAGE: usize = 33;

/// Length of a proof.
pub(crate) const PROOF: usize = 32;

/// Keeps these proofs apart from any other use of the same key.
const PURPOSE: &[u8] = b"librvac pairing 1";

/// The other end's message cannot be one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("The message of the other end is malformed.")]
pub struct ExchangeError;

/// The two parties. The proof is valid only between them.
#[derive(Clone, Copy, Debug)]
pub struct Ends<'a> {
    /// The name that the guest asks for.
    pub guest: &'a DeviceName,
    /// The robot's full number.
    pub robot: &'a str,
}

impl Ends<'_> {
    fn identities(self) -> (Identity, Identity) {
        (
            Identity::new(self.guest.as_str().as_bytes()),
            Identity::new(self.robot.as_bytes()),
        )
    }
}

/// The end that asks to be paired.
pub struct Guest {
    spake: Spake2<Ed25519Group>,
    message: [u8; MESSAGE],
}

impl std::fmt::Debug for Guest {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str("Guest(..)")
    }
}

/// A guest that has shown its proof and waits for the robot's.
#[derive(Debug)]
pub struct Waiting {
    expected: [u8; PROOF],
}

impl Guest {
    /// Begins; gives the message for the robot.
    #[must_use]
    pub fn begin(code: &Code, ends: Ends<'_>, random: [u8; 64]) -> (Self, [u8; MESSAGE]) {
        let (guest, host) = ends.identities();
        let (spake, message) =
            Spake2::start_a_with_rng(&Password::new(code.bytes()), &guest, &host, Given::new(random));
        let message = sized(&message);
        (Self { spake, message }, message)
    }

    /// Takes the robot's message; gives the proof to show.
    ///
    /// # Errors
    /// [`ExchangeError`].
    pub fn hear(self, robot_message: &[u8; MESSAGE]) -> Result<(Waiting, [u8; PROOF]), ExchangeError> {
        check_point(robot_message)?;
        let key = self.spake.finish(robot_message).map_err(|_| ExchangeError)?;
        let proofs = Proofs::new(&key, &self.message, robot_message);
        Ok((
            Waiting {
                expected: proofs.host,
            },
            proofs.guest,
        ))
    }
}

impl Waiting {
    /// Whether the robot knows the code too.
    #[must_use]
    pub fn is_proven(&self, proof: &[u8; PROOF]) -> bool {
        self.expected.ct_eq(proof).into()
    }
}

/// The robot's end, after both messages.
#[derive(Debug)]
pub(crate) struct Host {
    proofs: Proofs,
}

impl Host {
    /// Answers a guest's message.
    pub(crate) fn answer(
        code: &Code,
        ends: Ends<'_>,
        random: [u8; 64],
        guest_message: &[u8; MESSAGE],
    ) -> Result<(Self, [u8; MESSAGE]), ExchangeError> {
        check_point(guest_message)?;
        let (guest, host) = ends.identities();
        let (spake, message) = Spake2::<Ed25519Group>::start_b_with_rng(
            &Password::new(code.bytes()),
            &guest,
            &host,
            Given::new(random),
        );
        let message = sized(&message);
        let key = spake.finish(guest_message).map_err(|_| ExchangeError)?;
        let proofs = Proofs::new(&key, guest_message, &message);
        Ok((Self { proofs }, message))
    }

    /// The robot's own proof, if the guest's is right.
    pub(crate) fn judge(self, proof: &[u8; PROOF]) -> Option<[u8; PROOF]> {
        bool::from(self.proofs.guest.ct_eq(proof)).then_some(self.proofs.host)
    }
}

/// A message of the library, which has one length.
fn sized(message: &[u8]) -> [u8; MESSAGE] {
    let mut sized = [0; MESSAGE];
    for (to, from) in sized.iter_mut().zip(message) {
        *to = *from;
    }
    sized
}

/// A point of small order or one that is not written in the one way would
/// take the other end's randomness out of the key, or give one message two proofs.
fn check_point(message: &[u8; MESSAGE]) -> Result<(), ExchangeError> {
    let (_side, point) = message.split_at(1);
    let written = CompressedEdwardsY::from_slice(point).map_err(|_| ExchangeError)?;
    match written.decompress() {
        Some(point) if !point.is_small_order() && point.compress() == written => Ok(()),
        _ => Err(ExchangeError),
    }
}

#[derive(Clone)]
struct Proofs {
    guest: [u8; PROOF],
    host: [u8; PROOF],
}

impl std::fmt::Debug for Proofs {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str("Proofs(..)")
    }
}

impl Proofs {
    fn new(key: &[u8], guest_message: &[u8], host_message: &[u8]) -> Self {
        let keys = Hkdf::<Sha256>::new(Some(PURPOSE), key);
        let proof = |side: &[u8]| {
            let mut key = [0; 64];
            // Only lengths beyond 8160 bytes are refused.
            keys.expand(side, &mut key).ok();
            let mut mac = <Hmac<Sha256> as hmac::digest::KeyInit>::new(&key.into());
            mac.update(guest_message);
            mac.update(host_message);
            mac.finalize().into_bytes().into()
        };
        Self {
            guest: proof(b"guest"),
            host: proof(b"host"),
        }
    }
}

/// Random bytes of the caller in the shape that the library asks for. It takes exactly 64, once.
struct Given {
    bytes: [u8; 64],
    taken: usize,
}

impl Given {
    const fn new(bytes: [u8; 64]) -> Self {
        Self { bytes, taken: 0 }
    }
}

impl RngCore for Given {
    fn next_u32(&mut self) -> u32 {
        let mut bytes = [0; 4];
        self.fill_bytes(&mut bytes);
        u32::from_le_bytes(bytes)
    }

    fn next_u64(&mut self) -> u64 {
        let mut bytes = [0; 8];
        self.fill_bytes(&mut bytes);
        u64::from_le_bytes(bytes)
    }

    fn fill_bytes(&mut self, to: &mut [u8]) {
        let given = self.bytes.get(self.taken..self.taken + to.len());
        // A library that needed more random bytes would make keys that can be guessed, so refuse.
        to.copy_from_slice(given.expect("SPAKE2 takes 64 random bytes, which a test counts"));
        self.taken += to.len();
    }

    fn try_fill_bytes(&mut self, to: &mut [u8]) -> Result<(), Error> {
        self.fill_bytes(to);
        Ok(())
    }
}

impl CryptoRng for Given {}

#[cfg(test)]
mod tests {
    use super::{Ends, ExchangeError, Guest, Host, MESSAGE};
    use crate::{Code, DeviceName};

    const ROBOT: &str = "robot-a";

    fn code(digits: &str) -> Code {
        Code::parse(digits).unwrap()
    }

    fn name() -> DeviceName {
        DeviceName::new("phone").unwrap()
    }

    /// What one of the two believes.
    #[derive(Clone, Copy, Debug)]
    struct Side {
        digits: &'static str,
        name: &'static str,
        robot: &'static str,
    }

    /// Whether guest and host accept each other's proofs.
    fn meet(guest: Side, host: Side) -> bool {
        let [guest_name, host_name] = [guest.name, host.name].map(|name| DeviceName::new(name).unwrap());
        let ends = |guest, robot| Ends { guest, robot };
        let (end, hello) = Guest::begin(&code(guest.digits), ends(&guest_name, guest.robot), [1; 64]);
        let (robot, answer) =
            Host::answer(&code(host.digits), ends(&host_name, host.robot), [2; 64], &hello).unwrap();
        let (waiting, proof) = end.hear(&answer).unwrap();
        robot.judge(&proof).is_some_and(|proof| waiting.is_proven(&proof))
    }

    #[test]
    fn only_the_same_code_name_and_robot_meet() {
        let good = Side {
            digits: "12345678",
            name: "phone",
            robot: ROBOT,
        };
        assert!(meet(good, good));
        let wrongs = [
            Side {
                digits: "12345679",
                ..good
            },
            Side {
                name: "other",
                ..good
            },
            Side {
                robot: "robot-b",
                ..good
            },
        ];
        for wrong in wrongs {
            assert!(!meet(wrong, good), "{wrong:?}");
        }
    }

    #[test]
    fn malformed_identity_small_order_and_reflected_messages_are_refused() {
        let guest = name();
        let ends = Ends {
            guest: &guest,
            robot: ROBOT,
        };
        let (_, hello) = Guest::begin(&code("12345678"), ends, [1; 64]);
        let host =
            |message: &[u8; MESSAGE]| Host::answer(&code("12345678"), ends, [2; 64], message).map(|_| ());
        assert_eq!(host(&hello), Ok(()));
        let (_, answer) = Host::answer(&code("12345678"), ends, [2; 64], &hello).unwrap();
        assert_eq!(host(&answer), Err(ExchangeError), "reflected");
        let mut points = vec![[0; 32], [0xff; 32]];
        // The identity, the point of order two, and one that is not on the curve.
        for (first, rest, last) in [(1, 0, 0), (0xec, 0xff, 0x7f), (2, 0, 0)] {
            let mut point = [rest; 32];
            point[0] = first;
            point[31] = last;
            points.push(point);
        }
        for point in points {
            let mut message = [b'A'; MESSAGE];
            message[1..].copy_from_slice(&point);
            assert_eq!(host(&message), Err(ExchangeError), "{point:?}");
        }
        let (guest, own) = Guest::begin(&code("12345678"), ends, [1; 64]);
        assert!(guest.hear(&own).is_err(), "its own message");
    }
}
