//! Flood fill: all places that can be reached from one over neighbours.

/// A fill over numbered places, as far as it has got.
#[derive(Debug)]
pub(crate) struct FloodFill {
    reached: Vec<bool>,
    /// Places whose neighbours are still to be looked at.
    waiting: Vec<usize>,
}

impl FloodFill {
    /// One that has reached none of so many places.
    pub(crate) fn over(places: usize) -> Self {
        Self {
            reached: vec![false; places],
            waiting: Vec::new(),
        }
    }

    /// Reaches a place from outside, unless it has been reached before.
    pub(crate) fn reach(&mut self, place: usize) {
        if let Some(reached) = self.reached.get_mut(place)
            && !core::mem::replace(reached, true)
        {
            self.waiting.push(place);
        }
    }

    pub(crate) fn has_reached(&self, place: usize) -> bool {
        self.reached.get(place) == Some(&true)
    }

    /// Whether nothing more can be reached.
    pub(crate) fn is_done(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Goes on from the place that was reached last: reaches those of its neighbours that are passable, and gives the place; `None`
    /// at the end.
    pub(crate) fn go_on<Places: IntoIterator<Item = usize>>(
        &mut self,
        neighbours: impl FnOnce(usize) -> Places,
        is_passable: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let place = self.waiting.pop()?;
        for neighbour in neighbours(place) {
            if is_passable(neighbour) {
                self.reach(neighbour);
            }
        }
        Some(place)
    }

    /// Which places it has reached.
    pub(crate) fn into_reached(self) -> Vec<bool> {
        self.reached
    }
}
