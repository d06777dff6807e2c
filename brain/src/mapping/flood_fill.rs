//! Flood fill: everything that is connected to a start over passable neighbours.

/// A flood fill over indexed places, in progress.
#[derive(Debug)]
pub(crate) struct FloodFill {
    reached: Vec<bool>,
    /// Reached places whose neighbours were not visited yet.
    waiting: Vec<usize>,
}

impl FloodFill {
    /// A fill over this many places, none of them reached.
    pub(crate) fn over(places: usize) -> Self {
        Self {
            reached: vec![false; places],
            waiting: Vec::new(),
        }
    }

    /// Marks a place as reached, unless it already is.
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

    /// Whether the fill is complete.
    pub(crate) fn is_done(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Expands the place reached last: reaches its passable neighbours. Returns the place; `None` at the end.
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

    /// Whether each place was reached.
    pub(crate) fn into_reached(self) -> Vec<bool> {
        self.reached
    }
}
