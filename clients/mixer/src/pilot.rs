//! From readings to requests: a mixer at work, the seat that it holds, and how often its lease is renewed.

use rvac_api::{CleaningPower, RequestBody};

use crate::{Axes, Cleaning, Helm, Mixed, Mixer, Order, Press, Profile, Readings};

/// Period at which the mixer reads the inputs.
pub const STEP_EVERY_US: u64 = 20_000;
/// What does not change is said again so often: two renewals of the lease may be lost.
const RENEW_US: u64 = 80_000;
/// The lease of each drive request.
const LEASE_MS: u16 = 250;

/// The highest speeds of a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TopSpeeds {
    /// Straight ahead.
    pub forward_m_per_s: f64,
    /// Turning on the spot.
    pub turn_rad_per_s: f64,
}

/// Result of one reading of the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Steered {
    /// Stage by stage.
    pub mixed: Mixed,
    /// Buttons that were pressed just now, as requests.
    pub presses: Vec<RequestBody>,
    /// What to say for the driver's seat: to drive, or to leave it.
    pub seat: Option<RequestBody>,
}

/// A person who drives by a profile.
#[derive(Clone, Debug)]
pub struct Pilot {
    mixer: Mixer,
    helm: Helm,
    said: Option<(u64, Order)>,
}

impl Pilot {
    /// Drives by a mixer. Every input must be seen at rest first.
    #[must_use]
    pub fn new(mixer: Mixer) -> Self {
        Self {
            mixer,
            helm: Helm::default(),
            said: None,
        }
    }

    /// Takes another mixer. Who drives lets go by it: its inputs must be seen at rest first.
    pub fn take(&mut self, mixer: Mixer) {
        self.mixer = mixer;
    }

    /// The profile that drives.
    #[must_use]
    pub const fn profile(&self) -> &Profile {
        self.mixer.profile()
    }

    /// Looks at the inputs. To be called every [`STEP_EVERY_US`], and at once when an input is lost.
    pub fn step(&mut self, now_us: u64, readings: &Readings, top: TopSpeeds) -> Steered {
        let mixed = self.mixer.step(now_us, readings);
        let wish = mixed.wish();
        let order = self.helm.order(&wish);
        let is_due = self
            .said
            .is_none_or(|(when_us, last)| last != order || now_us.saturating_sub(when_us) >= RENEW_US);
        let seat = match order {
            Order::Nothing => None,
            Order::Release => Some(RequestBody::Release),
            Order::Drive { axes, cleaning } => is_due.then(|| drive(axes, cleaning, top)),
        };
        if seat.is_some() {
            self.said = Some((now_us, order));
        }
        Steered {
            mixed,
            presses: wish.presses.into_iter().map(pressed).collect(),
            seat,
        }
    }

    /// The robot refused to be driven: nothing more is asked until everything was let go once.
    pub fn refuse(&mut self) {
        self.helm.refuse();
    }
}

fn drive(axes: Axes, cleaning: Cleaning, top: TopSpeeds) -> RequestBody {
    RequestBody::Drive {
        v: axes.forward * top.forward_m_per_s,
        w: axes.turn * top.turn_rad_per_s,
        ttl: LEASE_MS,
        clean: false,
        power: Some(CleaningPower {
            suction: cleaning.suction,
            main_brush: cleaning.main_brush,
            side_brushes: cleaning.side_brushes,
        }),
    }
}

const fn pressed(press: Press) -> RequestBody {
    match press {
        Press::Start => RequestBody::Start { strategy: None },
        Press::Stop => RequestBody::Stop,
        Press::Spot => RequestBody::Spot,
        Press::Dock => RequestBody::Dock,
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::RequestBody;

    use super::{Pilot, RENEW_US, STEP_EVERY_US, TopSpeeds};
    use crate::{KeyCode, Mixer, Readings, Source};

    const TOP: TopSpeeds = TopSpeeds {
        forward_m_per_s: 0.3,
        turn_rad_per_s: 1.0,
    };

    struct Hands {
        pilot: Pilot,
        readings: Readings,
        now_us: u64,
    }

    impl Hands {
        fn new() -> Self {
            let readings = Readings {
                keys: Some([].into()),
                ..Readings::default()
            };
            let mut hands = Self {
                pilot: Pilot::new(Mixer::standard()),
                readings,
                now_us: 0,
            };
            for _ in 0..2 {
                assert_eq!(hands.step(), (Vec::new(), None));
            }
            hands
        }

        fn key(&mut self, code: &str, value: f64) {
            let code = KeyCode::new(code).expect("a key");
            self.readings.set(&Source::Key(code), value);
        }

        fn step(&mut self) -> (Vec<RequestBody>, Option<RequestBody>) {
            self.now_us += STEP_EVERY_US;
            let steered = self.pilot.step(self.now_us, &self.readings, TOP);
            (steered.presses, steered.seat)
        }

        #[track_caller]
        fn speed(&mut self) -> f64 {
            match self.step().1 {
                Some(RequestBody::Drive { v, ttl: 250, .. }) => v,
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn a_hold_begins_in_the_middle_is_renewed_and_released_once() {
        let mut hands = Hands::new();
        hands.key("KeyW", 1.0);
        assert_eq!(hands.speed(), 0.0);
        assert!((hands.speed() - 0.21).abs() < 1e-9);
        let steps = RENEW_US / STEP_EVERY_US;
        for _ in 1..steps {
            assert_eq!(hands.step().1, None, "nothing has changed");
        }
        assert!(hands.speed() > 0.0, "the lease is renewed");
        hands.key("KeyW", 0.0);
        assert_eq!(hands.step().1, Some(RequestBody::Release));
        assert_eq!(hands.step().1, None);
    }

    #[test]
    fn a_loss_releases_at_once() {
        let mut hands = Hands::new();
        hands.key("KeyW", 1.0);
        hands.step();
        hands.readings = Readings::default();
        assert_eq!(hands.step().1, Some(RequestBody::Release));
    }

    #[test]
    fn another_mix_lets_go() {
        let mut hands = Hands::new();
        hands.key("KeyW", 1.0);
        hands.step();
        hands.pilot.take(Mixer::standard());
        assert_eq!(hands.step().1, Some(RequestBody::Release));
        assert_eq!(hands.step().1, None, "the key is not at rest yet");
    }

    #[test]
    fn the_refused_is_silent_until_let_go_and_stop_is_heard() {
        let mut hands = Hands::new();
        hands.key("KeyW", 1.0);
        hands.step();
        hands.pilot.refuse();
        assert_eq!(hands.step().1, None);
        hands.key("Space", 1.0);
        assert_eq!(hands.step().0, [RequestBody::Stop]);
        hands.key("KeyW", 0.0);
        hands.step();
        hands.key("KeyW", 1.0);
        assert_eq!(hands.speed(), 0.0);
    }
}
