//! Which part of the map is seen, how large, and from where: from straight above, or from an orbit around the middle.

use crate::orbit::{Orbit, Projection};
use crate::point::{MapPoint, Pixel};

/// Pixels per metre, smallest and largest: a house of 150 m on a phone, and a cell of 5 cm as large as a thumb.
const SCALE_MIN: f64 = 2.0;
const SCALE_MAX: f64 = 1000.0;

/// Share of the view that [`Camera::fit`] leaves free on each side.
const FIT_MARGIN: f64 = 0.06;
/// On the right it leaves at least so many pixels free: the buttons of the map are there, 46 wide and 16 from the edge.
const TOOLS_PX: f64 = 68.0;

/// Steps after which a picture from an orbit fits to a pixel or two.
const FIT_STEPS: usize = 12;

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

/// Sides of the screen that something covers, CSS pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenBox {
    /// Leftmost pixel.
    pub left: f64,
    /// Uppermost pixel.
    pub top: f64,
    /// Rightmost pixel.
    pub right: f64,
    /// Lowest pixel.
    pub bottom: f64,
}

/// The camera. Map y points up, screen y points down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    view: View,
    middle: MapPoint,
    scale: f64,
    orbit: Option<Orbit>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            view: View {
                width: 1.0,
                height: 1.0,
            },
            middle: MapPoint::new(0.0, 0.0),
            scale: 80.0,
            orbit: None,
        }
    }
}

impl Camera {
    /// Size of the canvas.
    #[must_use]
    pub const fn view(&self) -> View {
        self.view
    }

    /// Pixels per metre; seen from an orbit, those in the middle of the canvas.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.scale
    }

    /// The point of the map in the middle of the canvas.
    #[must_use]
    pub const fn middle(&self) -> MapPoint {
        self.middle
    }

    /// From where the map is seen; none for straight above.
    #[must_use]
    pub const fn orbit(&self) -> Option<Orbit> {
        self.orbit
    }

    /// Looks from there; the middle and its size stay.
    pub const fn look_from(&mut self, orbit: Option<Orbit>) {
        self.orbit = orbit;
    }

    /// Turns around the middle as a hand does that moves by these pixels. Nothing happens straight above.
    pub fn turn(&mut self, dx: f64, dy: f64) {
        self.orbit = self.orbit.map(|orbit| orbit.turned(dx, dy));
    }

    /// How the map gets to the screen at this moment.
    #[must_use]
    pub fn projection(&self) -> Projection {
        Projection::of(self.view, self.middle, self.scale, self.orbit)
    }

    /// Takes a new size of the canvas; the middle stays.
    pub fn resize(&mut self, view: View) {
        self.view = View {
            width: view.width.max(1.0),
            height: view.height.max(1.0),
        };
    }

    /// The point of the floor under a pixel.
    #[must_use]
    pub fn map_from_screen(&self, pixel: Pixel) -> MapPoint {
        self.projection().floor_under(pixel)
    }

    /// The pixel that shows a point of the floor.
    #[must_use]
    pub fn screen_from_map(&self, point: MapPoint) -> Pixel {
        self.projection().pixel_of([point.x, point.y, 0.0])
    }

    /// The part of the screen that things cover that are inside `bounds` and `height_m` high.
    #[must_use]
    pub fn screen_box(&self, bounds: Bounds, height_m: f64) -> ScreenBox {
        let projection = self.projection();
        let whole = ScreenBox {
            left: f64::INFINITY,
            top: f64::INFINITY,
            right: f64::NEG_INFINITY,
            bottom: f64::NEG_INFINITY,
        };
        corners(bounds, height_m).fold(whole, |covered, corner| {
            let pixel = projection.pixel_of(corner);
            ScreenBox {
                left: covered.left.min(pixel.x),
                top: covered.top.min(pixel.y),
                right: covered.right.max(pixel.x),
                bottom: covered.bottom.max(pixel.y),
            }
        })
    }

    /// Zooms by `factor`; the point under the pixel stays there.
    pub fn zoom_at(&mut self, pixel: Pixel, factor: f64) {
        let before = self.map_from_screen(pixel);
        self.scale = (self.scale * factor).clamp(SCALE_MIN, SCALE_MAX);
        let after = self.map_from_screen(pixel);
        self.middle.x += before.x - after.x;
        self.middle.y += before.y - after.y;
    }

    /// Zooms by `factor` about the middle.
    pub fn zoom(&mut self, factor: f64) {
        self.zoom_at(Pixel::new(self.view.width / 2.0, self.view.height / 2.0), factor);
    }

    /// Moves the map by pixels, as a finger drags it.
    pub fn drag(&mut self, dx: f64, dy: f64) {
        let (x, y) = self.projection().floor_shift(dx, dy);
        self.middle.x -= x;
        self.middle.y -= y;
    }

    /// Pixels that a map that fits may take, and how far its middle is left of that of the view.
    fn free_px(&self) -> (View, f64) {
        let View { width, height } = self.view;
        let left = FIT_MARGIN * width;
        // A view that is hardly wider than the buttons has not reached its size yet.
        let right = left.max(TOOLS_PX.min(width / 2.0));
        let free = View {
            width: width - left - right,
            height: height * (1.0 - 2.0 * FIT_MARGIN),
        };
        (free, (right - left) / 2.0)
    }

    /// Shows all of `bounds` with a margin.
    pub fn fit(&mut self, bounds: Bounds) {
        let (free, aside) = self.free_px();
        let width = (bounds.x_max - bounds.x_min).max(0.5);
        let height = (bounds.y_max - bounds.y_min).max(0.5);
        let scale = (free.width / width).min(free.height / height);
        self.scale = scale.clamp(SCALE_MIN, SCALE_MAX);
        self.middle.x = f64::midpoint(bounds.x_min, bounds.x_max) + aside / self.scale;
        self.middle.y = f64::midpoint(bounds.y_min, bounds.y_max);
        if self.orbit.is_some() {
            // What is near looks larger, so neither size nor middle follow from the bounds at once.
            for _ in 0..FIT_STEPS {
                self.fit_nearer(bounds);
            }
        }
    }

    fn fit_nearer(&mut self, bounds: Bounds) {
        let seen = self.screen_box(bounds, 0.0);
        let (free, aside) = self.free_px();
        let factor = (free.width / (seen.right - seen.left)).min(free.height / (seen.bottom - seen.top));
        let off = |low: f64, high: f64, size: f64| size / 2.0 - f64::midpoint(low, high);
        self.drag(
            off(seen.left, seen.right, self.view.width) - aside,
            off(seen.top, seen.bottom, self.view.height),
        );
        if factor.is_finite() {
            self.scale = (self.scale * factor.clamp(0.3, 3.0)).clamp(SCALE_MIN, SCALE_MAX);
        }
    }

    /// Moves towards having a point in the middle; calls with `elapsed_s` each get there in about half a second.
    pub fn follow(&mut self, point: MapPoint, elapsed_s: f64) {
        let share = 1.0 - (-elapsed_s * 8.0).exp();
        self.middle.x += (point.x - self.middle.x) * share;
        self.middle.y += (point.y - self.middle.y) * share;
    }
}

/// The corners of a box on the floor.
fn corners(bounds: Bounds, height_m: f64) -> impl Iterator<Item = [f64; 3]> {
    let sides = [
        (bounds.x_min, bounds.y_min),
        (bounds.x_max, bounds.y_min),
        (bounds.x_max, bounds.y_max),
        (bounds.x_min, bounds.y_max),
    ];
    sides
        .into_iter()
        .flat_map(move |(x, y)| [[x, y, 0.0], [x, y, height_m]])
}

#[cfg(test)]
mod tests {
    use super::{Bounds, Camera, SCALE_MAX, View};
    use crate::{MapPoint, Orbit, Pixel};

    fn camera() -> Camera {
        let mut camera = Camera::default();
        camera.resize(View {
            width: 800.0,
            height: 600.0,
        });
        camera
    }

    #[track_caller]
    fn near(a: MapPoint, b: MapPoint) {
        assert!(
            (a.x - b.x).abs() < 1e-9 && (a.y - b.y).abs() < 1e-9,
            "{a:?} {b:?}"
        );
    }

    #[test]
    fn screen_and_map_are_inverse_and_y_is_turned() {
        let camera = camera();
        for (point, pixel) in [
            (MapPoint::new(0.0, 0.0), Pixel::new(400.0, 300.0)),
            (MapPoint::new(1.0, 1.0), Pixel::new(480.0, 220.0)),
        ] {
            let seen = camera.screen_from_map(point);
            assert!(
                (seen.x - pixel.x).abs() < 1e-9 && (seen.y - pixel.y).abs() < 1e-9,
                "{seen:?} {pixel:?}"
            );
        }
        near(
            camera.map_from_screen(Pixel::new(480.0, 220.0)),
            MapPoint::new(1.0, 1.0),
        );
    }

    #[test]
    fn the_point_under_the_pointer_stays_even_at_the_limit() {
        let mut camera = camera();
        let before = camera.map_from_screen(Pixel::new(100.0, 50.0));
        for _ in 0..50 {
            camera.zoom_at(Pixel::new(100.0, 50.0), 1.3);
            near(camera.map_from_screen(Pixel::new(100.0, 50.0)), before);
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
            let pixel = camera.screen_from_map(MapPoint::new(x, y));
            assert!((0.0..=800.0).contains(&pixel.x) && (0.0..=600.0).contains(&pixel.y));
        }
    }

    #[test]
    fn what_fits_lies_beside_the_buttons_on_a_phone() {
        let mut camera = camera();
        camera.resize(View {
            width: 390.0,
            height: 388.0,
        });
        let bounds = Bounds {
            x_min: 0.0,
            y_min: 0.0,
            x_max: 8.0,
            y_max: 4.0,
        };
        for orbit in [None, Some(Orbit::default())] {
            camera.look_from(orbit);
            camera.fit(bounds);
            let seen = camera.screen_box(bounds, 0.0);
            assert!(seen.left > 20.0 && seen.right < 390.0 - 66.0, "{seen:?}");
        }
    }

    #[test]
    fn a_drag_takes_the_map_along() {
        let mut camera = camera();
        let grabbed = camera.map_from_screen(Pixel::new(10.0, 20.0));
        camera.drag(30.0, -7.0);
        near(camera.map_from_screen(Pixel::new(40.0, 13.0)), grabbed);
    }

    #[test]
    fn following_arrives() {
        let mut camera = camera();
        for _ in 0..60 {
            camera.follow(MapPoint::new(5.0, -2.0), 1.0 / 60.0);
        }
        let MapPoint { x, y } = camera.middle();
        assert!((x - 5.0).abs() < 0.01 && (y + 2.0).abs() < 0.01);
    }

    #[test]
    fn from_an_orbit_the_picture_fits_and_the_pointer_holds_what_it_grabbed() {
        let mut camera = camera();
        let bounds = Bounds {
            x_min: -4.0,
            y_min: 1.0,
            x_max: 9.0,
            y_max: 21.0,
        };
        for (turn, tilt) in [(0.0, 0.0), (130.0, -500.0), (-700.0, 40.0)] {
            camera.look_from(Some(Orbit::default()));
            camera.turn(turn, tilt);
            camera.fit(bounds);
            let seen = camera.screen_box(bounds, 0.0);
            assert!(seen.left >= 30.0 && seen.right <= 770.0, "{seen:?}");
            assert!(seen.top >= 20.0 && seen.bottom <= 580.0, "{seen:?}");
            assert!(
                seen.right - seen.left > 650.0 || seen.bottom - seen.top > 450.0,
                "{seen:?}"
            );
            let before = camera.map_from_screen(Pixel::new(200.0, 400.0));
            camera.zoom_at(Pixel::new(200.0, 400.0), 1.7);
            near(camera.map_from_screen(Pixel::new(200.0, 400.0)), before);
        }
    }
}
