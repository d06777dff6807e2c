//! Which faults come when: a random plan from a seed.

use home::{Pcg, SensorFault, SensorId};
use robot::FaultRates;
use rvac_api::RequestBody;
use rvac_protocol::message::ResetCause;

/// One fault or disturbance.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Fault {
    /// The line damages bytes for a while.
    Noise { rates: FaultRates, ms: u64 },
    /// The cable is out for a while.
    CutOut { ms: u32 },
    /// The line carries nothing for a while, then everything.
    Delay { ms: u32 },
    /// The microcontroller restarts.
    Reset(ResetCause),
    /// The host dies and comes back after a while.
    HostDeath { ms: u64 },
    /// A sensor lies for a while.
    Sensor {
        sensor: SensorId,
        lie: SensorFault,
        ms: u64,
    },
    /// Somebody holds the robot up for a while.
    Lift { ms: u64 },
    /// Somebody holds a button down for a while.
    Button { button: u8, ms: u64 },
    /// A client says something.
    Request(RequestBody),
}

/// Kinds of fault, for counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FaultKind {
    /// Bytes flipped, lost, doubled, delayed, for a while.
    LineNoise,
    /// Cable out.
    CutOut,
    /// Bytes held back.
    Delay,
    /// Reset of the microcontroller.
    Reset,
    /// Death of the host.
    HostDeath,
    /// A sensor is stuck.
    SensorStuck,
    /// A sensor is noisy or inverted.
    SensorNoisy,
    /// Robot lifted.
    Lift,
    /// Button pressed.
    Button,
    /// Client command.
    Request,
}

impl FaultKind {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::LineNoise,
        Self::CutOut,
        Self::Delay,
        Self::Reset,
        Self::HostDeath,
        Self::SensorStuck,
        Self::SensorNoisy,
        Self::Lift,
        Self::Button,
        Self::Request,
    ];

    /// Name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::LineNoise => "line-noise",
            Self::CutOut => "cut-out",
            Self::Delay => "delay",
            Self::Reset => "mcu-reset",
            Self::HostDeath => "host-death",
            Self::SensorStuck => "sensor-stuck",
            Self::SensorNoisy => "sensor-noisy",
            Self::Lift => "lift",
            Self::Button => "button",
            Self::Request => "client-command",
        }
    }
}

impl Fault {
    pub(crate) const fn kind(&self) -> FaultKind {
        match self {
            Self::Noise { .. } => FaultKind::LineNoise,
            Self::CutOut { .. } => FaultKind::CutOut,
            Self::Delay { .. } => FaultKind::Delay,
            Self::Reset(_) => FaultKind::Reset,
            Self::HostDeath { .. } => FaultKind::HostDeath,
            Self::Sensor {
                lie: SensorFault::StuckAt(_),
                ..
            } => FaultKind::SensorStuck,
            Self::Sensor { .. } => FaultKind::SensorNoisy,
            Self::Lift { .. } => FaultKind::Lift,
            Self::Button { .. } => FaultKind::Button,
            Self::Request(_) => FaultKind::Request,
        }
    }
}

const STREAM: u64 = 0xFA17;
/// Mean pause between two faults.
const PAUSE_MS: f64 = 4_000.0;
/// Sensors that can lie. Two drop switches and two bumper halves each watch one thing, and so do three cliff sensors:
/// one of them lies at a time, because the rules promise to survive single faults.
const SENSORS: [SensorId; 18] = [
    SensorId::BumperLeft,
    SensorId::BumperRight,
    SensorId::Cliff(0),
    SensorId::Cliff(1),
    SensorId::Cliff(2),
    SensorId::WheelDropLeft,
    SensorId::WheelDropRight,
    SensorId::Proximity(0),
    SensorId::Proximity(3),
    SensorId::EncoderLeft,
    SensorId::EncoderRight,
    SensorId::Gyro,
    SensorId::DockReceiver(0),
    SensorId::DockContacts,
    SensorId::BatteryVoltage,
    SensorId::WheelLeftCurrent,
    SensorId::WheelRightCurrent,
    SensorId::Button(0),
];
const CAUSES: [ResetCause; 5] = [
    ResetCause::PowerOn,
    ResetCause::BrownOut,
    ResetCause::Watchdog,
    ResetCause::External,
    ResetCause::Software,
];

/// Draws faults one after the other.
#[derive(Debug)]
pub(crate) struct FaultDraw {
    random: Pcg,
}

impl FaultDraw {
    pub(crate) fn new(seed: u64) -> Self {
        Self {
            random: Pcg::new(seed, STREAM),
        }
    }

    /// Pause before the next fault: none or short now and then, so that faults overlap.
    pub(crate) fn pause_ms(&mut self) -> u64 {
        let share = self.random.unit();
        (2.0 * PAUSE_MS * share * share * 1.5) as u64 + 1
    }

    /// The next fault.
    pub(crate) fn fault(&mut self) -> Fault {
        match self.random.below(20) {
            0..4 => Fault::Noise {
                rates: self.rates(),
                ms: self.span_ms(500, 10_000),
            },
            4 | 5 => Fault::CutOut {
                ms: self.span_ms(5, 4_000) as u32,
            },
            6 | 7 => Fault::Delay {
                ms: self.span_ms(5, 3_000) as u32,
            },
            8 => Fault::Reset(self.one_of(CAUSES)),
            9 => Fault::HostDeath {
                ms: self.span_ms(50, 8_000),
            },
            10..14 => self.sensor(),
            14 => Fault::Lift {
                ms: self.span_ms(20, 4_000),
            },
            15 => Fault::Button {
                button: self.random.below(3) as u8,
                ms: self.span_ms(1, 800),
            },
            _ => Fault::Request(self.request()),
        }
    }

    fn rates(&mut self) -> FaultRates {
        // From one bad bit in 100,000 to one in 100, evenly by orders of magnitude.
        let strength = [1e-5, 1e-4, 1e-3, 1e-2][self.random.below(4) as usize];
        let mut rate = |often: u32| {
            if self.random.below(often) == 0 {
                strength
            } else {
                0.0
            }
        };
        FaultRates {
            bit_error: rate(2),
            lost_byte: rate(2),
            doubled_byte: rate(3),
            cut_out: rate(4),
            burst: rate(4),
            delay: rate(4),
            overrun: rate(4),
            run_bytes_max: 64,
        }
    }

    fn sensor(&mut self) -> Fault {
        let sensor = self.one_of(SENSORS);
        let lie = match self.random.below(4) {
            0 | 1 => SensorFault::StuckAt(self.one_of([0, 1, 100, 255])),
            2 => SensorFault::Noisy(self.one_of([0.001, 0.05, 0.5, 20.0])),
            _ => SensorFault::Inverted,
        };
        Fault::Sensor {
            sensor,
            lie,
            ms: self.span_ms(10, 15_000),
        }
    }

    fn request(&mut self) -> RequestBody {
        match self.random.below(9) {
            0 => RequestBody::Stop,
            1 => RequestBody::Pause,
            2 => RequestBody::Resume,
            3 => RequestBody::Spot,
            4 => RequestBody::Dock,
            5 => RequestBody::Release,
            6 => RequestBody::Locate,
            7 => RequestBody::Start { strategy: None },
            _ => RequestBody::Drive {
                v: 0.3 * self.random.symmetric(),
                w: 1.5 * self.random.symmetric(),
                ttl: 400,
                clean: self.random.below(2) == 0,
                power: None,
            },
        }
    }

    fn span_ms(&mut self, least: u32, most: u32) -> u64 {
        // Short spans as often as long ones, to hit the limits of reaction times.
        let share = self.random.unit();
        u64::from(least) + (f64::from(most - least) * share * share * share) as u64
    }

    fn one_of<T: Copy, const N: usize>(&mut self, choices: [T; N]) -> T {
        choices[self.random.below(N as u32) as usize]
    }
}
