//! Letting a home in by Matter, as its page shows it.

use rvac_api::MatterInvitation;

use crate::qr::QrPicture;
use crate::words::Words;

/// All that is shown of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MatterSight {
    /// What a person can do.
    pub text: String,
    /// The code for a camera, while a home can join.
    pub picture: Option<QrPicture>,
    /// The same as digits.
    pub digits: Option<String>,
}

/// What is shown of what `rvac-matter` says.
#[must_use]
pub fn matter_sight(words: &Words, told: &MatterInvitation) -> MatterSight {
    let words = &words.matter;
    let code = told.code.as_deref().filter(|_| told.open_s > 0);
    let text = match (code, told.joined) {
        (Some(_), _) => words.how.fill([&told.open_s.div_ceil(60)]),
        (None, true) => words.joined.to_owned(),
        (None, false) => words.closed.to_owned(),
    };
    MatterSight {
        text,
        picture: code.and_then(QrPicture::of),
        digits: told.digits.clone().filter(|_| code.is_some()),
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::MatterInvitation;

    use super::matter_sight;
    use crate::words::Language;

    #[test]
    fn the_code_is_shown_while_a_home_can_join_and_then_what_to_do() {
        let words = Language::English.words();
        let open = MatterInvitation {
            code: Some("MT:-24J0AFN00KA0648G00".to_owned()),
            digits: Some("3497-011-2332".to_owned()),
            open_s: 61,
            joined: false,
        };
        let shown = matter_sight(words, &open);
        assert!(shown.text.contains("For 2\u{a0}min more"), "{shown:?}");
        assert!(shown.picture.is_some());
        assert_eq!(shown.digits.as_deref(), Some("3497-011-2332"));
        let over = MatterInvitation { open_s: 0, ..open };
        let shown = matter_sight(words, &over);
        assert!(shown.text.contains("Start rvac-matter again"), "{shown:?}");
        assert_eq!((shown.picture, shown.digits), (None, None));
        let joined = MatterInvitation {
            joined: true,
            ..MatterInvitation::default()
        };
        let shown = matter_sight(words, &joined);
        assert!(shown.text.contains("has joined a home"), "{shown:?}");
        assert_eq!(shown.picture, None);
    }
}
