//! Which part of the map is seen, and how large.

/// Pixels per metre, smallest and largest: a house of 150 m on a phone, and a cell of 5 cm as large as a thumb.
const SCALE_MIN: f64 = 2.0;
const SCALE_MAX: f64 = 1000.0;

/// Share of the view that [`Camera::fit`] leaves free on each side.
const FIT_MARGIN: f64 = 0.06;

/// A rectangle on the map in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest x.
    pub x_min: f64,
    /// Lowest y.
    pub y_min: f64,
    /// Highest x.
    pub x_max: f64,
    /// Highest y.
    pub y_max: f64,
}

impl Bounds {
    /// A square around a point.
    #[must_use]
    pub fn around(x: f64, y: f64, radius: f64) -> Self {
        Self {
            x_min: x - radius,
            y_min: y - radius,
            x_max: x + radius,
            y_max: y + radius,
        }
    }

    /// The smallest rectangle that holds both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self {
            x_min: self.x_min.min(other.x_min),
            y_min: self.y_min.min(other.y_min),
            x_max: self.x_max.max(other.x_max),
            y_max: self.y_max.max(other.y_max),
        }
    }
}

/// Size of the canvas in CSS pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Pixels across.
    pub width: f64,
    /// Pixels down.
    pub height: f64,
}

/// The camera. Map y points up, screen y points down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    view: View,
    x: f64,
    y: f64,
    scale: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            view: View {
                width: 1.0,
                height: 1.0,
            },
            x: 0.0,
            y: 0.0,
            scale: 80.0,
        }
    }
}

impl Camera {
    /// Size of the canvas.
    #[must_use]
    pub const fn view(&self) -> View {
        self.view
    }

    /// Pixels per metre.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.scale
    }

    /// The point of the map in the middle of the canvas.
    #[must_use]
    pub const fn middle(&self) -> (f64, f64) {
        (self.x, self.y)
    }

    /// Takes a new size of the canvas; the middle stays.
    pub fn resize(&mut self, view: View) {
        self.view = View {
            width: view.width.max(1.0),
            height: view.height.max(1.0),
        };
    }

    /// The point of the map under a pixel.
    #[must_use]
    pub fn map_from_screen(&self, px: f64, py: f64) -> (f64, f64) {
        let x = self.x + (px - self.view.width / 2.0) / self.scale;
        let y = self.y - (py - self.view.height / 2.0) / self.scale;
        (x, y)
    }

    /// The pixel that shows a point of the map.
    #[must_use]
    pub fn screen_from_map(&self, x: f64, y: f64) -> (f64, f64) {
        let px = self.view.width / 2.0 + (x - self.x) * self.scale;
        let py = self.view.height / 2.0 - (y - self.y) * self.scale;
        (px, py)
    }

    /// Zooms by `factor`; the point under the pixel stays there.
    pub fn zoom_at(&mut self, (px, py): (f64, f64), factor: f64) {
        let (x, y) = self.map_from_screen(px, py);
        self.scale = (self.scale * factor).clamp(SCALE_MIN, SCALE_MAX);
        let (moved_x, moved_y) = self.map_from_screen(px, py);
        self.x += x - moved_x;
        self.y += y - moved_y;
    }

    /// Zooms by `factor` about the middle.
    pub fn zoom(&mut self, factor: f64) {
        self.zoom_at((self.view.width / 2.0, self.view.height / 2.0), factor);
    }

    /// Moves the map by pixels, as a finger drags it.
    pub fn drag(&mut self, dx: f64, dy: f64) {
        self.x -= dx / self.scale;
        self.y += dy / self.scale;
    }

    /// Shows all of `bounds` with a margin.
    pub fn fit(&mut self, bounds: Bounds) {
        let free = 1.0 - 2.0 * FIT_MARGIN;
        let width = (bounds.x_max - bounds.x_min).max(0.5);
        let height = (bounds.y_max - bounds.y_min).max(0.5);
        let scale = (self.view.width * free / width).min(self.view.height * free / height);
        self.scale = scale.clamp(SCALE_MIN, SCALE_MAX);
        self.x = f64::midpoint(bounds.x_min, bounds.x_max);
        self.y = f64::midpoint(bounds.y_min, bounds.y_max);
    }

    /// Comes nearer to having a point in the middle: all the way in about half a second of calls with `elapsed_s` each.
    pub fn follow(&mut self, (x, y): (f64, f64), elapsed_s: f64) {
        let share = 1.0 - (-elapsed_s * 8.0).exp();
        self.x += (x - self.x) * share;
        self.y += (y - self.y) * share;
    }
}

#[cfg(test)]
mod tests {
    use super::{Bounds, Camera, SCALE_MAX, View};

    fn camera() -> Camera {
        let mut camera = Camera::default();
        camera.resize(View {
            width: 800.0,
            height: 600.0,
        });
        camera
    }

    #[track_caller]
    fn near(a: (f64, f64), b: (f64, f64)) {
        assert!(
            (a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9,
            "{a:?} {b:?}"
        );
    }

    #[test]
    fn screen_and_map_are_inverse_and_y_is_turned() {
        let camera = camera();
        near(camera.screen_from_map(0.0, 0.0), (400.0, 300.0));
        near(camera.screen_from_map(1.0, 1.0), (480.0, 220.0));
        near(camera.map_from_screen(480.0, 220.0), (1.0, 1.0));
    }

    #[test]
    fn the_point_under_the_pointer_stays_even_at_the_limit() {
        let mut camera = camera();
        let before = camera.map_from_screen(100.0, 50.0);
        for _ in 0..50 {
            camera.zoom_at((100.0, 50.0), 1.3);
            near(camera.map_from_screen(100.0, 50.0), before);
        }
        assert_eq!(camera.scale(), SCALE_MAX);
    }

    #[test]
    fn fit_shows_the_corners() {
        let mut camera = camera();
        camera.fit(Bounds {
            x_min: -3.0,
            y_min: 2.0,
            x_max: 9.0,
            y_max: 5.0,
        });
        for (x, y) in [(-3.0, 2.0), (9.0, 5.0)] {
            let (px, py) = camera.screen_from_map(x, y);
            assert!((0.0..=800.0).contains(&px) && (0.0..=600.0).contains(&py));
        }
    }

    #[test]
    fn a_drag_takes_the_map_along() {
        let mut camera = camera();
        let grabbed = camera.map_from_screen(10.0, 20.0);
        camera.drag(30.0, -7.0);
        near(camera.map_from_screen(40.0, 13.0), grabbed);
    }

    #[test]
    fn following_arrives() {
        let mut camera = camera();
        for _ in 0..60 {
            camera.follow((5.0, -2.0), 1.0 / 60.0);
        }
        let (x, y) = camera.middle();
        assert!((x - 5.0).abs() < 0.01 && (y + 2.0).abs() < 0.01);
    }
}
