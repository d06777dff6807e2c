//! The one button that goes on with whatever is next: it changes what it does and never its place.

use rvac_api::Status;

use crate::offers::{Offer, Offers, Wait};
use crate::words::Words;

/// What the button does now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primary {
    /// Cleans the whole home.
    Start,
    /// Cleans what is chosen.
    CleanSelected,
    /// Pauses the job.
    Pause,
    /// Goes on with it.
    Resume,
}

/// What a person has chosen or draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wishes {
    /// Rooms, zones or spots are chosen.
    pub chosen: bool,
    /// Something is being drawn and not finished.
    pub drawing: bool,
}

impl Primary {
    /// What it does in this state.
    #[must_use]
    pub fn of(status: Option<&Status>, wishes: Wishes) -> Self {
        match status.map_or("disconnected", |status| status.state.as_str()) {
            "paused" => Self::Resume,
            "starting" | "cleaning" | "spot" | "going" | "docking" => Self::Pause,
            _ if wishes.chosen => Self::CleanSelected,
            _ => Self::Start,
        }
    }

    /// Whether it can be pressed. A drawing that is not finished is never dropped for a job of the whole home.
    #[must_use]
    pub const fn offer(self, offers: &Offers, wishes: Wishes) -> Offer {
        match (self, offers.start) {
            (Self::Pause | Self::Resume, _) => offers.pause,
            (Self::Start | Self::CleanSelected, Offer::Ready) if wishes.drawing => {
                Offer::NotNow(Wait::Drawing)
            }
            (Self::Start | Self::CleanSelected, start) => start,
        }
    }

    /// Its name in the page.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::CleanSelected => "clean-chosen",
            Self::Pause | Self::Resume => "pause",
        }
    }

    /// The word of its request.
    #[must_use]
    pub const fn verb(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::CleanSelected => "clean",
            Self::Pause => "pause",
            Self::Resume => "resume",
        }
    }

    /// What stands on it.
    #[must_use]
    pub const fn label(self, words: &Words) -> &'static str {
        match self {
            Self::Start => words.action.start,
            Self::CleanSelected => words.map.clean_selected,
            Self::Pause => words.action.pause,
            Self::Resume => words.action.resume,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Primary, Wishes};
    use crate::offers::{Offer, Offers, Wait};
    use rvac_api::Status;

    fn status(state: &str) -> Status {
        Status {
            state: state.to_owned(),
            ..Status::default()
        }
    }

    #[test]
    fn it_does_what_comes_next() {
        let chosen = Wishes {
            chosen: true,
            drawing: false,
        };
        for (state, none, some) in [
            ("idle", Primary::Start, Primary::CleanSelected),
            ("docked", Primary::Start, Primary::CleanSelected),
            ("cleaning", Primary::Pause, Primary::Pause),
            ("starting", Primary::Pause, Primary::Pause),
            ("paused", Primary::Resume, Primary::Resume),
        ] {
            assert_eq!(Primary::of(Some(&status(state)), Wishes::default()), none);
            assert_eq!(Primary::of(Some(&status(state)), chosen), some);
        }
        assert_eq!(Primary::of(None, Wishes::default()), Primary::Start);
    }

    #[test]
    fn a_drawing_that_is_not_finished_holds_start_and_nothing_else() {
        let drawing = Wishes {
            chosen: false,
            drawing: true,
        };
        let idle = Offers::of(Some(&status("idle")), None);
        assert_eq!(Primary::Start.offer(&idle, drawing), Offer::NotNow(Wait::Drawing));
        assert_eq!(Primary::Start.offer(&idle, Wishes::default()), Offer::Ready);
        let runs = Offers::of(Some(&status("cleaning")), None);
        assert_eq!(Primary::Pause.offer(&runs, drawing), Offer::Ready);
        let away = Offers::of(None, None);
        assert_eq!(
            Primary::CleanSelected.offer(&away, drawing),
            Offer::NotNow(Wait::Away)
        );
    }
}
