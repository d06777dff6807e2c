//! Whether the reported uncertainty of the pose is true: the normalized estimation error squared.
//!
//! Errors divided by their reported standard deviations and squared have the mean 1 for each dimension when the deviations are
//! true, more when they are too small. Only moments at which the robot claims to know its pose count.

/// Sums of one run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NeesWatch {
    place: f64,
    heading: f64,
    samples: u32,
}

/// What the robot reports of a pose's uncertainty.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sigma {
    /// Of the position along its worst direction, metres.
    pub(crate) place_m: f64,
    /// Of the heading, radians.
    pub(crate) heading_rad: f64,
}

/// Smallest deviation that is believed: half a millimetre, and a fiftieth of a degree.
const LEAST: Sigma = Sigma {
    place_m: 0.0005,
    heading_rad: 0.0003,
};

/// Error squared over variance, for each of the two dimensions of a position.
pub(super) fn of_place(error_m: f64, sigma_m: f64) -> f64 {
    0.5 * (error_m / sigma_m.max(LEAST.place_m)).powi(2)
}

impl Sigma {
    /// [`of_place`] with this deviation.
    pub(crate) fn nees_of_place(self, error_m: f64) -> f64 {
        of_place(error_m, self.place_m)
    }
}

impl NeesWatch {
    pub(super) fn sample(&mut self, error_m: f64, error_rad: f64, sigma: Sigma) {
        self.place += sigma.nees_of_place(error_m);
        self.heading += (error_rad / sigma.heading_rad.max(LEAST.heading_rad)).powi(2);
        self.samples += 1;
    }

    /// Means for position and heading, for each dimension; `None` without samples.
    pub(super) fn means(self) -> Option<(f64, f64)> {
        let count = f64::from(self.samples);
        (self.samples > 0).then(|| (self.place / count, self.heading / count))
    }
}

#[cfg(test)]
mod tests {
    use super::{NeesWatch, Sigma};
    use home::Pcg;

    fn mean(believed: f64) -> (f64, f64) {
        let (mut random, mut watch) = (Pcg::new(1, 1), NeesWatch::default());
        let sigma = Sigma {
            place_m: believed * 0.05,
            heading_rad: believed * 0.02,
        };
        for _ in 0..20_000 {
            let [x_m, y_m] = [random.normal(), random.normal()].map(|draw| 0.05 * draw);
            watch.sample(x_m.hypot(y_m), 0.02 * random.normal(), sigma);
        }
        watch.means().unwrap()
    }

    #[test]
    fn a_true_deviation_gives_1_and_one_that_is_three_times_too_small_gives_9() {
        let (place, heading) = mean(1.0);
        assert!(
            (place - 1.0).abs() < 0.03 && (heading - 1.0).abs() < 0.03,
            "{place}, {heading}"
        );
        let (place, heading) = mean(1.0 / 3.0);
        assert!(
            (place - 9.0).abs() < 0.3 && (heading - 9.0).abs() < 0.3,
            "{place}, {heading}"
        );
        assert_eq!(NeesWatch::default().means(), None);
    }
}
