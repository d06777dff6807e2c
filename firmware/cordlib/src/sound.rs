//! The queue of tones.

use heapless::Deque;
use rvac_protocol::message::Beep;
use rvac_units::Tick;

use crate::board::Beeper;
use crate::timing::Deadline;

/// Tones that can wait.
const QUEUE: usize = 8;

/// Tones, played in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sound {
    waiting: Deque<Beep, QUEUE>,
    playing: Deadline,
}

impl Sound {
    /// Queues a tone; false if the queue is full and the tone is dropped.
    pub(crate) fn queue(&mut self, beep: Beep) -> bool {
        self.waiting.push_back(beep).is_ok()
    }

    /// Forgets all tones; the board was silenced.
    pub(crate) fn clear(&mut self) {
        self.waiting.clear();
        self.playing = Deadline::default();
    }

    /// Starts and ends tones.
    pub(crate) fn play<B: Beeper>(&mut self, beeper: &mut B, now: Tick) {
        let ended = self.playing.has_come(now);
        if self.playing.is_running() {
            return;
        }
        if let Some(next) = self.waiting.pop_front() {
            if next.pitch.0 > 0 {
                beeper.sound(next.pitch, next.volume);
            } else {
                beeper.silence();
            }
            self.playing = Deadline::at(now.after(u32::from(next.duration_ms)));
        } else if ended {
            beeper.silence();
        }
    }
}
