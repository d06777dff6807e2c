//! How well the believed way fits the true one when it is laid over it as a whole: an error of the map's frame, which the
//! robot's own map shares, is none to the robot.

use home::Pose;

/// Sums over pairs of believed and true places.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Alignment {
    count: f64,
    believed: [f64; 2],
    is: [f64; 2],
    squares: f64,
    /// Of the products along, and of those across.
    dot: f64,
    cross: f64,
}

impl Alignment {
    pub(super) fn sample(&mut self, believed: Pose, is: Pose) {
        let ([a, b], [x, y]) = ([believed.x_m, believed.y_m], [is.x_m, is.y_m]);
        self.count += 1.0;
        self.believed = [self.believed[0] + a, self.believed[1] + b];
        self.is = [self.is[0] + x, self.is[1] + y];
        self.squares += a * a + b * b + x * x + y * y;
        self.dot += a * x + b * y;
        self.cross += a * y - b * x;
    }

    /// Root mean square of the distances that are left; `None` without samples.
    pub(super) fn rmse_m(&self) -> Option<f64> {
        if self.count == 0.0 {
            return None;
        }
        let ([a, b], [x, y]) = (self.believed, self.is);
        let squares = self.squares - (a * a + b * b + x * x + y * y) / self.count;
        let dot = self.dot - (a * x + b * y) / self.count;
        let cross = self.cross - (a * y - b * x) / self.count;
        Some(((squares - 2.0 * dot.hypot(cross)) / self.count).max(0.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::Alignment;
    use home::Pose;

    #[test]
    fn a_frame_that_is_turned_and_shifted_is_no_error_and_what_bends_is() {
        let way = |bend: f64| {
            let mut alignment = Alignment::default();
            for step in 0..100 {
                let (x_m, y_m) = (0.1 * f64::from(step), 3.0 * f64::from(step % 2));
                let (sin, cos) = 0.3_f64.sin_cos();
                let turned = Pose::new(x_m * cos - y_m * sin + 5.0, x_m * sin + y_m * cos - 1.0, 0.0);
                let is = Pose::new(x_m, y_m + bend * x_m * x_m, 0.0);
                alignment.sample(turned, is);
            }
            alignment.rmse_m().unwrap()
        };
        assert!(way(0.0) < 1e-5, "{}", way(0.0));
        assert!(way(0.02) > 0.1, "{}", way(0.02));
        assert_eq!(Alignment::default().rmse_m(), None);
    }
}
