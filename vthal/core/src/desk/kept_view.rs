//! A view that is costly to draw, kept for those who ask for it soon.

/// How long a view of the same version is new enough: what has no version of its own, the sureness above all, is seconds old at most.
const NEW_ENOUGH_US: u64 = 5_000_000;

/// The view that was drawn last.
#[derive(Debug)]
pub(crate) struct KeptView<V, T> {
    drawn: Option<(V, u64, T)>,
}

impl<V, T> Default for KeptView<V, T> {
    fn default() -> Self {
        Self { drawn: None }
    }
}

impl<V: PartialEq, T: Clone> KeptView<V, T> {
    /// The view of this version, drawn anew when there is none that is new enough.
    pub(crate) fn at(&mut self, (version, now_us): (V, u64), draw: impl FnOnce() -> Option<T>) -> Option<T> {
        let is_new_enough = self.drawn.as_ref().is_some_and(|(drawn, then_us, _)| {
            *drawn == version && now_us.saturating_sub(*then_us) < NEW_ENOUGH_US
        });
        if !is_new_enough {
            self.drawn = draw().map(|view| (version, now_us, view));
        }
        self.drawn.as_ref().map(|(_, _, view)| view.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::{KeptView, NEW_ENOUGH_US};

    #[test]
    fn a_crowd_that_asks_has_it_drawn_once_and_a_change_or_time_has_it_drawn_anew() {
        let mut view = KeptView::default();
        let mut drawn = 0;
        let mut ask = |version: u32, now_us: u64| {
            view.at((version, now_us), || {
                drawn += 1;
                Some(drawn)
            })
        };
        for now_us in 0..100 {
            assert_eq!(ask(1, now_us), Some(1));
        }
        assert_eq!(ask(2, 100), Some(2));
        assert_eq!(ask(2, 99 + NEW_ENOUGH_US), Some(2));
        assert_eq!(ask(2, 100 + NEW_ENOUGH_US), Some(3));
    }

    #[test]
    fn what_cannot_be_drawn_is_not_kept() {
        let mut view = KeptView::default();
        assert_eq!(view.at((1, 0), || None), None::<u32>);
        assert_eq!(view.at((1, 0), || Some(7)), Some(7));
        assert_eq!(view.at((2, 0), || None), None);
    }
}
