//! The host's transmitter and the cable behind it.

use std::collections::VecDeque;

use home::Pcg;
use rvac_channel::{Channel, FaultRates};

use super::{FRAME_BITS, HostRate};
use crate::board::CYCLES_PER_MS;
use crate::pins::Level;

/// Bytes the host's driver holds at most; what comes while it is full is the host's to keep.
const QUEUE_MAX: usize = 4096;
/// A line at rest: ten high levels.
const REST: u16 = u16::MAX;

/// Turns bytes into edges, damaged as its rates say.
#[derive(Clone, Debug)]
pub struct Sender {
    queue: VecDeque<u8>,
    bit_cycles: f64,
    /// Cycle at which the next frame may begin.
    free: f64,
    level: Level,
    /// Frames of ten levels that follow next.
    frames: VecDeque<u16>,
    drawn: Vec<u16>,
    held_until: u64,
    cut_until: u64,
    flood: Option<Flood>,
    channel: Channel,
    faulty: bool,
    /// A host that was idle begins at any moment of a millisecond, not at its beginning.
    phase: Pcg,
}

const STREAM: u64 = 0x11AE;

/// Another sender of a high rate on the same wire: a console that prints, for example.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flood {
    bit_cycles: f64,
    /// When its next bit begins.
    next: f64,
    until: u64,
}

impl Sender {
    /// An idle line; damage and moments follow from `seed`.
    #[must_use]
    pub fn new(rate: HostRate, seed: u64) -> Self {
        Self {
            queue: VecDeque::new(),
            bit_cycles: rate.bit_cycles(),
            free: 0.0,
            level: Level::High,
            frames: VecDeque::new(),
            drawn: Vec::new(),
            held_until: 0,
            cut_until: 0,
            flood: None,
            channel: Channel::new(seed, FaultRates::NONE),
            faulty: false,
            phase: Pcg::new(seed, STREAM),
        }
    }

    /// Sets how often what goes wrong from now on.
    pub fn set_rates(&mut self, rates: FaultRates) {
        self.channel.set_rates(rates);
        self.faulty = rates != FaultRates::NONE;
    }

    /// Everything waits until `cycle`.
    pub fn hold_until(&mut self, cycle: u64) {
        self.held_until = self.held_until.max(cycle);
    }

    /// Everything that is sent before `cycle` is lost.
    pub fn cut_until(&mut self, cycle: u64) {
        self.cut_until = self.cut_until.max(cycle);
    }

    /// Random bits of another sender take the wire from `from` until `until`, at so many bits per second: on average there
    /// is an edge at every second bit. What the host sends meanwhile is lost.
    pub fn flood(&mut self, baud: u32, (from, until): (u64, u64)) {
        self.cut_until(until);
        self.flood = Some(Flood {
            bit_cycles: HostRate::exact(baud).bit_cycles(),
            next: self.free.max(from as f64),
            until,
        });
    }

    /// Bytes that [`Self::send`] would take now.
    #[must_use]
    pub fn room(&self) -> usize {
        QUEUE_MAX - self.queue.len()
    }

    /// Hands bytes to the host's driver and returns how many it took.
    pub fn send(&mut self, bytes: &[u8]) -> usize {
        let taken = bytes.len().min(self.room());
        self.queue.extend(&bytes[..taken]);
        taken
    }

    /// Forgets what the host's driver holds: the host died.
    pub fn flush(&mut self) {
        self.queue.clear();
    }

    /// The edges of the millisecond that begins at `from`, as cycle and level, in order. Edges of a frame that reaches into
    /// the next millisecond are among them.
    pub fn pass_ms(&mut self, from: u64, edges: &mut Vec<(u64, Level)>) {
        let end = from + CYCLES_PER_MS;
        if let Some(flood) = self.flood {
            self.flood = self.babble(flood, end, edges);
            self.free = self.free.max(end as f64);
            return;
        }
        if from < self.held_until {
            return;
        }
        if self.free < from as f64 {
            self.free = from as f64 + self.phase.unit() * CYCLES_PER_MS as f64;
        }
        while self.free < end as f64 {
            let Some(frame) = self.next_frame() else {
                return;
            };
            self.put(frame, edges);
        }
    }

    /// The other sender's bits until `end`; what is left of it.
    fn babble(&mut self, mut flood: Flood, end: u64, edges: &mut Vec<(u64, Level)>) -> Option<Flood> {
        while flood.next < end.min(flood.until) as f64 {
            let level = Level::of(self.phase.below(2) == 1);
            if level != self.level {
                self.level = level;
                edges.push((flood.next as u64, level));
            }
            flood.next += flood.bit_cycles;
        }
        if flood.until > end {
            return Some(flood);
        }
        if self.level == Level::Low {
            self.level = Level::High;
            edges.push((flood.until.min(end - 1), Level::High));
        }
        None
    }

    fn next_frame(&mut self) -> Option<u16> {
        if self.frames.is_empty() {
            let byte = self.queue.pop_front();
            if byte.is_none() && !self.faulty {
                return None;
            }
            self.drawn.clear();
            self.channel.carry(byte, &mut self.drawn);
            self.frames.extend(&self.drawn);
        }
        self.frames.pop_front()
    }

    fn put(&mut self, frame: u16, edges: &mut Vec<(u64, Level)>) {
        let frame = if self.free < self.cut_until as f64 {
            REST
        } else {
            frame
        };
        for bit in 0..FRAME_BITS {
            let level = Level::of(frame >> bit & 1 == 1);
            if level != self.level {
                self.level = level;
                let cycle = self.free + f64::from(bit) * self.bit_cycles;
                edges.push((cycle as u64, level));
            }
        }
        self.free += f64::from(FRAME_BITS) * self.bit_cycles;
    }
}

#[cfg(test)]
mod tests {
    use rvac_channel::ReceivedByte;

    use super::{CYCLES_PER_MS, FaultRates, HostRate, Level, Sender};
    use crate::board::serial::BitReceiver;

    /// What a perfect receiver hears of `sender` in so many milliseconds, by millisecond.
    fn heard(sender: &mut Sender, rate: HostRate, ms: u64) -> Vec<Vec<ReceivedByte>> {
        let mut receiver = BitReceiver::new(rate.bit_cycles());
        (0..ms)
            .map(|now| {
                let (mut edges, mut arrivals): (Vec<(u64, Level)>, _) = (Vec::new(), Vec::new());
                sender.pass_ms(now * CYCLES_PER_MS, &mut edges);
                for (cycle, level) in edges {
                    receiver.edge(cycle, level, &mut arrivals);
                }
                receiver.advance((now + 1) * CYCLES_PER_MS, &mut arrivals);
                arrivals.into_iter().map(|(_, received)| received).collect()
            })
            .collect()
    }

    #[test]
    fn bytes_take_their_time_and_arrive_whole() {
        let rate = HostRate::exact(230_400);
        let mut sender = Sender::new(rate, 1);
        let sent: Vec<u8> = (0..=255).rev().collect();
        assert_eq!(sender.send(&sent), 256);
        let by_ms = heard(&mut sender, rate, 20);
        assert!(
            by_ms.iter().all(|arrived| arrived.len() <= 24),
            "23 bytes a millisecond"
        );
        let all: Vec<_> = by_ms.into_iter().flatten().collect();
        assert_eq!(all, sent.into_iter().map(ReceivedByte::Byte).collect::<Vec<_>>());
    }

    #[test]
    fn a_held_line_carries_later_and_a_cut_one_never() {
        let rate = HostRate::exact(115_200);
        let mut sender = Sender::new(rate, 2);
        sender.hold_until(3 * CYCLES_PER_MS);
        sender.send(b"abc");
        let by_ms: Vec<_> = heard(&mut sender, rate, 6).iter().map(Vec::len).collect();
        assert_eq!(by_ms[..3], [0, 0, 0]);
        assert_eq!(by_ms.iter().sum::<usize>(), 3);
        let mut sender = Sender::new(rate, 2);
        sender.cut_until(10 * CYCLES_PER_MS);
        sender.send(b"abc");
        assert!(heard(&mut sender, rate, 12).iter().all(Vec::is_empty));
    }

    #[test]
    fn a_flood_has_an_edge_at_every_second_bit_and_leaves_the_line_at_rest() {
        let mut sender = Sender::new(HostRate::exact(230_400), 7);
        sender.flood(1_500_000, (0, 100 * CYCLES_PER_MS));
        sender.send(b"lost");
        let mut edges = Vec::new();
        for ms in 0..120 {
            sender.pass_ms(ms * CYCLES_PER_MS, &mut edges);
        }
        assert!((74_000..76_000).contains(&edges.len()), "{}", edges.len());
        assert_eq!(edges.last().map(|(_, level)| *level), Some(Level::High));
        assert!(edges.is_sorted_by_key(|(cycle, _)| *cycle));
    }

    #[test]
    fn an_idle_line_with_noise_is_not_silent() {
        let rate = HostRate::exact(115_200);
        let mut sender = Sender::new(rate, 3);
        assert!(heard(&mut sender, rate, 50).iter().all(Vec::is_empty));
        let mut sender = Sender::new(rate, 3);
        sender.set_rates(FaultRates {
            bit_error: 0.01,
            ..FaultRates::NONE
        });
        assert!(
            heard(&mut sender, rate, 50)
                .iter()
                .any(|arrived| !arrived.is_empty())
        );
    }

    #[test]
    fn the_driver_keeps_what_fits_and_forgets_with_its_host() {
        let mut sender = Sender::new(HostRate::exact(9_600), 4);
        assert_eq!(sender.send(&[b'x'; 5000]), 4096);
        assert_eq!(sender.room(), 0);
        sender.flush();
        assert_eq!(sender.room(), 4096);
    }
}
