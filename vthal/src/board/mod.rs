//! Buttons and lights that hang on the Linux board, on robots whose microcontroller has no pins left for them.
//!
//! A thread reads the buttons and sends which are down; the core decides what a press means, as it does for a robot with buttons of its
//! own, and which lights are on. The thread only knows lines.

mod gpio;

use std::io;
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, Sender as StdSender, TryRecvError};
use std::time::Duration;

use tokio::sync::mpsc::Sender;
use vthal_core::Lights;

use crate::event::{Event, ReceiverGone};
use gpio::GpioLines;

/// Most buttons that a robot has.
pub const BUTTONS_MAX: usize = 8;
/// Lights change at most this much later than the state that they show.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// Pause before lines that were lost are opened again.
const RETRY: Duration = Duration::from_secs(2);

/// Which lines there are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoardSettings {
    /// Character device of the chip that has the lines.
    pub chip: PathBuf,
    /// Line of each button, in the order START, SPOT, DOCK.
    pub buttons: Vec<u32>,
    /// Level of a button's line while it is pressed.
    pub pressed: PressedLevel,
    /// Lines of the lights.
    pub lights: LightLines,
}

/// What a pressed button does to its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PressedLevel {
    /// It pulls to ground.
    Low,
    /// It pulls to the supply.
    High,
}

/// A line for each light; `None` = there is no such light. High = on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightLines {
    /// Of [`Lights::ready`].
    pub ready: Option<u32>,
    /// Of [`Lights::working`].
    pub working: Option<u32>,
    /// Of [`Lights::attention`].
    pub attention: Option<u32>,
}

impl LightLines {
    /// Each line that there is, and whether it is on.
    fn pairs(self, lights: Lights) -> impl Iterator<Item = (u32, bool)> {
        let all = [
            (self.ready, lights.ready),
            (self.working, lights.working),
            (self.attention, lights.attention),
        ];
        all.into_iter().filter_map(|(line, is_on)| Some((line?, is_on)))
    }
}

/// The lines, or what stands for them in a test.
pub(crate) trait BoardLines {
    /// Waits until a button changes, at most so long, and says which are down, button 0 in bit 0.
    fn buttons(&mut self, at_most: Duration) -> Result<u8, LinesError>;
    /// Switches the lights.
    fn show(&mut self, lights: Lights) -> Result<(), LinesError>;
}

/// Why the lines cannot be used, with what to do.
#[derive(Debug, thiserror::Error)]
pub(crate) enum LinesError {
    /// The chip or a line cannot be had.
    #[error("cannot use the {what} on {}: {reason}; check board.chip, that no other program holds the lines, and that vthal may open it", .chip.display())]
    Refused {
        /// What for.
        what: &'static str,
        /// Of which chip.
        chip: PathBuf,
        /// The kernel's words.
        reason: String,
    },
    /// An open line failed.
    #[error("the {what} can no longer be used: {reason}")]
    Lost {
        /// What for.
        what: &'static str,
        /// The kernel's words.
        reason: String,
    },
}

/// From the lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum BoardEvent {
    /// The lines are open; these buttons were down already and count once they were released.
    Opened(u8),
    /// Buttons that are down.
    Buttons(u8),
    /// The lines are not there or were lost; reported once per outage, with what to do.
    Absent(String),
}

/// The loop's end of the lights.
#[derive(Debug)]
pub(crate) struct LightsHandle {
    orders: StdSender<Lights>,
    shown: Option<Lights>,
}

impl LightsHandle {
    /// Switches the lights, unless they are so already.
    pub(crate) fn show(&mut self, lights: Lights) {
        if self.shown != Some(lights) {
            self.shown = Some(lights);
            // A thread that is gone has ended with the daemon.
            self.orders.send(lights).ok();
        }
    }
}

/// Starts the thread. It ends when the daemon's event queue closes.
///
/// # Errors
/// When the system gives no thread.
pub(crate) fn start(settings: BoardSettings, events: Sender<Event>) -> io::Result<LightsHandle> {
    start_with(move || GpioLines::open(&settings), events)
}

/// The same with any lines.
fn start_with<L: BoardLines + 'static>(
    mut open: impl FnMut() -> Result<L, LinesError> + Send + 'static,
    events: Sender<Event>,
) -> io::Result<LightsHandle> {
    let (orders, ordered) = mpsc::channel();
    let mut attendant = Attendant {
        events,
        ordered,
        lights: Lights::default(),
        reported: None,
    };
    std::thread::Builder::new()
        .name("board".to_owned())
        .spawn(move || while attendant.attend_again(&mut open).is_ok() {})?;
    Ok(LightsHandle { orders, shown: None })
}

/// What the thread holds.
struct Attendant {
    events: Sender<Event>,
    ordered: Receiver<Lights>,
    lights: Lights,
    reported: Option<String>,
}

impl Attendant {
    /// Serves the lines until they are lost, and waits before the next attempt.
    fn attend_again<L: BoardLines>(
        &mut self,
        open: &mut impl FnMut() -> Result<L, LinesError>,
    ) -> Result<(), ReceiverGone> {
        let Err(error) = open().and_then(|lines| self.attend(lines)) else {
            return Err(ReceiverGone);
        };
        let text = error.to_string();
        if self.reported.as_ref() != Some(&text) {
            self.reported = Some(text.clone());
            self.send(BoardEvent::Absent(text))?;
        }
        // The thread has nothing else to do; lines that another program holds are not free sooner.
        std::thread::sleep(RETRY);
        Ok(())
    }

    /// Ends without an error when the daemon has ended.
    fn attend(&mut self, mut lines: impl BoardLines) -> Result<(), LinesError> {
        let at_start = lines.buttons(Duration::ZERO)?;
        lines.show(self.lights)?;
        self.reported = None;
        if self.send(BoardEvent::Opened(at_start)).is_err() {
            return Ok(());
        }
        let (mut stuck, mut told) = (at_start, 0);
        loop {
            let down = lines.buttons(LOOK_EVERY)?;
            stuck &= down;
            let pressed = down & !stuck;
            if pressed != told {
                told = pressed;
                if self.send(BoardEvent::Buttons(pressed)).is_err() {
                    return Ok(());
                }
            }
            let Ok(changed) = self.newest_lights() else {
                // The daemon has ended: nothing shows a state that nobody keeps.
                return lines.show(Lights::default());
            };
            if changed {
                lines.show(self.lights)?;
            }
        }
    }

    /// Takes what was ordered meanwhile; whether anything was.
    fn newest_lights(&mut self) -> Result<bool, ReceiverGone> {
        let mut changed = false;
        loop {
            match self.ordered.try_recv() {
                Ok(lights) => {
                    self.lights = lights;
                    changed = true;
                }
                Err(TryRecvError::Empty) => return Ok(changed),
                Err(TryRecvError::Disconnected) => return Err(ReceiverGone),
            }
        }
    }

    /// Presses are never dropped: the thread waits until the loop has room.
    fn send(&self, event: BoardEvent) -> Result<(), ReceiverGone> {
        self.events
            .blocking_send(Event::Board(event))
            .map_err(|_| ReceiverGone)
    }
}

#[cfg(test)]
mod tests;
