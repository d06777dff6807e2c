//! Driving by hand: from held keys and the touch pad to drive requests under a lease.
//!
//! Each request carries a lease of 250 ms and is renewed ten times a second while something is held. Whatever happens to the page
//! - hidden, closed, asleep, without network - no further request is sent and the robot stops when the lease ends.

use rvac_api::{RequestBody, RobotDescription};

/// The lease of each request in ms: two renewals may be lost.
const LEASE_MS: u16 = 250;

/// Deflection of the pad below which it counts as its middle.
const DEAD_ZONE: f64 = 0.08;

/// Keys drive at this share of the top speed, because a key is either up or down.
const KEY_SHARE: f64 = 0.7;

/// Backwards the robot sees nothing: it goes slower.
const REVERSE_SHARE: f64 = 0.5;

/// What the person wants, each -1..=1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Intent {
    /// Forward positive.
    pub forward: f64,
    /// Counter-clockwise positive.
    pub turn: f64,
}

impl Intent {
    /// From a pad whose knob is `right` and `down` of its middle, in units of the pad's radius.
    #[must_use]
    pub fn of_pad(right: f64, down: f64) -> Self {
        let length = right.hypot(down);
        if !length.is_finite() || length < DEAD_ZONE {
            return Self::default();
        }
        let limited = length.min(1.0);
        let live = (limited - DEAD_ZONE) / (1.0 - DEAD_ZONE);
        Self {
            forward: -down / length * live,
            turn: -right / length * live,
        }
    }
}

/// A key that drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Forward.
    Forward,
    /// Backward.
    Back,
    /// Turn left.
    Left,
    /// Turn right.
    Right,
}

impl Key {
    /// The key by its place on the keyboard, as browsers name it in `KeyboardEvent.code`.
    #[must_use]
    pub fn from_code(code: &str) -> Option<Self> {
        match code {
            "KeyW" | "ArrowUp" => Some(Self::Forward),
            "KeyS" | "ArrowDown" => Some(Self::Back),
            "KeyA" | "ArrowLeft" => Some(Self::Left),
            "KeyD" | "ArrowRight" => Some(Self::Right),
            _ => None,
        }
    }
}

/// The highest speeds that the pad asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveLimits {
    /// Forward in m/s.
    pub speed_m_per_s: f64,
    /// Turning in rad/s.
    pub turn_rad_per_s: f64,
}

impl DriveLimits {
    /// What the robot can do; before it said so, what every robot can.
    #[must_use]
    pub fn of(robot: Option<&RobotDescription>) -> Self {
        robot.map_or(
            Self {
                speed_m_per_s: 0.15,
                turn_rad_per_s: 0.8,
            },
            |robot| Self {
                speed_m_per_s: robot.speed_max_m_per_s,
                turn_rad_per_s: robot.turn_max_rad_per_s,
            },
        )
    }
}

/// What is held now, and whether the robot was told to drive.
#[derive(Clone, Debug, Default)]
pub struct Driver {
    pad: Option<Intent>,
    keys: [bool; 4],
    driving: bool,
    refused: bool,
    cleaners: bool,
}

impl Driver {
    /// The pad is held with this intent.
    pub fn hold_pad(&mut self, intent: Intent) {
        self.pad = Some(intent);
    }

    /// The pad is free.
    pub fn free_pad(&mut self) {
        self.pad = None;
        self.forget_refusal_at_rest();
    }

    /// A key went down.
    pub fn press(&mut self, key: Key) {
        self.keys[key as usize] = true;
    }

    /// A key went up.
    pub fn lift(&mut self, key: Key) {
        self.keys[key as usize] = false;
        self.forget_refusal_at_rest();
    }

    /// Everything is let go: the page lost the focus, was hidden, or lost its connection.
    pub fn drop_all(&mut self) {
        self.pad = None;
        self.keys = [false; 4];
        self.refused = false;
    }

    /// Brushes and suction run while driving, from now on.
    pub fn clean_while_driving(&mut self) {
        self.cleaners = true;
    }

    /// Brushes and suction stay off while driving, from now on.
    pub fn drive_only(&mut self) {
        self.cleaners = false;
    }

    /// The robot refused to be driven: nothing more is asked until everything was let go once.
    pub fn on_refused(&mut self) {
        self.refused = true;
        self.driving = false;
    }

    /// Whether something is held.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.pad.is_some() || self.keys.contains(&true)
    }

    /// What to send now: a drive request while something is held, one release when nothing is any more. To be asked ten times a
    /// second and at each change.
    pub fn request(&mut self, limits: DriveLimits) -> Option<RequestBody> {
        if !self.is_held() {
            return std::mem::take(&mut self.driving).then_some(RequestBody::Release);
        }
        if self.refused {
            return None;
        }
        // A hold begins in the middle: the daemon wants to see that nobody holds on through a stop.
        if !std::mem::replace(&mut self.driving, true) {
            return Some(self.drive(0.0, 0.0));
        }
        let intent = self.pad.unwrap_or_else(|| self.intent_of_keys());
        let share = if intent.forward < 0.0 { REVERSE_SHARE } else { 1.0 };
        Some(self.drive(
            intent.forward * share * limits.speed_m_per_s,
            intent.turn * limits.turn_rad_per_s,
        ))
    }

    const fn drive(&self, v: f64, w: f64) -> RequestBody {
        RequestBody::Drive {
            v,
            w,
            ttl: LEASE_MS,
            clean: self.cleaners,
            power: None,
        }
    }

    fn intent_of_keys(&self) -> Intent {
        let axis = |plus: Key, minus: Key| {
            let value = |key: Key| f64::from(u8::from(self.keys[key as usize]));
            (value(plus) - value(minus)) * KEY_SHARE
        };
        Intent {
            forward: axis(Key::Forward, Key::Back),
            turn: axis(Key::Left, Key::Right),
        }
    }

    fn forget_refusal_at_rest(&mut self) {
        if !self.is_held() {
            self.refused = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DriveLimits, Driver, Intent, Key};
    use rvac_api::RequestBody;

    const LIMITS: DriveLimits = DriveLimits {
        speed_m_per_s: 0.3,
        turn_rad_per_s: 1.0,
    };

    /// The speeds of the second request of a hold, or of any later one.
    #[track_caller]
    fn speeds(driver: &mut Driver) -> (f64, f64) {
        if !driver.driving {
            driver.request(LIMITS);
        }
        match driver.request(LIMITS) {
            Some(RequestBody::Drive {
                v,
                w,
                ttl: 250,
                clean: false,
                power: None,
            }) => (v, w),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn keys_drive_and_release_is_said_once() {
        let mut driver = Driver::default();
        assert_eq!(driver.request(LIMITS), None);
        driver.press(Key::Forward);
        driver.press(Key::Left);
        let (v, w) = speeds(&mut driver);
        assert!((v - 0.21).abs() < 1e-9 && (w - 0.7).abs() < 1e-9);
        driver.lift(Key::Forward);
        assert_eq!(speeds(&mut driver).0, 0.0);
        driver.lift(Key::Left);
        assert_eq!(driver.request(LIMITS), Some(RequestBody::Release));
        assert_eq!(driver.request(LIMITS), None);
    }

    #[test]
    fn every_hold_begins_in_the_middle() {
        let mut driver = Driver::default();
        for _ in 0..2 {
            driver.press(Key::Forward);
            let first = driver.request(LIMITS);
            assert_eq!(
                first,
                Some(RequestBody::Drive {
                    v: 0.0,
                    w: 0.0,
                    ttl: 250,
                    clean: false,
                    power: None
                })
            );
            assert!(speeds(&mut driver).0 > 0.0);
            driver.lift(Key::Forward);
            assert_eq!(driver.request(LIMITS), Some(RequestBody::Release));
        }
    }

    #[test]
    fn opposite_keys_stand_still_under_the_lease() {
        let mut driver = Driver::default();
        driver.press(Key::Forward);
        driver.press(Key::Back);
        assert_eq!(speeds(&mut driver), (0.0, 0.0));
    }

    #[test]
    fn backwards_is_slower() {
        let mut driver = Driver::default();
        driver.hold_pad(Intent::of_pad(0.0, 1.0));
        assert!((speeds(&mut driver).0 + 0.15).abs() < 1e-9);
    }

    #[test]
    fn the_pad_is_a_disc_with_a_dead_middle() {
        assert_eq!(Intent::of_pad(0.05, 0.05), Intent::default());
        assert_eq!(Intent::of_pad(f64::NAN, 0.0), Intent::default());
        for (right, down) in [(1.0, 1.0), (-9.0, 4.0), (0.0, -1.0)] {
            let intent = Intent::of_pad(right, down);
            assert!(intent.forward.hypot(intent.turn) <= 1.0 + 1e-9);
            assert!(intent.forward * down <= 0.0 && intent.turn * right <= 0.0);
        }
        assert!((Intent::of_pad(0.0, -1.0).forward - 1.0).abs() < 1e-9);
    }

    #[test]
    fn dropping_everything_releases() {
        let mut driver = Driver::default();
        driver.hold_pad(Intent::of_pad(0.0, -1.0));
        driver.press(Key::Left);
        speeds(&mut driver);
        driver.drop_all();
        assert_eq!(driver.request(LIMITS), Some(RequestBody::Release));
    }

    #[test]
    fn a_refused_driver_is_silent_until_let_go() {
        let mut driver = Driver::default();
        driver.press(Key::Forward);
        speeds(&mut driver);
        driver.on_refused();
        assert_eq!(driver.request(LIMITS), None);
        driver.lift(Key::Forward);
        assert_eq!(driver.request(LIMITS), None);
        driver.press(Key::Forward);
        speeds(&mut driver);
    }
}
