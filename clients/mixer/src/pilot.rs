//! From readings to requests: a mixer at work, the seat that it holds, and how often its lease is renewed.

use std::borrow::Cow;
use std::collections::BTreeSet;

use rvac_api::{CleaningPower, RequestBody};

use crate::{Axes, Cleaning, Device, Helm, Mixed, Mixer, Order, PadWatch, Press, Profile, Readings};

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
    /// Pads that are pushed and say nothing more. They count as gone.
    pub silent_pads: BTreeSet<u8>,
}

/// A person who drives by a profile.
#[derive(Clone, Debug)]
pub struct Pilot {
    mixer: Mixer,
    helm: Helm,
    pads: PadWatch,
    /// The devices that were pushed in the step before.
    pushed: BTreeSet<Device>,
    said: Option<(u64, Order)>,
}

impl Pilot {
    /// Drives by a mixer. Every input must be seen at rest first.
    #[must_use]
    pub fn new(mixer: Mixer) -> Self {
        Self {
            mixer,
            helm: Helm::default(),
            pads: PadWatch::default(),
            pushed: BTreeSet::new(),
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

    /// The profile with its trims as they were set since.
    #[must_use]
    pub fn trimmed(&self) -> Profile {
        self.mixer.trimmed()
    }

    /// Looks at the inputs. To be called every [`STEP_EVERY_US`], and at once when an input is lost.
    pub fn step(&mut self, now_us: u64, readings: &Readings, top: TopSpeeds) -> Steered {
        let is_pushed = |pad| self.pushed.contains(&Device::Pad(pad));
        let silent_pads = self.pads.look(now_us, &readings.pads, is_pushed).clone();
        let mixed = self.mixer.step(now_us, &without(readings, &silent_pads));
        self.pushed.clone_from(&mixed.pushed);
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
            silent_pads,
        }
    }

    /// The robot refused to be driven: nothing more is asked until everything was let go once.
    pub fn refuse(&mut self) {
        self.helm.refuse();
    }
}

/// The readings as if these pads were gone.
fn without<'a>(readings: &'a Readings, pads: &BTreeSet<u8>) -> Cow<'a, Readings> {
    let mut left = Cow::Borrowed(readings);
    for pad in pads {
        left.to_mut().remove(&Device::Pad(*pad));
    }
    left
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
    use crate::{KeyCode, Mixer, PAD_SILENT_US, Readings, Source};

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
    fn a_pad_that_says_nothing_more_stops_the_wheels_and_must_come_to_rest() {
        let mut hands = Hands::new();
        let across = || "pad-0-axis-0".parse().expect("an input");
        for _ in 0..3 {
            hands.readings.set(&across(), 0.0);
            hands.step();
        }
        // Trembles as a thumb does, for as long as it likes.
        for step in 0..400 {
            hands.readings.set(&across(), -0.9 - 0.01 * f64::from(step % 2));
            assert_ne!(hands.step().1, Some(RequestBody::Release));
        }
        let silent_from_us = hands.now_us;
        while hands.step().1 != Some(RequestBody::Release) {
            assert!(hands.now_us < silent_from_us + PAD_SILENT_US);
        }
        assert_eq!(hands.now_us, silent_from_us + PAD_SILENT_US);
        hands.readings.set(&across(), -0.9);
        for _ in 0..5 {
            assert_eq!(hands.step().1, None, "it is pushed when it is heard again");
        }
        hands.readings.set(&across(), 0.0);
        hands.step();
        hands.readings.set(&across(), -0.9);
        hands.step();
        assert!(matches!(hands.step().1, Some(RequestBody::Drive { w, .. }) if w > 0.0));
    }

    #[test]
    fn a_key_beside_a_resting_pad_is_held_as_long_as_one_likes() {
        let mut hands = Hands::new();
        let across = "pad-0-axis-0".parse().expect("an input");
        hands.readings.set(&across, 0.02);
        for _ in 0..3 {
            hands.step();
        }
        hands.key("KeyW", 1.0);
        for _ in 0..10 * PAD_SILENT_US / STEP_EVERY_US {
            assert_ne!(hands.step().1, Some(RequestBody::Release));
        }
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
