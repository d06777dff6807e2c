//! The ports: TRIS, LAT, PORT and ODC, who drives a pin, and what its level is.
//!
//! *Outside* is what the circuit around the chip does to a pin. *Owned* pins are driven by a peripheral instead of LAT and
//! TRIS; *pulsed* ones among them change by a rule (PWM), so that their level is asked for and not stored here.

use crate::pins::{Level, PIN_PLACES, Pin, PinDriver, Port};
use std::collections::BTreeMap;

/// One port.
#[derive(Clone, Copy, Debug)]
struct PortState {
    tris: u16,
    lat: u16,
    open_drain: u16,
    pull_up: u16,
    /// Resistors to the supply on the board.
    board_pull_up: u16,
    analog: u16,
    owned: u16,
    owned_high: u16,
    /// Owned by a peripheral that only pulls low.
    owned_open: u16,
    /// Held as inputs by something stronger than TRIS: JTAG, the crystal, a receiver.
    held: u16,
    outside: u16,
    outside_high: u16,
    driven: u16,
    driven_high: u16,
    level: u16,
}

impl PortState {
    const RESET: PortState = PortState {
        tris: 0xFFFF,
        lat: 0,
        open_drain: 0,
        pull_up: 0,
        board_pull_up: 0,
        analog: 0,
        owned: 0,
        owned_high: 0,
        owned_open: 0,
        held: 0,
        outside: 0,
        outside_high: 0,
        driven: 0,
        driven_high: 0,
        level: 0,
    };

    /// Works out who drives and what the levels are.
    fn settle(&mut self) {
        let high = (self.lat & !self.owned) | (self.owned_high & self.owned);
        let wanted = (!self.tris | self.owned) & !self.held;
        self.driven = wanted & !((self.open_drain | self.owned_open) & high);
        self.driven_high = self.driven & high;
        let undriven =
            (self.outside & self.outside_high) | (!self.outside & (self.pull_up | self.board_pull_up));
        self.level = self.driven_high | (undriven & !self.driven);
    }

    /// What the program reads: analog pins are 0.
    fn inputs(&self) -> u16 {
        self.level & !self.analog
    }

    fn conflicts(&self) -> u16 {
        self.driven & self.outside & (self.driven_high ^ self.outside_high)
    }
}

/// One of a port's registers, or a mask that a peripheral has for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Field {
    Tris,
    Lat,
    OpenDrain,
    PullUp,
    BoardPullUp,
    Analog,
    Held,
}

/// What a change on a port led to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Changes {
    /// Bits that the program would read otherwise now.
    pub(crate) inputs: u16,
    /// Bits that the chip now drives against the outside and did not before.
    pub(crate) conflicts: u16,
}

/// All ports.
#[derive(Clone, Debug)]
pub(crate) struct Ports {
    states: [PortState; 7],
    high_cycles: [u64; PIN_PLACES],
    high_since: [u64; PIN_PLACES],
    changed: [u64; PIN_PLACES],
    watched: [u16; 7],
    edges: BTreeMap<Pin, Vec<(u64, Level)>>,
}

impl Ports {
    pub(crate) fn new() -> Ports {
        Ports {
            states: [PortState::RESET; 7],
            high_cycles: [0; PIN_PLACES],
            high_since: [0; PIN_PLACES],
            changed: [0; PIN_PLACES],
            watched: [0; 7],
            edges: BTreeMap::new(),
        }
    }

    /// Back to inputs; what the outside does stays.
    pub(crate) fn reset(&mut self, cycle: u64) -> [Changes; 7] {
        Port::ALL.map(|port| {
            self.change(port, cycle, |state| {
                *state = PortState {
                    outside: state.outside,
                    outside_high: state.outside_high,
                    board_pull_up: state.board_pull_up,
                    ..PortState::RESET
                };
            })
        })
    }

    pub(crate) fn field(&self, port: Port, field: Field) -> u16 {
        let state = &self.states[port.index()];
        match field {
            Field::Tris => state.tris & port.present(),
            Field::Lat => state.lat,
            Field::OpenDrain => state.open_drain,
            Field::PullUp => state.pull_up,
            Field::BoardPullUp => state.board_pull_up,
            Field::Analog => state.analog,
            Field::Held => state.held,
        }
    }

    pub(crate) fn set_field(&mut self, (port, field): (Port, Field), value: u16, cycle: u64) -> Changes {
        let value = value & port.present();
        self.change(port, cycle, |state| match field {
            Field::Tris => state.tris = value | !port.present(),
            Field::Lat => state.lat = value,
            Field::OpenDrain => state.open_drain = value,
            Field::PullUp => state.pull_up = value,
            Field::BoardPullUp => state.board_pull_up = value,
            Field::Analog => state.analog = value,
            Field::Held => state.held = value,
        })
    }

    /// A peripheral drives the pin, or gives it back to LAT and TRIS.
    pub(crate) fn own(&mut self, pin: Pin, driven: Option<Level>, cycle: u64) -> Changes {
        self.change(pin.port(), cycle, |state| match driven {
            Some(level) => {
                state.owned |= pin.mask();
                set_bit(&mut state.owned_high, pin, level.is_high());
            }
            None => {
                state.owned &= !pin.mask();
                state.owned_open &= !pin.mask();
            }
        })
    }

    /// A peripheral pulls the pin low, or lets it go without giving it back to LAT and TRIS.
    pub(crate) fn own_open_drain(&mut self, pin: Pin, releases: bool, cycle: u64) -> Changes {
        self.change(pin.port(), cycle, |state| {
            state.owned |= pin.mask();
            state.owned_open |= pin.mask();
            set_bit(&mut state.owned_high, pin, releases);
        })
    }

    /// An owned pin has had this level for some time already: its edge was written down and its time counted elsewhere.
    pub(crate) fn take_over(&mut self, pin: Pin, level: Level, cycle: u64) {
        let state = &mut self.states[pin.port().index()];
        set_bit(&mut state.owned_high, pin, level.is_high());
        state.settle();
        self.high_since[pin.index()] = cycle;
    }

    /// The outside drives the pin, or leaves it alone.
    pub(crate) fn set_outside(&mut self, pin: Pin, driven: Option<Level>, cycle: u64) -> Changes {
        self.change(pin.port(), cycle, |state| {
            set_bit(&mut state.outside, pin, driven.is_some());
            set_bit(&mut state.outside_high, pin, driven == Some(Level::High));
        })
    }

    fn change(&mut self, port: Port, cycle: u64, change: impl FnOnce(&mut PortState)) -> Changes {
        let state = &mut self.states[port.index()];
        let before = *state;
        change(state);
        state.settle();
        let after = *state;
        self.account(port, before.driven_high ^ after.driven_high, cycle);
        let changes = Changes {
            inputs: (before.inputs() ^ after.inputs()) & port.present(),
            conflicts: after.conflicts() & !before.conflicts() & port.present(),
        };
        self.note_edges(port, before.level ^ after.level, cycle);
        changes
    }

    fn account(&mut self, port: Port, changed: u16, cycle: u64) {
        let high = self.states[port.index()].driven_high;
        for bit in bits(changed) {
            let place = port.index() * 16 + usize::from(bit);
            self.changed[place] = cycle;
            if high & (1 << bit) != 0 {
                self.high_since[place] = cycle;
            } else {
                self.high_cycles[place] += cycle.saturating_sub(self.high_since[place]);
            }
        }
    }

    fn note_edges(&mut self, port: Port, changed: u16, cycle: u64) {
        let level = self.states[port.index()].level;
        for bit in bits(changed & self.watched[port.index()]) {
            if let Some(pin) = Pin::new(port, bit) {
                self.note_edge(pin, Level::of(level & (1 << bit) != 0), cycle);
            }
        }
    }

    /// Records an edge for the observers of the pin.
    pub(crate) fn note_edge(&mut self, pin: Pin, level: Level, cycle: u64) {
        if let Some(edges) = self.edges.get_mut(&pin) {
            edges.push((cycle, level));
        }
    }

    pub(crate) fn watch(&mut self, pin: Pin) {
        self.watched[pin.port().index()] |= pin.mask();
        self.edges.entry(pin).or_default();
    }

    /// Where the edges of a pin are written down, if it is watched.
    pub(crate) fn edges_of(&mut self, pin: Pin) -> Option<&mut Vec<(u64, Level)>> {
        if self.watched[pin.port().index()] & pin.mask() == 0 {
            None
        } else {
            self.edges.get_mut(&pin)
        }
    }

    pub(crate) fn take_edges(&mut self, pin: Pin) -> Vec<(u64, Level)> {
        self.edges.get_mut(&pin).map(std::mem::take).unwrap_or_default()
    }

    /// Levels of a port's pins as a voltmeter sees them; those of absent pins are 0.
    pub(crate) fn levels(&self, port: Port) -> u16 {
        self.states[port.index()].level & port.present()
    }

    /// What the program reads from a port.
    pub(crate) fn inputs(&self, port: Port) -> u16 {
        self.states[port.index()].inputs() & port.present()
    }

    pub(crate) fn output(&self, pin: Pin) -> PinDriver {
        let state = &self.states[pin.port().index()];
        if state.driven & pin.mask() == 0 {
            PinDriver::Floating
        } else {
            Level::of(state.driven_high & pin.mask() != 0).into()
        }
    }

    /// The cycle at which the chip last began or ceased to drive the pin high, PWM left out.
    pub(crate) fn changed(&self, pin: Pin) -> u64 {
        self.changed[pin.index()]
    }

    /// For how many cycles the chip has driven the pin high up to `cycle`.
    pub(crate) fn high_cycles(&self, pin: Pin, cycle: u64) -> u64 {
        let place = pin.index();
        let now = match self.output(pin) {
            PinDriver::High => cycle.saturating_sub(self.high_since[place]),
            PinDriver::Low | PinDriver::Floating => 0,
        };
        self.high_cycles[place] + now
    }
}

fn set_bit(mask: &mut u16, pin: Pin, set: bool) {
    *mask = (*mask & !pin.mask()) | if set { pin.mask() } else { 0 };
}

/// The numbers of the set bits, ascending.
pub(crate) fn bits(mask: u16) -> impl Iterator<Item = u8> {
    let mut rest = mask;
    std::iter::from_fn(move || {
        let bit = u8::try_from(rest.trailing_zeros()).ok().filter(|&bit| bit < 16)?;
        rest &= rest - 1;
        Some(bit)
    })
}
