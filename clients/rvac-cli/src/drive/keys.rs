//! The keyboard of a terminal. A terminal reports presses and repeats, never a release: a key counts as held until its
//! next repeat is overdue.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use anyhow::Context as _;
use mixer::{Device, KeyCode, Source};
use rustix::termios::{LocalModes, OptionalActions, Termios, tcgetattr, tcsetattr};

use super::DriveEvent;

/// A terminal begins to repeat a key after this long at most.
const FIRST: Duration = Duration::from_millis(550);
/// And then repeats it faster than this.
const NEXT: Duration = Duration::from_millis(150);
/// Keys are let go in such steps.
const LOOK: Duration = Duration::from_millis(10);

/// The terminal gives single keys while this lives.
#[derive(Debug)]
pub(super) struct RawTerminal {
    before: Termios,
}

impl Drop for RawTerminal {
    fn drop(&mut self) {
        // A terminal that is gone needs nothing restored.
        tcsetattr(std::io::stdin(), OptionalActions::Flush, &self.before).ok();
    }
}

/// A key of the terminal.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Typed {
    Key(KeyCode),
    Quit,
}

/// Reads keys on threads of their own.
///
/// # Errors
/// When the terminal does not give single keys.
pub(super) fn listen(events: Sender<DriveEvent>) -> anyhow::Result<RawTerminal> {
    let before = tcgetattr(std::io::stdin()).context("the terminal cannot be asked")?;
    let mut raw = before.clone();
    raw.local_modes
        .remove(LocalModes::ICANON | LocalModes::ECHO | LocalModes::ISIG);
    tcsetattr(std::io::stdin(), OptionalActions::Flush, &raw).context("the terminal gives no single keys")?;
    let guide = "W A S D or arrows drive, space stops, q ends; a gamepad drives too";
    events.send(DriveEvent::Remark(guide.to_owned())).ok();
    let (typed, keys) = channel();
    std::thread::spawn(move || read(&typed));
    std::thread::spawn(move || hold(&keys, &events));
    Ok(RawTerminal { before })
}

fn read(typed: &Sender<Vec<u8>>) {
    let mut chunk = [0; 64];
    while let Ok(count) = std::io::stdin().lock().read(&mut chunk) {
        if count == 0 || typed.send(chunk[..count].to_vec()).is_err() {
            return;
        }
    }
}

/// Makes presses and releases of what is typed, until the terminal is gone.
fn hold(keys: &Receiver<Vec<u8>>, events: &Sender<DriveEvent>) {
    let mut held = Held::default();
    // The keyboard is there, with nothing held.
    let mut changes: Vec<DriveEvent> = released(&KeyCode::new("Space")).into_iter().collect();
    loop {
        for event in changes.drain(..) {
            if events.send(event).is_err() {
                return;
            }
        }
        match keys.recv_timeout(LOOK) {
            Ok(bytes) => {
                for typed in decode(&bytes) {
                    changes.push(match typed {
                        Typed::Key(code) => {
                            held.press(&code, Instant::now());
                            DriveEvent::Moved(Source::Key(code), 1.0)
                        }
                        Typed::Quit => DriveEvent::Ended,
                    });
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                events.send(DriveEvent::Gone(Device::Keyboard)).ok();
                events.send(DriveEvent::Ended).ok();
                return;
            }
        }
        changes.extend(
            held.overdue(Instant::now())
                .into_iter()
                .map(|code| DriveEvent::Moved(Source::Key(code), 0.0)),
        );
    }
}

fn released(code: &Option<KeyCode>) -> Option<DriveEvent> {
    code.clone().map(|code| DriveEvent::Moved(Source::Key(code), 0.0))
}

/// Keys that are held, and until when.
#[derive(Debug, Default)]
struct Held {
    until: BTreeMap<KeyCode, Instant>,
}

impl Held {
    fn press(&mut self, code: &KeyCode, now: Instant) {
        let pause = if self.until.contains_key(code) {
            NEXT
        } else {
            FIRST
        };
        self.until.insert(code.clone(), now + pause);
    }

    /// The keys that are held no longer.
    fn overdue(&mut self, now: Instant) -> Vec<KeyCode> {
        let over: Vec<KeyCode> = self
            .until
            .iter()
            .filter(|(_, until)| **until <= now)
            .map(|(code, _)| code.clone())
            .collect();
        for code in &over {
            self.until.remove(code);
        }
        over
    }
}

/// The keys in what a terminal sends: letters, the space, and arrows as `ESC [ A`.
fn decode(bytes: &[u8]) -> Vec<Typed> {
    let mut all = Vec::new();
    let mut rest = bytes;
    while let Some((first, tail)) = rest.split_first() {
        rest = tail;
        let code = match (first, rest) {
            (b'q' | 3 | 4, _) => {
                all.push(Typed::Quit);
                continue;
            }
            (0x1B, [b'[' | b'O', arrow, tail @ ..]) => {
                rest = tail;
                match arrow {
                    b'A' => "ArrowUp".to_owned(),
                    b'B' => "ArrowDown".to_owned(),
                    b'C' => "ArrowRight".to_owned(),
                    b'D' => "ArrowLeft".to_owned(),
                    _ => continue,
                }
            }
            (b' ', _) => "Space".to_owned(),
            (letter, _) if letter.is_ascii_alphabetic() => {
                format!("Key{}", char::from(letter.to_ascii_uppercase()))
            }
            (digit, _) if digit.is_ascii_digit() => format!("Digit{}", char::from(*digit)),
            _ => continue,
        };
        all.extend(KeyCode::new(&code).map(Typed::Key));
    }
    all
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use mixer::KeyCode;

    use super::{FIRST, Held, NEXT, Typed, decode};

    fn key(code: &str) -> KeyCode {
        KeyCode::new(code).expect("a key")
    }

    #[test]
    fn letters_arrows_and_the_end_are_understood() {
        let expected = ["KeyW", "ArrowUp", "ArrowLeft", "Space", "KeyA"].map(|code| Typed::Key(key(code)));
        assert_eq!(decode(b"w\x1b[A\x1bOD \x1b[ZA"), expected);
        assert_eq!(decode(b"\x03"), [Typed::Quit]);
        assert_eq!(decode(b"\x1b"), []);
    }

    #[test]
    fn a_key_is_held_until_its_repeat_is_overdue() {
        let (mut held, start) = (Held::default(), Instant::now());
        let moment = Duration::from_millis(1);
        held.press(&key("KeyW"), start);
        assert_eq!(held.overdue(start + FIRST - moment), []);
        held.press(&key("KeyW"), start + FIRST - moment);
        assert_eq!(held.overdue(start + FIRST + NEXT - 2 * moment), []);
        assert_eq!(held.overdue(start + FIRST + NEXT), [key("KeyW")]);
        assert_eq!(held.overdue(start + FIRST + NEXT), [], "once");
    }
}
