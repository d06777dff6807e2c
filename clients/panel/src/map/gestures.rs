//! Fingers and mouse on the map: one drags, two zoom and turn.

use panel_logic::Pixel;

/// A finger or a mouse button that is down.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Touch {
    id: i32,
    at: Pixel,
}

/// What a movement means for the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Movement {
    /// Nothing.
    Nothing,
    /// The map is dragged by these pixels.
    Drag { dx: f64, dy: f64 },
    /// The map is zoomed about a pixel, dragged along, and turned.
    Pinch {
        at: Pixel,
        factor: f64,
        dx: f64,
        dy: f64,
        turn_rad: f64,
    },
}

/// Everything that is down.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gestures {
    touches: Vec<Touch>,
}

impl Gestures {
    pub(crate) fn down(&mut self, id: i32, at: Pixel) {
        self.up(id);
        self.touches.push(Touch { id, at });
    }

    pub(crate) fn up(&mut self, id: i32) {
        self.touches.retain(|touch| touch.id != id);
    }

    /// Whether exactly one finger is down.
    pub(crate) fn is_single(&self) -> bool {
        self.touches.len() == 1
    }

    /// A touch moved to a pixel.
    pub(crate) fn moved(&mut self, id: i32, to: Pixel) -> Movement {
        let before = self.touches.clone();
        let Some(touch) = self.touches.iter_mut().find(|touch| touch.id == id) else {
            return Movement::Nothing;
        };
        let (dx, dy) = (to.x - touch.at.x, to.y - touch.at.y);
        touch.at = to;
        match (before.as_slice(), self.touches.as_slice()) {
            ([_], [_]) => Movement::Drag { dx, dy },
            ([a0, b0, ..], [a1, b1, ..]) => {
                let (a0, b0, a1, b1) = (a0.at, b0.at, a1.at, b1.at);
                let spread = |a: Pixel, b: Pixel| (a.x - b.x).hypot(a.y - b.y).max(1.0);
                let angle = |a: Pixel, b: Pixel| (b.y - a.y).atan2(b.x - a.x);
                let turn_rad = angle(a1, b1) - angle(a0, b0);
                let at = Pixel::new(f64::midpoint(a1.x, b1.x), f64::midpoint(a1.y, b1.y));
                Movement::Pinch {
                    at,
                    factor: spread(a1, b1) / spread(a0, b0),
                    dx: dx / 2.0,
                    dy: dy / 2.0,
                    // Across the jump from one side to the other.
                    turn_rad: turn_rad.sin().atan2(turn_rad.cos()),
                }
            }
            _ => Movement::Nothing,
        }
    }
}
