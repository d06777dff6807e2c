//! The whole conversation with the loader.

use std::collections::VecDeque;

use crate::clock::{ChipClock, HANDSHAKE_BAUD, RateSetting};
use crate::frame::{FrameBuffer, sum, to_chip};
use crate::model::Model;
use crate::options::{OptionByte, clocks_per_cycle};

/// Bytes of a block.
const BLOCK_BYTES: usize = 128;
/// Between two bytes of the handshake.
const PULSE_MS: u64 = 30;
/// How long the supply is off: what is stored on the board has to drain.
const OFF_MS: u64 = 1_000;
/// The loader looks for its host right after power comes on.
const SYNC_MS: u64 = 3_000;
/// How long a person may take to switch the robot off and on.
const PERSON_MS: u64 = 120_000;
/// After a frame with a new rate, before that rate is set.
const SWITCH_MS: u64 = 100;
/// A host that slept may be late; this is what a chip may take.
const ANSWER_MS: u64 = 15_000;
/// For an answer at a rate that may not work.
const TRIAL_MS: u64 = 1_500;
/// How often the whole is tried.
const ATTEMPTS: u32 = 5;
const PINGS: u8 = 4;
/// Shortest status payload that has the model.
const STATUS_BYTES: usize = 23;

/// How the chip gets into its loader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entry {
    /// We switch its supply.
    PowerSwitch,
    /// The program in it jumped there a moment ago.
    Jumped,
    /// A person switches the robot off and on.
    Person,
}

/// What is to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Job {
    /// Only to say what the chip is; it runs its program afterwards.
    Probe,
    /// To write a program from address 0 on.
    Write(Vec<u8>),
}

/// What the host is to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Action {
    /// Send these bytes.
    Send(Vec<u8>),
    /// From now on the line runs at this rate; what was sent before has left.
    SetBaud(u32),
    /// Switch the chip's supply off.
    PowerOff,
    /// And on.
    PowerOn,
    /// Tell a person to switch the robot off and on.
    AskForPowerCycle,
    /// It is done.
    Finish(Report),
    /// It is not.
    Fail(IspError),
}

/// What was found and done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    /// The chip.
    pub model: Model,
    /// Its clock.
    pub clock: ChipClock,
    /// Version of the loader, two decimal digits.
    pub loader_version: u8,
    /// Its option byte as it was found.
    pub options_found: u8,
    /// Rate of the data; none when none was needed.
    pub baud: Option<u32>,
    /// Bytes that were written, each block confirmed by its sum.
    pub written_bytes: usize,
}

/// Where the conversation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Calls the loader.
    Sync,
    /// Tries a rate.
    RateTrial,
    /// Sets it.
    RateSet,
    /// Checks the line at it.
    Ping {
        /// How many are still to come.
        left: u8,
    },
    /// Erases.
    Erase,
    /// Writes the block at an address.
    Write {
        /// Where.
        address: usize,
    },
    /// Writes the option byte.
    Options,
    /// Starts the program.
    Run,
    /// It is over.
    Done,
}

/// Why nothing, or not all, was written. The loader itself is in memory that nobody can write: it is always there again after a power
/// cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IspError {
    /// Nobody answers the call.
    #[error(
        "the chip's loader does not answer. Check that its supply goes really off (the Linux board may feed it through a data line), \
         that RX and TX are not swapped, and that the line is at 5 V"
    )]
    NoLoader,
    /// The status is too short or its clock impossible.
    #[error("what answers is no loader of an STC89 or STC90: the status makes no sense. Nothing was touched")]
    NotUnderstood,
    /// Another chip.
    #[error("this is {}, not an STC90C58RD+; nothing was touched", found(*.0))]
    WrongModel(u16),
    /// No rate works.
    #[error(
        "the line works at 2400 baud but at no faster rate. Check ground and level shifter. Nothing was touched"
    )]
    NoRate,
    /// The image does not fit.
    #[error("the program has {0} bytes, and the chip takes 1 to 32768. Nothing was touched")]
    ImageSize(usize),
    /// The chip falls silent, or answers something else, again and again.
    #[error(
        "the chip does not answer as it must while the host does this: {step:?} ({attempts} times). What was written is not whole: \
         try again, with the robot switched off and on"
    )]
    Silent {
        /// During which step.
        step: Step,
        /// How often it was tried.
        attempts: u32,
    },
    /// The sum of a block differs.
    #[error(
        "the chip confirms another sum at {address:#06x} ({attempts} times): the line or the flash is bad. Try again"
    )]
    BlockSum {
        /// Start of the block.
        address: usize,
        /// How often it was tried.
        attempts: u32,
    },
}

fn found(id: u16) -> String {
    match Model::of_id(id) {
        Some(model) => format!("an {}", model.name),
        None => format!("a chip with the unknown identity {id:#06x}"),
    }
}

/// The conversation with one chip.
#[derive(Clone, Debug)]
pub struct Flasher {
    entry: Entry,
    job: Job,
    step: Step,
    buffer: FrameBuffer,
    /// What is to be done at which time, in order.
    queue: VecDeque<(u64, Action)>,
    deadline_ms: u64,
    next_pulse_ms: u64,
    attempts: u32,
    baud: u32,
    status: Option<Report>,
    /// Rates that were tried in vain.
    rates_failed: usize,
    rate: Option<RateSetting>,
}

impl Flasher {
    /// Begins a conversation.
    ///
    /// # Errors
    /// When the program does not fit.
    pub fn new(job: Job, entry: Entry, now_ms: u64) -> Result<Self, IspError> {
        if let Job::Write(image) = &job
            && !(1..=Model::RELAX.code_bytes).contains(&image.len())
        {
            return Err(IspError::ImageSize(image.len()));
        }
        let mut flasher = Self {
            entry,
            job,
            step: Step::Sync,
            buffer: FrameBuffer::default(),
            queue: VecDeque::new(),
            deadline_ms: 0,
            next_pulse_ms: 0,
            attempts: 0,
            baud: HANDSHAKE_BAUD,
            status: None,
            rates_failed: 0,
            rate: None,
        };
        flasher.begin(now_ms);
        Ok(flasher)
    }

    /// Where it is.
    pub fn step(&self) -> Step {
        self.step
    }

    /// Bytes of the program that are confirmed, and of how many.
    pub fn progress(&self) -> (usize, usize) {
        let total = match &self.job {
            Job::Probe => 0,
            Job::Write(image) => image.len(),
        };
        let done = match self.step {
            Step::Write { address } => address,
            Step::Options | Step::Run | Step::Done => total,
            _ => 0,
        };
        (done.min(total), total)
    }

    /// When [`Self::next_action`] has something to do at the latest.
    pub fn wake_at_ms(&self) -> u64 {
        let queued = self.queue.front().map(|(at_ms, _)| *at_ms);
        let pulse = (self.step == Step::Sync).then_some(self.next_pulse_ms);
        queued.or(pulse).unwrap_or(self.deadline_ms).min(self.deadline_ms)
    }

    /// Calls the loader from anew, after the chip was switched off and on.
    fn begin(&mut self, now_ms: u64) {
        self.attempts += 1;
        self.step = Step::Sync;
        self.buffer.clear();
        self.queue.clear();
        self.rate = None;
        self.set_baud(now_ms, HANDSHAKE_BAUD);
        let (pulse_ms, window_ms) = match self.entry {
            Entry::PowerSwitch => {
                self.queue.push_back((now_ms, Action::PowerOff));
                self.queue.push_back((now_ms + OFF_MS, Action::PowerOn));
                (now_ms + OFF_MS, SYNC_MS)
            }
            Entry::Jumped if self.attempts == 1 => (now_ms, SYNC_MS),
            Entry::Jumped | Entry::Person => {
                self.queue.push_back((now_ms, Action::AskForPowerCycle));
                (now_ms, PERSON_MS)
            }
        };
        self.next_pulse_ms = pulse_ms;
        self.deadline_ms = pulse_ms + window_ms;
    }

    fn set_baud(&mut self, at_ms: u64, baud: u32) {
        self.baud = baud;
        self.queue.push_back((at_ms, Action::SetBaud(baud)));
    }

    /// Sends a frame and expects its answer.
    fn ask(&mut self, step: Step, payload: &[u8], now_ms: u64) {
        self.step = step;
        self.queue.push_back((now_ms, Action::Send(to_chip(payload))));
        self.deadline_ms = now_ms + ANSWER_MS;
    }

    /// Bytes came from the chip.
    pub fn receive(&mut self, bytes: &[u8], now_ms: u64) {
        self.buffer.push(bytes);
        while let Some(payload) = self.buffer.take() {
            self.answer(&payload, now_ms);
        }
    }

    /// What is to be done now; none until [`Self::wake_at_ms`] or until bytes come.
    pub fn next_action(&mut self, now_ms: u64) -> Option<Action> {
        if let Some((at_ms, _)) = self.queue.front() {
            let is_due = *at_ms <= now_ms;
            return is_due
                .then(|| self.queue.pop_front().map(|(_, action)| action))
                .flatten();
        }
        if self.step == Step::Done {
            return None;
        }
        if now_ms >= self.deadline_ms {
            self.missed(now_ms);
            return self.next_action(now_ms);
        }
        if self.step == Step::Sync && now_ms >= self.next_pulse_ms {
            self.next_pulse_ms = now_ms + PULSE_MS;
            return Some(Action::Send(vec![0x7F]));
        }
        None
    }

    /// No answer in time.
    fn missed(&mut self, now_ms: u64) {
        match self.step {
            Step::RateTrial | Step::RateSet | Step::Ping { .. } => {
                self.rates_failed += 1;
                self.again(IspError::NoRate, now_ms);
            }
            Step::Sync => self.again(IspError::NoLoader, now_ms),
            // The program starts at once on some loaders, without an answer.
            Step::Run => self.finish(),
            step => {
                let attempts = self.attempts;
                self.again(IspError::Silent { step, attempts }, now_ms);
            }
        }
    }

    fn again(&mut self, error: IspError, now_ms: u64) {
        if self.attempts < ATTEMPTS {
            self.begin(now_ms);
        } else {
            self.fail(error);
        }
    }

    fn fail(&mut self, error: IspError) {
        self.step = Step::Done;
        self.queue.clear();
        self.queue.push_back((0, Action::SetBaud(HANDSHAKE_BAUD)));
        self.queue.push_back((0, Action::Fail(error)));
    }

    fn finish(&mut self) {
        self.step = Step::Done;
        if let Some(report) = self.status {
            let written_bytes = self.progress().1;
            let baud = self.rate.map(|rate| rate.baud);
            let report = Report {
                baud,
                written_bytes,
                ..report
            };
            self.queue.push_back((0, Action::Finish(report)));
        }
    }

    fn answer(&mut self, payload: &[u8], now_ms: u64) {
        match (self.step, payload) {
            (Step::Sync, [0x00, ..]) => self.take_status(payload, now_ms),
            (Step::RateTrial, [0x8F, ..]) => self.set_rate(now_ms),
            (Step::RateSet, [0x8E, ..]) => self.ping(PINGS, now_ms),
            (Step::Ping { left: 1 }, [0x80, ..]) => self.erase(now_ms),
            (Step::Ping { left }, [0x80, ..]) => self.ping(left - 1, now_ms),
            (Step::Erase, [0x80, ..]) => self.write(0, now_ms),
            (Step::Write { address }, [0x80, told, ..]) => self.take_block(address, *told, now_ms),
            (Step::Options, [0x8D, ..]) => self.run(now_ms),
            (Step::Run, [0x80, ..]) => self.finish(),
            // An answer to something else: it is late, and the right one comes or the deadline does.
            _ => {}
        }
    }

    fn take_status(&mut self, payload: &[u8], now_ms: u64) {
        let Some(report) = status_of(payload) else {
            self.again(IspError::NotUnderstood, now_ms);
            return;
        };
        if report.model != Model::RELAX {
            self.fail(IspError::WrongModel(report.model.id));
            return;
        }
        self.status = Some(report);
        match self.job {
            Job::Probe => self.run(now_ms),
            Job::Write(_) => self.try_rate(report.clock, now_ms),
        }
    }

    fn try_rate(&mut self, clock: ChipClock, now_ms: u64) {
        let Some(rate) = clock.rates().nth(self.rates_failed) else {
            self.fail(IspError::NoRate);
            return;
        };
        self.rate = Some(rate);
        let mut payload = rate_payload(0x8F, rate);
        payload.push(0x80 | clock.flash_wait());
        self.ask(Step::RateTrial, &payload, now_ms);
        self.switch_after(payload.len(), now_ms, rate);
    }

    /// Sets the rate when the frame has left at the old one and the chip has switched.
    fn switch_after(&mut self, payload_bytes: usize, now_ms: u64, rate: RateSetting) {
        let sent_ms = (payload_bytes as u64 + 8) * 10_000 / u64::from(self.baud) + 1;
        let switched_ms = now_ms + sent_ms + SWITCH_MS;
        self.set_baud(switched_ms, rate.baud);
        self.deadline_ms = switched_ms + TRIAL_MS;
    }

    fn set_rate(&mut self, now_ms: u64) {
        let Some(rate) = self.rate else { return };
        // Both return to the rate of the handshake before the rate is set for good.
        self.queue.clear();
        self.set_baud(now_ms, HANDSHAKE_BAUD);
        let at_ms = now_ms + SWITCH_MS;
        let payload = rate_payload(0x8E, rate);
        self.ask(Step::RateSet, &payload, at_ms);
        self.switch_after(payload.len(), at_ms, rate);
    }

    fn ping(&mut self, left: u8, now_ms: u64) {
        self.queue.clear();
        let [high, low] = Model::RELAX.id.to_be_bytes();
        self.ask(
            Step::Ping { left },
            &[0x80, 0x00, 0x00, 0x36, 0x01, high, low],
            now_ms,
        );
        self.deadline_ms = now_ms + TRIAL_MS;
    }

    fn erase(&mut self, now_ms: u64) {
        let (_, total) = self.progress();
        // Blocks of 256 bytes, in whole sectors of 512.
        let blocks = (total.div_ceil(512) * 2) as u8;
        let fill = [0x33; 6];
        let mut payload = vec![0x84, blocks];
        payload.extend(fill);
        self.ask(Step::Erase, &payload, now_ms);
    }

    /// The block at an address, padded with zeros.
    fn block(&self, address: usize) -> Option<[u8; BLOCK_BYTES]> {
        let Job::Write(image) = &self.job else {
            return None;
        };
        let rest = image.get(address..).filter(|rest| !rest.is_empty())?;
        let mut block = [0; BLOCK_BYTES];
        for (place, byte) in block.iter_mut().zip(rest) {
            *place = *byte;
        }
        Some(block)
    }

    fn write(&mut self, address: usize, now_ms: u64) {
        match self.block(address) {
            Some(block) => {
                let [high, low] = (address as u16).to_be_bytes();
                let mut payload = vec![0, 0, 0, high, low, 0, BLOCK_BYTES as u8];
                payload.extend(block);
                self.ask(Step::Write { address }, &payload, now_ms);
            }
            None => self.write_options(now_ms),
        }
    }

    fn take_block(&mut self, address: usize, told: u8, now_ms: u64) {
        let wanted = self.block(address).map(|block| sum(&block));
        if wanted == Some(told) {
            self.write(address + BLOCK_BYTES, now_ms);
        } else {
            let attempts = self.attempts;
            self.again(IspError::BlockSum { address, attempts }, now_ms);
        }
    }

    fn write_options(&mut self, now_ms: u64) {
        let found = self.status.map(|report| report.options_found).unwrap_or_default();
        let options = OptionByte::from_chip(found);
        if options.byte() == found {
            self.run(now_ms);
        } else {
            self.ask(Step::Options, &[0x8D, options.byte(), 0xFF, 0xFF, 0xFF], now_ms);
        }
    }

    fn run(&mut self, now_ms: u64) {
        self.ask(Step::Run, &[0x82], now_ms);
        self.deadline_ms = now_ms + TRIAL_MS;
    }
}

/// Reload value with its checks, and the chip's pause.
fn rate_payload(command: u8, rate: RateSetting) -> Vec<u8> {
    let [high, low] = rate.reload.to_be_bytes();
    let check = 0_u8.wrapping_sub(low).wrapping_mul(2);
    vec![command, high, low, 0xFF - high, check, 0xA0]
}

fn status_of(payload: &[u8]) -> Option<Report> {
    if payload.len() < STATUS_BYTES {
        return None;
    }
    let (counters, rest) = payload.get(1..)?.split_at_checked(16)?;
    let [loader_version, _stepping, options_found, high, low, ..] = rest else {
        return None;
    };
    let counters: Vec<u16> = counters
        .chunks_exact(2)
        .filter_map(|pair| Some(u16::from_be_bytes(pair.try_into().ok()?)))
        .collect();
    let id = u16::from_be_bytes([*high, *low]);
    let unknown = Model {
        name: "unknown",
        id,
        code_bytes: 0,
    };
    Some(Report {
        model: Model::of_id(id).unwrap_or(unknown),
        clock: ChipClock::of_counters(&counters, clocks_per_cycle(*options_found))?,
        loader_version: *loader_version,
        options_found: *options_found,
        baud: None,
        written_bytes: 0,
    })
}
