//! Surfaces under the wheels.

/// A kind of floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Surface {
    /// Extra force that the surface takes from each wheel, newton.
    pub(crate) drag_n: f64,
    /// Share of the rim's distance that is lost to slip.
    pub(crate) slip: f64,
    /// Heading that the nap adds, radians per metre.
    pub(crate) bias_rad_per_m: f64,
    /// So dark that a cliff sensor detects no floor.
    pub(crate) black: bool,
    /// How much more the main brush draws on it than on hard floor, relative.
    pub(crate) brush_load: f64,
}

/// What any pile takes from a brush, and what each newton takes that the pile takes from a wheel, relative to hard
/// floor. Assumed, not measured on this robot: the bristles then turn in a pile instead of over a plane. So a flat
/// woven mat of 0.4 N loads the brush by a third more, and a deep pile of 1.8 N twice as much as hard floor does. That
/// the roller's current steps up from hard floor to carpet and again with the pile is what makers of cleaners report
/// floors by (US 11882986).
const BRUSH_LOAD_OF_PILE: f64 = 0.15;
const BRUSH_LOAD_PER_N: f64 = 0.5;

impl Surface {
    /// How much more the main brush draws on a rug that takes this force from each wheel.
    pub(crate) const fn brush_load_of_rug(drag_n: f64) -> f64 {
        BRUSH_LOAD_OF_PILE + BRUSH_LOAD_PER_N * drag_n
    }
}

/// Surface of every cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfaceMap {
    /// Kinds; kind 0 is hard floor.
    kinds: Vec<Surface>,
    /// Kind of each cell; empty when all is hard floor.
    cells: Vec<u8>,
}

impl SurfaceMap {
    /// All hard floor.
    pub(crate) fn hard() -> Self {
        Self::default()
    }

    /// Whether there is nothing but hard floor.
    pub(crate) fn is_hard(&self) -> bool {
        self.cells.is_empty()
    }

    /// Whether any of it is black.
    pub(crate) fn has_black(&self) -> bool {
        self.kinds.iter().any(|kind| kind.black)
    }

    /// Surface of a cell.
    pub(crate) fn at(&self, index: usize) -> Surface {
        let kind = self.cells.get(index).copied().unwrap_or(0);
        self.kinds.get(usize::from(kind)).copied().unwrap_or_default()
    }

    /// A new kind for a grid of `cells` cells; `None` when there are 255 kinds already.
    pub(crate) fn add_kind(&mut self, surface: Surface, cells: usize) -> Option<u8> {
        if self.kinds.is_empty() {
            self.kinds.push(Surface::default());
            self.cells = vec![0; cells];
        }
        let kind = u8::try_from(self.kinds.len()).ok()?;
        self.kinds.push(surface);
        Some(kind)
    }

    /// Lays a kind on a cell.
    pub(crate) fn lay(&mut self, index: usize, kind: u8) {
        if let Some(cell) = self.cells.get_mut(index) {
            *cell = kind;
        }
    }
}
