//! Whether the wheels turn, and in which direction, from the reports.

use super::{Drive, Odometry, Report, WheelSpeeds};

/// Reports farther apart give no speed.
const GAP_MAX_US: u64 = 10_000_000;

/// Watches the totals of the wheels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WheelWatch {
    last: Option<Seen>,
    /// Signed distance of both rims, where the robot reports no sign.
    sum_m: [f64; 2],
    /// Directions of the last command that turned the wheels.
    signs: [f64; 2],
    turned: bool,
    still_reports: u32,
}

/// Values of a report.
#[derive(Clone, Copy, Debug)]
struct Seen {
    at_us: u64,
    rims_m: [f64; 2],
}

impl WheelWatch {
    /// The commanded wheel speeds. A wheel that is commanded to stop rolls out in the direction in which it turned.
    pub(super) fn commanded(&mut self, drive: Drive, track_m: f64) {
        for (sign, rim_m_per_s) in self.signs.iter_mut().zip(drive.rims_m_per_s(track_m)) {
            if rim_m_per_s != 0.0 {
                *sign = rim_m_per_s.signum();
            }
        }
    }

    /// Takes a report; adds the sign and the speeds that the robot does not report.
    pub(super) fn take(&mut self, now_us: u64, report: &mut Report, odometry: Odometry) {
        let rims_m = [report.travel.left_m, report.travel.right_m];
        let before = self.last.replace(Seen {
            at_us: now_us,
            rims_m,
        });
        let travels_m = before.map(|before| [0, 1].map(|rim| rims_m[rim] - before.rims_m[rim]));
        if let Some(travels_m) = travels_m {
            self.turned = travels_m
                .iter()
                .any(|travel_m| travel_m.abs() > 0.5 * odometry.resolution_m);
            self.still_reports = if self.turned || report.is_driven {
                0
            } else {
                self.still_reports.saturating_add(1)
            };
        }
        let travels_m = match odometry.sign_reliable {
            true => travels_m,
            false => Some(self.sign(travels_m.unwrap_or_default(), report)),
        };
        if let (None, Some(travels_m), Some(before)) = (report.travel.speeds, travels_m, before) {
            report.travel.speeds = speeds(travels_m, now_us.saturating_sub(before.at_us));
        }
    }

    fn sign(&mut self, travels_m: [f64; 2], report: &mut Report) -> [f64; 2] {
        let signed_m = [0, 1].map(|rim| self.signs[rim] * travels_m[rim].abs());
        for (sum_m, travel_m) in self.sum_m.iter_mut().zip(signed_m) {
            *sum_m += travel_m;
        }
        [report.travel.left_m, report.travel.right_m] = self.sum_m;
        signed_m
    }

    /// Whether a wheel has turned between the last two reports.
    pub(super) const fn turned(&self) -> bool {
        self.turned
    }

    /// Reports in a row in which no wheel turns and none is driven.
    pub(super) const fn still_reports(&self) -> u32 {
        self.still_reports
    }

    /// Only reports from now on count for [`Self::still_reports`].
    pub(super) const fn forget_stillness(&mut self) {
        self.still_reports = 0;
        self.last = None;
    }

    /// The next report says nothing about the time before.
    pub(super) const fn rebase(&mut self) {
        self.last = None;
        self.turned = false;
    }
}

fn speeds([left_m, right_m]: [f64; 2], time_us: u64) -> Option<WheelSpeeds> {
    let time_s = time_us as f64 * 1e-6;
    (time_us > 0 && time_us < GAP_MAX_US).then_some(WheelSpeeds {
        left_m_per_s: left_m / time_s,
        right_m_per_s: right_m / time_s,
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Drive, Odometry, Report, WheelSpeeds, WheelTravel};
    use super::WheelWatch;

    const MILLIMETRES: Odometry = Odometry {
        resolution_m: 0.001,
        sign_reliable: false,
    };

    fn report(left_m: f64, right_m: f64) -> Report {
        Report {
            travel: WheelTravel {
                left_m,
                right_m,
                speeds: None,
            },
            ..Report::default()
        }
    }

    #[test]
    fn totals_without_a_sign_get_that_of_the_command() {
        let mut watch = WheelWatch::default();
        watch.take(0, &mut report(5.0, 5.0), MILLIMETRES);
        let turn_left = Drive {
            speed_m_per_s: 0.0,
            turn_rad_per_s: 1.0,
        };
        watch.commanded(turn_left, 0.25);
        let mut turned = report(5.1, 5.1);
        watch.take(100_000, &mut turned, MILLIMETRES);
        let WheelTravel {
            left_m,
            right_m,
            speeds,
        } = turned.travel;
        assert!((left_m + 0.1).abs() < 1e-9 && (right_m - 0.1).abs() < 1e-9);
        let WheelSpeeds { left_m_per_s, .. } = speeds.expect("two reports");
        assert!((left_m_per_s + 1.0).abs() < 1e-9);
        watch.commanded(Drive::STAND, 0.25);
        let mut rolled_out = report(5.12, 5.12);
        watch.take(200_000, &mut rolled_out, MILLIMETRES);
        assert!((rolled_out.travel.left_m + 0.12).abs() < 1e-9);
    }

    #[test]
    fn stillness_is_counted_from_when_it_is_asked_for() {
        let mut watch = WheelWatch::default();
        for at_us in 0..3 {
            watch.take(at_us, &mut report(1.0, 1.0), MILLIMETRES);
        }
        assert_eq!(watch.still_reports(), 2);
        watch.forget_stillness();
        watch.take(3, &mut report(1.0, 1.0), MILLIMETRES);
        assert_eq!(watch.still_reports(), 0);
        watch.take(4, &mut report(1.002, 1.0), MILLIMETRES);
        assert!(watch.turned() && watch.still_reports() == 0);
        watch.take(5, &mut report(1.002, 1.0), MILLIMETRES);
        assert_eq!(watch.still_reports(), 1);
    }
}
