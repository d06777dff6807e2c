//! Which pointer holds the stick on the screen.
//!
//! Browsers tell of the end of a hold in many ways, and of some ends not at all: WebKit begins to drag selected text and says
//! neither that the pointer went up nor that its capture is lost. Only the pointer that was pressed on the pad moves the knob,
//! and only while it says that it is pressed. Everything else lets go, and then only a new press takes hold.

/// What the browser tells of hands at the pad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PadEvent {
    /// A pointer was pressed on the pad.
    Pressed(Pointer),
    /// A pointer moved somewhere on the page.
    Moved(Pointer),
    /// The pointer of this number went up, was taken away by the system, is captured no more, or was pressed beside the pad.
    Ended(i32),
    /// A context menu is asked for.
    Menu,
    /// Something else has taken the pointer or the page away: a drag, a selection, another window, a hidden page.
    TakenAway,
}

/// A pointer at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// Its number.
    pub number: i32,
    /// What it is.
    pub kind: PointerKind,
    /// Which of its buttons are pressed, as `PointerEvent.buttons`. A finger or a pen on the screen presses the first one.
    pub buttons: u16,
    /// The knob under it, as from [`crate::knob_place`].
    pub place: [f64; 2],
}

/// What a pointer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointerKind {
    /// A finger. Browsers take one that is held still for the wish to see a menu.
    Finger,
    /// A mouse, a pen, or what the browser does not tell.
    Other,
}

/// The first button in `PointerEvent.buttons`.
const FIRST_BUTTON: u16 = 1;

impl Pointer {
    const fn is_pressed(&self) -> bool {
        self.buttons & FIRST_BUTTON != 0
    }
}

/// Who holds the knob.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Grip {
    holder: Option<Holder>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Holder {
    number: i32,
    kind: PointerKind,
}

impl Grip {
    /// Where the knob goes by this; none where it is.
    pub fn hear(&mut self, event: PadEvent) -> Option<[f64; 2]> {
        match event {
            PadEvent::Pressed(pointer) => self.press(pointer),
            PadEvent::Moved(pointer) => self.follow(pointer),
            PadEvent::Ended(number) => self.let_go_if(|holder| holder.number == number),
            // The page opens no menu for a finger that is held still, so the finger goes on.
            PadEvent::Menu => self.let_go_if(|holder| holder.kind != PointerKind::Finger),
            PadEvent::TakenAway => self.let_go_if(|_| true),
        }
    }

    /// Whether a pointer holds the knob.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.holder.is_some()
    }

    /// A second finger beside the first one changes nothing. A second press of the same pointer is a new hold: the end of the
    /// first one was not told.
    fn press(&mut self, pointer: Pointer) -> Option<[f64; 2]> {
        let is_taken = self.holder.is_some_and(|holder| holder.number != pointer.number);
        if is_taken || !pointer.is_pressed() {
            return None;
        }
        self.holder = Some(Holder {
            number: pointer.number,
            kind: pointer.kind,
        });
        Some(pointer.place)
    }

    fn follow(&mut self, pointer: Pointer) -> Option<[f64; 2]> {
        self.holder.filter(|holder| holder.number == pointer.number)?;
        if pointer.is_pressed() {
            return Some(pointer.place);
        }
        self.let_go_if(|_| true)
    }

    fn let_go_if(&mut self, ends: impl FnOnce(&Holder) -> bool) -> Option<[f64; 2]> {
        self.holder.take_if(|holder| ends(holder)).map(|_| [0.0, 0.0])
    }
}

#[cfg(test)]
mod tests {
    use super::{Grip, PadEvent, Pointer, PointerKind};

    const AHEAD: [f64; 2] = [0.0, -1.0];
    const REST: Option<[f64; 2]> = Some([0.0, 0.0]);

    fn mouse(buttons: u16) -> Pointer {
        Pointer {
            number: 1,
            kind: PointerKind::Other,
            buttons,
            place: AHEAD,
        }
    }

    fn held_by(pointer: Pointer) -> Grip {
        let mut grip = Grip::default();
        assert_eq!(grip.hear(PadEvent::Pressed(pointer)), Some(AHEAD));
        grip
    }

    #[test]
    fn each_end_lets_go_and_what_follows_moves_nothing() {
        for end in [
            PadEvent::Ended(1),
            PadEvent::Moved(mouse(0)),
            PadEvent::Moved(mouse(2)),
            PadEvent::Menu,
            PadEvent::TakenAway,
        ] {
            let mut grip = held_by(mouse(1));
            assert_eq!(grip.hear(PadEvent::Moved(mouse(1))), Some(AHEAD));
            assert_eq!(grip.hear(end), REST, "{end:?}");
            for later in [PadEvent::Moved(mouse(1)), PadEvent::Moved(mouse(0)), end] {
                assert_eq!(grip.hear(later), None, "{end:?}, then {later:?}");
            }
            assert_eq!(grip.hear(PadEvent::Pressed(mouse(1))), Some(AHEAD));
        }
    }

    #[test]
    fn other_pointers_and_other_buttons_change_nothing() {
        let other = Pointer {
            number: 2,
            place: [1.0, 0.0],
            ..mouse(1)
        };
        let mut grip = held_by(mouse(1));
        for event in [
            PadEvent::Pressed(other),
            PadEvent::Moved(other),
            PadEvent::Ended(2),
        ] {
            assert_eq!(grip.hear(event), None, "{event:?}");
        }
        assert!(grip.is_held());
        let mut free = Grip::default();
        for event in [
            PadEvent::Pressed(mouse(0)),
            PadEvent::Pressed(mouse(2)),
            PadEvent::Moved(mouse(1)),
        ] {
            assert_eq!(free.hear(event), None, "{event:?}");
        }
        assert!(!free.is_held());
    }

    #[test]
    fn a_finger_that_is_held_still_goes_on() {
        let finger = Pointer {
            kind: PointerKind::Finger,
            ..mouse(1)
        };
        let mut grip = held_by(finger);
        assert_eq!(grip.hear(PadEvent::Menu), None);
        assert_eq!(grip.hear(PadEvent::Moved(finger)), Some(AHEAD));
        assert_eq!(grip.hear(PadEvent::TakenAway), REST);
    }

    /// A small generator, so that each gesture is the same everywhere.
    struct Random(u64);

    impl Random {
        fn below(&mut self, end: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 33) % end
        }
    }

    /// Two hands before a page, as they really are: a mouse and a finger. The page is told of it, but not of everything.
    struct Hands {
        random: Random,
        /// Whether each is pressed, and whether that press holds the knob by rights.
        pressed: [bool; 2],
        holds: [bool; 2],
    }

    impl Hands {
        fn pointer(&mut self, hand: usize) -> Pointer {
            let kind = [PointerKind::Other, PointerKind::Finger][hand];
            let far = self.random.below(100) as f64 / 100.0;
            Pointer {
                number: hand as i32 + 1,
                kind,
                buttons: u16::from(self.pressed[hand]),
                place: [far, 1.0 - far],
            }
        }

        /// The next thing that happens, and what the page hears of it.
        fn next(&mut self) -> Option<PadEvent> {
            let hand = self.random.below(2) as usize;
            match self.random.below(12) {
                0..=2 => self.press(hand),
                3 => self.lift(hand),
                4 => {
                    self.holds = [false, false];
                    Some(PadEvent::TakenAway)
                }
                5 => {
                    self.holds[0] = false;
                    Some(PadEvent::Menu)
                }
                _ => {
                    let pointer = self.pointer(hand);
                    // A finger that is not on the screen does not move there.
                    (hand == 0 || self.pressed[1]).then_some(PadEvent::Moved(pointer))
                }
            }
        }

        /// A press may be beside the pad.
        fn press(&mut self, hand: usize) -> Option<PadEvent> {
            if self.pressed[hand] {
                return None;
            }
            self.pressed[hand] = true;
            let is_on_pad = self.random.below(4) > 0;
            self.holds[hand] = is_on_pad;
            let pointer = self.pointer(hand);
            Some(match is_on_pad {
                true => PadEvent::Pressed(pointer),
                false => PadEvent::Ended(pointer.number),
            })
        }

        /// The page does not hear of each end.
        fn lift(&mut self, hand: usize) -> Option<PadEvent> {
            self.pressed[hand] = false;
            self.holds[hand] = false;
            let is_told = hand == 1 || self.random.below(2) == 0;
            is_told.then_some(PadEvent::Ended(hand as i32 + 1))
        }
    }

    /// The page may believe in a hold whose end it was not told, and follows one hand at a time; what it does not follow is safe.
    #[test]
    fn a_thousand_random_gestures_move_nothing_without_a_pressed_hand_on_the_pad() {
        let (mut moves, mut follows) = (0, 0);
        for seed in 0..1_000 {
            let mut hands = Hands {
                random: Random(seed),
                pressed: [false; 2],
                holds: [false; 2],
            };
            let mut grip = Grip::default();
            for _ in 0..40 {
                let Some(event) = hands.next() else { continue };
                let moved_to = grip.hear(event).filter(|place| *place != [0.0, 0.0]);
                let hand = match event {
                    PadEvent::Pressed(pointer) | PadEvent::Moved(pointer) => {
                        Some(pointer.number as usize - 1)
                    }
                    _ => None,
                };
                let may_move = hand.is_some_and(|hand| hands.pressed[hand] && hands.holds[hand]);
                assert!(moved_to.is_none() || may_move, "seed {seed}: {event:?}");
                moves += u32::from(may_move);
                follows += u32::from(moved_to.is_some());
            }
            // The mouse hovers once more over the page: whatever was not told ends now.
            hands.pressed[0] = false;
            let hover = PadEvent::Moved(hands.pointer(0));
            grip.hear(hover);
            grip.hear(PadEvent::Ended(2));
            assert!(!grip.is_held(), "seed {seed}");
        }
        assert!(follows > moves / 2, "{follows} of {moves} motions were followed");
        println!("{follows} of {moves} motions of a pressed hand were followed");
    }
}
