//! Gamepads of the Linux board, from the kernel's event devices. Their codes become the numbers of the "standard" mapping of
//! the W3C, so that a profile fits a pad wherever it is plugged in.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use evdev::{AbsoluteAxisCode, EventSummary, KeyCode};
use mixer::{Device, PadReading, Readings, Source};

use super::DriveEvent;
use super::shaker::Shaker;

/// Period of the search for new pads.
const LOOK: Duration = Duration::from_secs(1);
/// As many pads as a profile can name.
const PADS: u8 = 4;
/// Buttons of the "standard" mapping.
const BUTTONS: u8 = 17;
/// Makers whose drivers name the upper and the left button by their places. All others give them the letters of an Xbox pad,
/// where the same two codes are swapped.
const BY_PLACE: [u16; 2] = [0x054C, 0x057E];

/// The pads that are open.
type Open = Arc<Mutex<BTreeMap<PathBuf, OpenPad>>>;

/// A pad that is read.
#[derive(Debug)]
struct OpenPad {
    /// None once another device has come under its identity.
    number: Option<u8>,
    /// What its maker calls it, and its own number if it has one.
    identity: (String, String),
    /// Another device has come under its identity: what this one says counts no more.
    replaced: Arc<AtomicBool>,
}

/// Looks for pads and reads them, on threads of their own.
pub(super) fn listen(events: Sender<DriveEvent>) {
    std::thread::spawn(move || {
        let open = Open::default();
        let mut told = false;
        loop {
            let found = scan(&open, &events);
            if !found && !std::mem::replace(&mut told, true) {
                let text = "no gamepad yet: plug one in (this user must be allowed to read /dev/input, group `input`)";
                if events.send(DriveEvent::Remark(text.to_owned())).is_err() {
                    return;
                }
            }
            std::thread::sleep(LOOK);
        }
    });
}

/// Starts a reader for each pad that has none. Whether there is any pad.
fn scan(open: &Open, events: &Sender<DriveEvent>) -> bool {
    for (path, device) in evdev::enumerate() {
        let is_pad = device
            .supported_keys()
            .is_some_and(|keys| keys.contains(KeyCode::BTN_SOUTH));
        if !is_pad {
            continue;
        }
        let identity = identity(&device);
        let mut pads = open.lock().unwrap_or_else(PoisonError::into_inner);
        if pads.contains_key(&path) {
            continue;
        }
        // A pad that lost its connection and came back, while the kernel still shows how it was: the newer one has the say.
        for pad in pads.values_mut().filter(|pad| pad.identity == identity) {
            pad.replaced.store(true, Ordering::Relaxed);
            if let Some(number) = pad.number.take() {
                events.send(DriveEvent::Gone(Device::Pad(number))).ok();
            }
        }
        let free = (0..PADS).find(|number| !pads.values().any(|pad| pad.number == Some(*number)));
        let Some(number) = free else { continue };
        let replaced = Arc::new(AtomicBool::new(false));
        pads.insert(
            path.clone(),
            OpenPad {
                number: Some(number),
                identity,
                replaced: Arc::clone(&replaced),
            },
        );
        drop(pads);
        let (open, events) = (Arc::clone(open), events.clone());
        std::thread::spawn(move || {
            read(device, number, &events, &replaced);
            open.lock().unwrap_or_else(PoisonError::into_inner).remove(&path);
        });
    }
    !open.lock().unwrap_or_else(PoisonError::into_inner).is_empty()
}

fn identity(device: &evdev::Device) -> (String, String) {
    let text = |text: Option<&str>| text.unwrap_or_default().to_owned();
    (text(device.name()), text(device.unique_name()))
}

/// Reads one pad until it is gone, or another one has taken its place.
fn read(mut device: evdev::Device, pad: u8, events: &Sender<DriveEvent>, replaced: &AtomicBool) {
    let name = device.name().unwrap_or("a gamepad").to_owned();
    let letters = Letters::of(device.input_id().vendor());
    let ranges: BTreeMap<u16, Range> = device
        .get_absinfo()
        .map(|all| {
            all.map(|(code, info)| (code.0, Range::new(info.minimum(), info.maximum())))
                .collect()
        })
        .unwrap_or_default();
    events
        .send(DriveEvent::Remark(format!("pad-{pad} is {name}")))
        .ok();
    if let Some(shaker) = Shaker::of(&mut device) {
        events.send(DriveEvent::CanShake(pad, shaker)).ok();
    }
    // All at once: a stick that is pushed must not come into sight after the pad was seen at rest.
    let reading = whole_reading(pad, &device, &ranges);
    events.send(DriveEvent::Plugged(pad, reading)).ok();
    while let Ok(batch) = device.fetch_events() {
        if replaced.load(Ordering::Relaxed) {
            return;
        }
        events.send(DriveEvent::Heard(pad)).ok();
        for event in batch {
            match event.destructure() {
                EventSummary::Key(_, code, value) => {
                    if let Some(button) = button(code, letters) {
                        let value = f64::from(u8::from(value != 0));
                        events
                            .send(DriveEvent::Moved(Source::PadButton { pad, button }, value))
                            .ok();
                    }
                }
                EventSummary::AbsoluteAxis(_, code, value) => moved(pad, (code, value), &ranges, events),
                _ => {}
            }
        }
    }
    if !replaced.load(Ordering::Relaxed) {
        events.send(DriveEvent::Gone(Device::Pad(pad))).ok();
    }
}

/// A pad with the sticks where they are. Buttons count from their next press on.
fn whole_reading(pad: u8, device: &evdev::Device, ranges: &BTreeMap<u16, Range>) -> PadReading {
    let mut readings = Readings::default();
    for button in 0..BUTTONS {
        readings.set(&Source::PadButton { pad, button }, 0.0);
    }
    for (code, info) in device.get_absinfo().into_iter().flatten() {
        let value = value_at_start(code, info.value(), info.minimum());
        for (source, value) in said(pad, (code, value), ranges) {
            readings.set(&source, value);
        }
    }
    readings.pads.remove(&pad).unwrap_or_default()
}

/// What an axis reads before its first word. The kernel gives 0 for one that has said nothing yet: the middle of a trigger whose
/// range begins below 0, which nobody has pulled.
fn value_at_start(code: AbsoluteAxisCode, value: i32, minimum: i32) -> i32 {
    let is_trigger = matches!(code, AbsoluteAxisCode::ABS_Z | AbsoluteAxisCode::ABS_RZ);
    if is_trigger && value == 0 {
        minimum.min(0)
    } else {
        value
    }
}

fn moved(
    pad: u8,
    moved: (AbsoluteAxisCode, i32),
    ranges: &BTreeMap<u16, Range>,
    events: &Sender<DriveEvent>,
) {
    for (source, value) in said(pad, moved, ranges) {
        events.send(DriveEvent::Moved(source, value)).ok();
    }
}

/// What an axis says that reads this.
fn said(
    pad: u8,
    (code, value): (AbsoluteAxisCode, i32),
    ranges: &BTreeMap<u16, Range>,
) -> Vec<(Source, f64)> {
    let range = ranges.get(&code.0).copied().unwrap_or(Range::new(-1, 1));
    sources(pad, code, range.share(value))
}

/// What an axis can read.
#[derive(Clone, Copy, Debug)]
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    fn new(low: i32, high: i32) -> Self {
        Self {
            low: f64::from(low),
            high: f64::from(high),
        }
    }

    /// From its lower end to its upper one as 0..=1; the middle of an axis without a range.
    fn share(self, value: i32) -> f64 {
        let reach = self.high - self.low;
        if reach > 0.0 {
            ((f64::from(value) - self.low) / reach).clamp(0.0, 1.0)
        } else {
            0.5
        }
    }
}

/// Which of the two upper and left buttons has which code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Letters {
    /// By their places.
    Places,
    /// By the letters of an Xbox pad: X is on the left and has the code of the upper one.
    Xbox,
}

impl Letters {
    fn of(vendor: u16) -> Self {
        if BY_PLACE.contains(&vendor) {
            Self::Places
        } else {
            Self::Xbox
        }
    }
}

fn button(code: KeyCode, letters: Letters) -> Option<u8> {
    Some(match code {
        KeyCode::BTN_SOUTH => 0,
        KeyCode::BTN_EAST => 1,
        KeyCode::BTN_WEST if letters == Letters::Places => 2,
        KeyCode::BTN_NORTH if letters == Letters::Places => 3,
        KeyCode::BTN_NORTH => 2,
        KeyCode::BTN_WEST => 3,
        KeyCode::BTN_TL => 4,
        KeyCode::BTN_TR => 5,
        KeyCode::BTN_TL2 => 6,
        KeyCode::BTN_TR2 => 7,
        KeyCode::BTN_SELECT => 8,
        KeyCode::BTN_START => 9,
        KeyCode::BTN_THUMBL => 10,
        KeyCode::BTN_THUMBR => 11,
        KeyCode::BTN_DPAD_UP => 12,
        KeyCode::BTN_DPAD_DOWN => 13,
        KeyCode::BTN_DPAD_LEFT => 14,
        KeyCode::BTN_DPAD_RIGHT => 15,
        KeyCode::BTN_MODE => 16,
        _ => return None,
    })
}

/// What an axis at `share` of its range says. Triggers are buttons there, and the cross is four.
fn sources(pad: u8, code: AbsoluteAxisCode, share: f64) -> Vec<(Source, f64)> {
    let stick = 2.0 * share - 1.0;
    let axis = |axis| vec![(Source::PadAxis { pad, axis }, stick)];
    let pull = |button| vec![(Source::PadButton { pad, button }, share)];
    let cross = |low, high| {
        let press = |button, value: f64| {
            (
                Source::PadButton { pad, button },
                f64::from(u8::from(value >= 0.5)),
            )
        };
        vec![press(low, -stick), press(high, stick)]
    };
    match code {
        AbsoluteAxisCode::ABS_X => axis(0),
        AbsoluteAxisCode::ABS_Y => axis(1),
        AbsoluteAxisCode::ABS_RX => axis(2),
        AbsoluteAxisCode::ABS_RY => axis(3),
        AbsoluteAxisCode::ABS_Z => pull(6),
        AbsoluteAxisCode::ABS_RZ => pull(7),
        AbsoluteAxisCode::ABS_HAT0X => cross(14, 15),
        AbsoluteAxisCode::ABS_HAT0Y => cross(12, 13),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use evdev::{AbsoluteAxisCode, KeyCode};

    use super::{Letters, Range, button, sources, value_at_start};

    #[test]
    fn a_trigger_that_has_said_nothing_is_at_rest() {
        let trigger = AbsoluteAxisCode::ABS_RZ;
        assert_eq!(value_at_start(trigger, 0, -32768), -32768);
        assert_eq!(value_at_start(trigger, 0, 0), 0);
        assert_eq!(value_at_start(trigger, 77, -32768), 77);
        assert_eq!(
            value_at_start(AbsoluteAxisCode::ABS_X, 0, -32768),
            0,
            "a stick rests in its middle"
        );
    }

    #[test]
    fn axes_become_sticks_triggers_and_the_cross() {
        let said = |code, value, (low, high)| -> String {
            let moves = sources(0, code, Range::new(low, high).share(value));
            moves
                .iter()
                .map(|(source, value)| format!("{source}={value} "))
                .collect()
        };
        assert_eq!(
            said(AbsoluteAxisCode::ABS_Y, -32768, (-32768, 32767)),
            "pad-0-axis-1=-1 "
        );
        assert_eq!(
            said(AbsoluteAxisCode::ABS_RZ, 1023, (0, 1023)),
            "pad-0-button-7=1 "
        );
        assert_eq!(
            said(AbsoluteAxisCode::ABS_HAT0X, -1, (-1, 1)),
            "pad-0-button-14=1 pad-0-button-15=0 "
        );
        assert_eq!(
            said(AbsoluteAxisCode::ABS_HAT0Y, 0, (-1, 1)),
            "pad-0-button-12=0 pad-0-button-13=0 "
        );
        assert_eq!(
            said(AbsoluteAxisCode::ABS_X, 7, (0, 0)),
            "pad-0-axis-0=0 ",
            "an axis without a range is at rest"
        );
        assert_eq!(said(AbsoluteAxisCode::ABS_MISC, 1, (0, 1)), "");
    }

    #[test]
    fn the_left_and_upper_buttons_depend_on_the_maker() {
        let pair =
            |vendor| [KeyCode::BTN_NORTH, KeyCode::BTN_WEST].map(|code| button(code, Letters::of(vendor)));
        assert_eq!(pair(0x045E), [Some(2), Some(3)]);
        assert_eq!(pair(0x054C), [Some(3), Some(2)]);
        assert_eq!(button(KeyCode::KEY_A, Letters::Xbox), None);
    }
}
