//! What the wheels roll on.

/// A kind of floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Surface {
    /// Extra force that the surface takes from each wheel, newton.
    pub(crate) drag_n: f64,
    /// Share of the rim's way that is lost to slip.
    pub(crate) slip: f64,
    /// Heading that the nap adds, radians per metre of way.
    pub(crate) bias_rad_per_m: f64,
    /// So dark that a cliff sensor sees no floor.
    pub(crate) black: bool,
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
