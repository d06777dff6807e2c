//! Icons as inline drawings of 24 by 24. They say nothing to a screen reader: the text beside them does.

use leptos::prelude::*;

/// What an icon shows, as the data of one path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Icon {
    Play,
    Pause,
    Stop,
    Spot,
    Dock,
    Bell,
    Plus,
    Minus,
    Fit,
    Follow,
    Sun,
    Moon,
    Globe,
    Close,
    Reshape,
    Warning,
    Undo,
    Redo,
    More,
    Up,
}

impl Icon {
    const fn path(self) -> &'static str {
        match self {
            Self::Play => "M8 5.5v13l10.5-6.5z",
            Self::Pause => "M8.5 5.5v13M15.5 5.5v13",
            Self::Stop => "M7 7h10v10H7z",
            Self::Spot => "M12 12m-2 0a2 2 0 1 0 4 0a2 2 0 1 0-4 0M12 4a8 8 0 1 1-8 8M12 8a4 4 0 1 0 4 4",
            Self::Dock => "M4 11l8-6.5 8 6.5M6.5 9.5V19h11V9.5M12.5 11l-2 3h3l-2 3",
            Self::Bell => "M6.5 16.5V11a5.5 5.5 0 0 1 11 0v5.5l1.5 1.5H5zM10.5 20.5h3",
            Self::Plus => "M12 5v14M5 12h14",
            Self::Minus => "M5 12h14",
            Self::Fit => "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
            Self::Follow => "M12 3v4M12 17v4M3 12h4M17 12h4M12 12m-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0",
            Self::Sun => {
                "M12 12m-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0M12 2.5v2M12 19.5v2M2.5 12h2M19.5 12h2M5.3 5.3l1.4 1.4M17.3 17.3l1.4 1.4M5.3 18.7l1.4-1.4M17.3 6.7l1.4-1.4"
            }
            Self::Moon => "M19.5 14.5A8 8 0 0 1 9.5 4.5a8 8 0 1 0 10 10z",
            Self::Globe => {
                "M12 12m-8.5 0a8.5 8.5 0 1 0 17 0a8.5 8.5 0 1 0-17 0M3.5 12h17M12 3.5c3 2.6 4 5.4 4 8.5s-1 5.9-4 8.5M12 3.5c-3 2.6-4 5.4-4 8.5s1 5.9 4 8.5"
            }
            Self::Close => "M6 6l12 12M18 6L6 18",
            Self::Reshape => {
                "M7 5h10M19 7v10M17 19H7M5 17V7M3.5 3.5h3v3h-3zM17.5 3.5h3v3h-3zM17.5 17.5h3v3h-3zM3.5 17.5h3v3h-3z"
            }
            Self::Undo => "M8.5 5L4.5 9l4 4M5 9h9a5 5 0 0 1 0 10h-4",
            Self::Redo => "M15.5 5l4 4-4 4M19 9h-9a5 5 0 0 0 0 10h4",
            Self::More => "M5 12h.01M12 12h.01M19 12h.01",
            Self::Up => "M5 15l7-6 7 6",
            Self::Warning => "M12 4l9 15.5H3zM12 10v4.5M12 17v.5",
        }
    }
}

/// Draws an icon in the colour of the text around it.
pub(crate) fn icon(which: Icon) -> impl IntoView {
    view! {
        <svg class="icon" viewBox="0 0 24 24" width="20" height="20" aria-hidden="true" focusable="false">
            <path d=which.path() />
        </svg>
    }
}
