//! Manual control over single requests: each move is worth as long as the daemon's lease, so a robot whose client falls silent stands soon
//! after. One client drives at a time, and begins from rest.

use std::net::IpAddr;
use std::time::Duration;

use bridge::{DRIVE_SILENCE, DriveGate, Limiter};
use rvac_api::{RequestBody, RobotDescription};
use tokio::time::Instant;

use crate::answer::Refusal;

/// How long a move holds: the longest lease that the daemon gives.
const LEASE_MS: u16 = 400;
const LEASE: Duration = Duration::from_millis(LEASE_MS as u64);
/// After so long without a move somebody else may take over.
const SEAT_KEPT: Duration = Duration::from_secs(5);
/// A stick across turns half as fast as the wheels could: a round trip over a network is long.
const TURN_SHARE: f64 = 0.5;
/// Moves at once, and the pause that allows one more.
const MOVES_MAX: u32 = 20;
const MOVE_EVERY: Duration = Duration::from_millis(20);

/// Who drives, if somebody does.
#[derive(Debug)]
pub(crate) struct Driving {
    seat: Option<Driver>,
    /// When a move came while manual control was off.
    stray_at: Option<Instant>,
    limiter: Limiter,
}

#[derive(Clone, Copy, Debug)]
struct Driver {
    by: IpAddr,
    heard_at: Instant,
    gate: DriveGate,
    /// The last move that went on to the daemon.
    last: Option<LastMove>,
}

#[derive(Clone, Copy, Debug)]
struct LastMove {
    at: Instant,
    /// The stick was at rest.
    is_zero: bool,
}

impl Default for Driving {
    fn default() -> Self {
        Self {
            seat: None,
            stray_at: None,
            limiter: Limiter::new(MOVES_MAX, MOVE_EVERY),
        }
    }
}

impl Driving {
    pub(crate) const fn is_enabled(&self) -> bool {
        self.seat.is_some()
    }

    /// Switches manual control on for the client at `by`.
    ///
    /// # Errors
    /// [`Refusal::DriverBusy`].
    pub(crate) fn enable(&mut self, by: IpAddr, now: Instant) -> Result<(), Refusal> {
        self.check(by, now)?;
        if self.seat.is_none_or(|seat| seat.by != by) {
            // A stick that is held already must not set the robot off.
            let is_held = self
                .stray_at
                .is_some_and(|at| now.duration_since(at) < DRIVE_SILENCE);
            let gate = match is_held {
                true => DriveGate::shut_at(now),
                false => DriveGate::open_at(now),
            };
            self.seat = Some(Driver {
                by,
                heard_at: now,
                gate,
                last: None,
            });
        }
        Ok(())
    }

    /// Switches it off. Everybody may.
    pub(crate) const fn disable(&mut self) {
        self.seat = None;
    }

    /// What was asked for is refused: whoever still sends moves begins from rest again.
    pub(crate) const fn refused(&mut self) {
        if let Some(seat) = &mut self.seat {
            seat.gate.shut();
            seat.last = None;
        }
    }

    /// What the daemon is asked for a stick that is held so: forward and turn, each -1..=1.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(crate) fn hear(
        &mut self,
        [forward, turn]: [f64; 2],
        (by, now, at): (IpAddr, Instant, Duration),
        robot: &RobotDescription,
    ) -> Result<Vec<RequestBody>, Refusal> {
        self.check(by, now)?;
        let Some(seat) = self.seat.as_mut().filter(|seat| seat.by == by) else {
            self.stray_at = Some(now);
            return Err(Refusal::NotEnabled);
        };
        if !self.limiter.allows(at) {
            return Err(Refusal::TooFast);
        }
        seat.heard_at = now;
        let is_zero = forward == 0.0 && turn == 0.0;
        let since = seat.last.map(|last| (now.duration_since(last.at), last.is_zero));
        // The lease has ended under a stick that is still held: it is let go first.
        if since.is_some_and(|(gap, was_zero)| !was_zero && (LEASE..DRIVE_SILENCE).contains(&gap)) {
            seat.gate.shut();
        }
        seat.gate.hear(is_zero, now);
        if !seat.gate.is_open() {
            seat.last = None;
            return Err(Refusal::NotFromRest);
        }
        let drive = |share: f64| RequestBody::Drive {
            v: share * forward * robot.speed_max_m_per_s,
            w: share * turn * robot.turn_max_rad_per_s * TURN_SHARE,
            ttl: LEASE_MS,
            clean: false,
            power: None,
        };
        // The daemon wants a stick at rest before it gives the seat, which is lost with each lease; that the client was at rest is what
        // the gate stands for.
        let is_held = since.is_some_and(|(gap, _)| gap < LEASE);
        seat.last = Some(LastMove { at: now, is_zero });
        let first = (!is_held).then(|| drive(0.0));
        Ok(first.into_iter().chain([drive(1.0)]).collect())
    }

    fn check(&self, by: IpAddr, now: Instant) -> Result<(), Refusal> {
        match &self.seat {
            Some(seat) if seat.by != by && now.duration_since(seat.heard_at) < SEAT_KEPT => {
                Err(Refusal::DriverBusy)
            }
            _ => Ok(()),
        }
    }
}

/// A stream that only falls silent for as long as a lease goes on from rest without a word of its own.
const _: () = assert!(DRIVE_SILENCE.as_millis() > LEASE_MS as u128);

#[cfg(test)]
mod tests {
    use std::net::{IpAddr, Ipv4Addr};
    use std::time::Duration;

    use rvac_api::{RequestBody, RobotDescription};
    use tokio::time::Instant;

    use super::Driving;
    use crate::answer::Refusal;

    const ANNA: IpAddr = IpAddr::V4(Ipv4Addr::new(10, 0, 0, 1));
    const BERT: IpAddr = IpAddr::V4(Ipv4Addr::new(10, 0, 0, 2));

    fn robot() -> RobotDescription {
        serde_json::from_str(
            r#"{"device": "x", "radius_m": 0.17, "swath_m": 0.2, "speed_max_m_per_s": 0.4, "turn_max_rad_per_s": 2.0,
                "proximity": 0, "parts": []}"#,
        )
        .expect("a robot")
    }

    struct Trial {
        driving: Driving,
        start: Instant,
    }

    impl Trial {
        fn new() -> Self {
            Self {
                driving: Driving::default(),
                start: Instant::now(),
            }
        }

        fn at(&self, ms: u64) -> (Instant, Duration) {
            let at = Duration::from_millis(ms);
            (self.start + at, at)
        }

        fn enable(&mut self, by: IpAddr, ms: u64) -> Result<(), Refusal> {
            let (now, _) = self.at(ms);
            self.driving.enable(by, now)
        }

        /// The speeds that the daemon is asked for.
        fn hear(&mut self, by: IpAddr, stick: [f64; 2], ms: u64) -> Result<Vec<[f64; 2]>, Refusal> {
            let (now, at) = self.at(ms);
            let asked = self.driving.hear(stick, (by, now, at), &robot())?;
            Ok(asked
                .into_iter()
                .map(|body| match body {
                    RequestBody::Drive { v, w, ttl: 400, .. } => [v, w],
                    other => panic!("{other:?}"),
                })
                .collect())
        }
    }

    #[test]
    fn a_stick_is_a_speed_and_each_hold_begins_with_a_zero() {
        let mut trial = Trial::new();
        assert_eq!(trial.hear(ANNA, [0.5, 0.0], 0), Err(Refusal::NotEnabled));
        trial.enable(ANNA, 500).expect("it is free");
        assert_eq!(trial.hear(ANNA, [0.5, 0.0], 600), Err(Refusal::NotFromRest));
        assert!(trial.hear(ANNA, [0.0, 0.0], 700).is_ok(), "let go");
        assert_eq!(
            trial.hear(ANNA, [0.5, -1.0], 1_200),
            Ok(vec![[0.0, 0.0], [0.2, -1.0]])
        );
        assert_eq!(trial.hear(ANNA, [1.0, 0.0], 1_300), Ok(vec![[0.4, 0.0]]));
        // The lease has ended meanwhile, and with it the daemon's seat: a stick that is still held moves nothing.
        assert_eq!(trial.hear(ANNA, [1.0, 0.0], 1_900), Err(Refusal::NotFromRest));
        assert_eq!(trial.hear(ANNA, [1.0, 0.0], 2_000), Err(Refusal::NotFromRest));
        let rest = [0.0, 0.0];
        assert_eq!(trial.hear(ANNA, rest, 2_100), Ok(vec![rest, rest]));
        assert_eq!(trial.hear(ANNA, [1.0, 0.0], 2_800), Ok(vec![rest, [0.4, 0.0]]));
        assert_eq!(
            trial.hear(ANNA, [1.0, 0.0], 3_900),
            Ok(vec![rest, [0.4, 0.0]]),
            "after a second"
        );
        trial.driving.disable();
        assert_eq!(trial.hear(ANNA, [0.5, 0.0], 4_000), Err(Refusal::NotEnabled));
    }

    #[test]
    fn after_a_refusal_a_held_stick_moves_nothing_until_it_was_let_go() {
        let mut trial = Trial::new();
        trial.enable(ANNA, 0).expect("it is free");
        trial.hear(ANNA, [0.5, 0.0], 100).expect("it drives");
        trial.driving.refused();
        for ms in (200..5_000).step_by(100) {
            assert_eq!(trial.hear(ANNA, [0.5, 0.0], ms), Err(Refusal::NotFromRest));
        }
        assert!(trial.hear(ANNA, [0.0, 0.0], 5_000).is_ok());
        assert!(trial.hear(ANNA, [0.5, 0.0], 5_100).is_ok());
    }

    #[test]
    fn one_client_drives_and_another_takes_over_when_it_is_silent() {
        let mut trial = Trial::new();
        trial.enable(ANNA, 0).expect("it is free");
        trial.hear(ANNA, [0.5, 0.0], 1_000).expect("it drives");
        assert_eq!(trial.enable(BERT, 2_000), Err(Refusal::DriverBusy));
        assert_eq!(trial.hear(BERT, [0.5, 0.0], 2_000), Err(Refusal::DriverBusy));
        assert_eq!(trial.enable(BERT, 7_000), Ok(()));
        assert_eq!(trial.hear(ANNA, [0.5, 0.0], 7_100), Err(Refusal::DriverBusy));
    }

    #[test]
    fn a_flood_of_moves_is_cut() {
        let mut trial = Trial::new();
        trial.enable(ANNA, 0).expect("it is free");
        let passed = (0..1_000)
            .filter(|_| trial.hear(ANNA, [0.5, 0.0], 1_000).is_ok())
            .count();
        assert!(passed <= 20, "{passed}");
    }
}
