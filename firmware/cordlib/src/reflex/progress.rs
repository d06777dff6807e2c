//! S15: a robot driven at 30 % or more makes no progress if it covers less than 2 cm in 2 s, or if its wheels turn it by a
//! radian and the gyro does not confirm that. It stops. After 1 s the next command may try again; how often is the host's
//! decision.

use rvac_protocol::message::Gyro;
use rvac_units::{Angle, Tick};

use crate::rules::progress::{PROGRESS_MIN_NM, REST_MS, TURN_CHECK_URAD, WINDOW_MS};
use crate::rules::stall::STALL_DUTY;
use crate::timing::Deadline;

/// Share of a turn that the gyro must confirm.
const CONFIRMED_SHARE: i64 = 10;

/// Progress since the last anchor.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ProgressRule {
    anchor: Option<Anchor>,
    left_nm: i64,
    right_nm: i64,
    turned_urad: i64,
    rest: Deadline,
}

#[derive(Clone, Copy, Debug)]
struct Anchor {
    tick: Tick,
    heading: Option<Angle>,
}

/// What the rule looks at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Headway {
    /// Larger duty of the two wheels, in millionths.
    pub(crate) duty: i32,
    /// Distance of the left rim in this period.
    pub(crate) left_nm: i32,
    /// Distance of the right rim in this period.
    pub(crate) right_nm: i32,
    /// Distance between the wheels.
    pub(crate) track_um: i32,
    /// Gyro, if any.
    pub(crate) gyro: Option<Gyro>,
}

impl ProgressRule {
    /// Returns whether the robot makes no progress; true during the 1 s of rest as well.
    pub(crate) fn update(&mut self, headway: Headway, now: Tick) -> bool {
        self.rest.has_come(now);
        if headway.duty < STALL_DUTY {
            self.anchor = None;
            return self.rest.is_running();
        }
        let heading = headway.gyro.map(|gyro| gyro.heading);
        let anchor = *self.anchor.get_or_insert(Anchor { tick: now, heading });
        if anchor.tick == now {
            (self.left_nm, self.right_nm, self.turned_urad) = (0, 0, 0);
        }
        self.add(headway);
        if self.left_nm.saturating_abs().max(self.right_nm.saturating_abs()) >= PROGRESS_MIN_NM
            && self.turned_urad.saturating_abs() < TURN_CHECK_URAD
        {
            self.move_anchor(now);
        } else if self.is_turn_unconfirmed(anchor.heading, heading) || now.since(anchor.tick) >= WINDOW_MS {
            self.anchor = None;
            self.rest = Deadline::at(now.after(REST_MS));
        } else if self.turned_urad.saturating_abs() >= TURN_CHECK_URAD {
            self.anchor = None;
        }
        self.rest.is_running()
    }

    fn add(&mut self, headway: Headway) {
        let (left_nm, right_nm) = (i64::from(headway.left_nm), i64::from(headway.right_nm));
        self.left_nm = self.left_nm.saturating_add(left_nm);
        self.right_nm = self.right_nm.saturating_add(right_nm);
        let track_um = i64::from(headway.track_um.max(1));
        let turned_urad = right_nm.saturating_sub(left_nm).saturating_mul(1_000) / track_um;
        self.turned_urad = self.turned_urad.saturating_add(turned_urad);
    }

    /// The robot has moved: the window starts again, while the check of the turn goes on.
    fn move_anchor(&mut self, now: Tick) {
        (self.left_nm, self.right_nm) = (0, 0);
        if let Some(anchor) = &mut self.anchor {
            anchor.tick = now;
        }
    }

    fn is_turn_unconfirmed(&self, from: Option<Angle>, to: Option<Angle>) -> bool {
        let (Some(from), Some(to)) = (from, to) else {
            return false;
        };
        let seen_urad = i64::from(to.0.wrapping_sub(from.0));
        let turned_urad = self.turned_urad.saturating_abs();
        let along_urad = seen_urad.saturating_mul(self.turned_urad.signum());
        turned_urad >= TURN_CHECK_URAD && along_urad < turned_urad / CONFIRMED_SHARE
    }
}
