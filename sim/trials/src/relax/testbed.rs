//! A hosted Relax whose host renews motion and cleaning, and a person who may type.

use rvac_protocol::message::{BinaryKinds, Command, Drive, Motor, MotorCommand, Sequence};
use rvac_units::{AngularSpeed, Speed, Throttle, Tick};
use stc90::hosted::{HostedBlueprint, HostedError, HostedRelax};

/// Life of the host's motion commands and how often they are renewed, ms: as vthal does it. Cleaners are renewed less often,
/// because the line is slow.
const LEASE_MS: u16 = 120;
const RENEW_MS: u64 = 30;
const CLEANERS_MS: u64 = 300;
const CLEANERS_LEASE_MS: u16 = 1_000;
/// Period of a terminal that repeats what a person typed, ms.
const TYPE_MS: u64 = 100;
/// The host floods the line with so many bytes in a row.
const FLOOD_BYTES: usize = 64;

/// The testbed.
#[derive(Clone, Debug)]
pub struct RelaxTestbed {
    pub(super) pair: HostedRelax,
    pub(super) drive: Option<(Speed, AngularSpeed)>,
    pub(super) cleans: bool,
    pub(super) typed: Option<&'static str>,
    /// Nonsense fills the line.
    pub(super) is_flooded: bool,
}

impl RelaxTestbed {
    /// A robot that has described itself to its host.
    ///
    /// # Errors
    /// When it does not.
    pub fn connected(blueprint: &HostedBlueprint) -> Result<Self, HostedError> {
        let kinds = BinaryKinds {
            state: true,
            drive: true,
        };
        let mut pair = blueprint.robot(kinds);
        pair.connect()?;
        Ok(Self {
            pair,
            drive: None,
            cleans: false,
            typed: None,
            is_flooded: false,
        })
    }

    /// One millisecond.
    pub fn tick(&mut self) {
        let ms = self.pair.robot().now_ms();
        if let (Some((speed, turn)), 0) = (self.drive, ms % RENEW_MS) {
            self.pair.say(Command::Drive(Drive {
                speed,
                turn,
                lease_ms: LEASE_MS,
                sequence: Sequence(0),
                seen_tick: Tick(0),
            }));
        }
        if self.cleans && ms.is_multiple_of(CLEANERS_MS) {
            for motor in [Motor::BrushMain, Motor::BrushSides, Motor::Vacuum] {
                self.pair.say(Command::Motor(MotorCommand {
                    motor,
                    throttle: Throttle::FULL,
                    lease_ms: CLEANERS_LEASE_MS,
                    sequence: Sequence(0),
                    seen_tick: Tick(0),
                }));
            }
        }
        if let (Some(text), 0) = (self.typed, ms % TYPE_MS) {
            self.pair.type_in(text);
        }
        if self.is_flooded && self.pair.waiting() < FLOOD_BYTES {
            self.pair.send(&[b'{'; FLOOD_BYTES]);
        }
        self.pair.tick();
    }

    /// So many milliseconds.
    pub fn run(&mut self, ms: u64) {
        (0..ms).for_each(|_| self.tick());
    }

    /// Cycles of the chip since power-on.
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.pair.robot().cycle()
    }

    /// The pair.
    #[must_use]
    pub const fn pair(&self) -> &HostedRelax {
        &self.pair
    }
}
