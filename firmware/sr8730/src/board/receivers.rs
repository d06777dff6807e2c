//! The four infrared receivers of the dock's beams: INT3, INT4, INT0, INT1.
//!
//! An external interrupt triggers on one polarity, so each handler selects the opposite edge after it has stored this
//! one.

use cordlib::board::DockBeams;
use pic32mx3_hal::cpu;
use pic32mx3_hal::external::{Edge as TriggerEdge, ExternalPin};
use pic32mx3_hal::gpio::{Input, Pin};
use pic32mx3_hal::interrupt;
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use rvac_protocol::message::DockReceivers;
use soft_uart::{Edge, EdgeRing, Level, Queued};

use super::tick;
use crate::logic::beam::{BeamCodes, BeamReceiver, Light};
use crate::logic::interrupt_rate::InterruptRateLimit;

const RECEIVERS: usize = 4;
/// Edges of one receiver in a millisecond; a code makes two at most.
const EDGES_PER_MS: u32 = 20;
/// Edges of one receiver that wait for the main loop.
const EDGES: usize = 32;

static HEARD: [EdgeRing<EDGES>; RECEIVERS] = [const { EdgeRing::new() }; RECEIVERS];
static RATE_LIMITS: [InterruptRateLimit; RECEIVERS] =
    [const { InterruptRateLimit::new(EDGES_PER_MS) }; RECEIVERS];

type DockLeft = Pin<'A', 14, Input>;
type DockRight = Pin<'A', 15, Input>;
#[cfg(not(feature = "link-spi"))]
type RearLeft = Pin<'F', 6, Input>;
type RearRight = Pin<'E', 8, Input>;

static DOCK_LEFT: HandlerCell<vector::EXTERNAL_3, DockLeft> = HandlerCell::empty();
static DOCK_RIGHT: HandlerCell<vector::EXTERNAL_4, DockRight> = HandlerCell::empty();
#[cfg(not(feature = "link-spi"))]
static REAR_LEFT: HandlerCell<vector::EXTERNAL_0, RearLeft> = HandlerCell::empty();
static REAR_RIGHT: HandlerCell<vector::EXTERNAL_1, RearRight> = HandlerCell::empty();

/// The order is that of the wire: dock left, dock right, rear left, rear right.
const SOURCES: [Source; RECEIVERS] = [
    Source::External3,
    Source::External4,
    Source::External0,
    Source::External1,
];

/// Those that are there.
#[cfg(not(feature = "link-spi"))]
const FITTED: [Source; RECEIVERS] = SOURCES;

/// Those that are there: a link by SPI has the pin of the rear left one, which then never hears anything.
#[cfg(feature = "link-spi")]
const FITTED: [Source; 3] = [Source::External3, Source::External4, Source::External1];

macro_rules! on_edge {
    ($handler:ident, $vector:ident, $cell:ident, $number:literal) => {
        fn $handler(context: &mut Context<vector::$vector>) {
            let at = cpu::count();
            if let Some(pin) = $cell.get(context) {
                let heard = follow(pin);
                let level = if heard { Level::Low } else { Level::High };
                HEARD[$number].push(Edge { at, level });
            }
            if !RATE_LIMITS[$number].spend() {
                SOURCES[$number].disable();
            }
        }
        interrupt!($vector, $handler);
    };
}

on_edge!(on_dock_left, EXTERNAL_3, DOCK_LEFT, 0);
on_edge!(on_dock_right, EXTERNAL_4, DOCK_RIGHT, 1);
#[cfg(not(feature = "link-spi"))]
on_edge!(on_rear_left, EXTERNAL_0, REAR_LEFT, 2);
on_edge!(on_rear_right, EXTERNAL_1, REAR_RIGHT, 3);

/// Selects the edge that leads away from the present level, and returns whether the receiver sees the carrier (low). If
/// the level changes meanwhile, that edge is missed, so the level is read again.
trait Follow {
    fn is_hearing(&self) -> bool;
    fn wait_for(&mut self, edge: TriggerEdge);
}

impl<const PORT: char, const NUMBER: u8> Follow for Pin<PORT, NUMBER, Input>
where
    Self: ExternalPin,
{
    fn is_hearing(&self) -> bool {
        self.is_low()
    }

    fn wait_for(&mut self, edge: TriggerEdge) {
        self.select_edge(edge);
    }
}

fn follow(pin: &mut impl Follow) -> bool {
    for _ in 0..3 {
        let hearing = pin.is_hearing();
        pin.wait_for(if hearing {
            TriggerEdge::Rising
        } else {
            TriggerEdge::Falling
        });
        if pin.is_hearing() == hearing {
            return hearing;
        }
    }
    pin.is_hearing()
}

/// Pins of the receivers.
#[derive(Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub struct ReceiverPins {
    pub dock_left: DockLeft,
    pub dock_right: DockRight,
    #[cfg(not(feature = "link-spi"))]
    pub rear_left: RearLeft,
    pub rear_right: RearRight,
}

/// All four receivers.
#[derive(Debug)]
pub struct BeamReceivers {
    codes: Option<BeamCodes>,
    receivers: [BeamReceiver; RECEIVERS],
    symbols: DockReceivers,
}

impl BeamReceivers {
    /// Starts receiving, if the beams' codes are calibrated.
    #[must_use]
    pub fn take(mut pins: ReceiverPins, codes: Option<BeamCodes>) -> Self {
        follow(&mut pins.dock_left);
        follow(&mut pins.dock_right);
        #[cfg(not(feature = "link-spi"))]
        follow(&mut pins.rear_left);
        follow(&mut pins.rear_right);
        // Each is given once, because `Peripherals` gives its pins once.
        DOCK_LEFT.hand_over(pins.dock_left).ok();
        DOCK_RIGHT.hand_over(pins.dock_right).ok();
        #[cfg(not(feature = "link-spi"))]
        REAR_LEFT.hand_over(pins.rear_left).ok();
        REAR_RIGHT.hand_over(pins.rear_right).ok();
        for vector in [
            Vector::External0,
            Vector::External1,
            Vector::External3,
            Vector::External4,
        ] {
            interrupt::set_priority(vector, Priority::Level3, SubPriority::Sub0).ok();
        }
        if codes.is_some() {
            for source in FITTED {
                source.enable();
            }
        }
        Self {
            codes,
            receivers: [BeamReceiver::default(); RECEIVERS],
            symbols: [0; RECEIVERS],
        }
    }

    /// Called once a millisecond: decodes the received edges.
    pub fn service(&mut self) {
        let Some(codes) = self.codes else {
            return;
        };
        let (count, now) = (cpu::count(), tick::ticks());
        let places = self.receivers.iter_mut().zip(&mut self.symbols);
        for ((receiver, symbol), heard) in places.zip(&HEARD) {
            while let Some(queued) = heard.pop() {
                if let Queued::Edge(edge) = queued {
                    let light = match edge.level {
                        Level::Low => Light::Carrier,
                        Level::High => Light::Dark,
                    };
                    receiver.edge(light, edge.at, &codes);
                }
            }
            *symbol = receiver.poll(count, now, &codes);
        }
        for (budget, source) in RATE_LIMITS.iter().zip(SOURCES) {
            if budget.renew() {
                source.enable();
            }
        }
    }
}

impl DockBeams for BeamReceivers {
    const COUNT: u8 = RECEIVERS as u8;

    fn symbols(&mut self) -> DockReceivers {
        self.symbols
    }
}
