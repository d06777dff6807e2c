//! The ports: latches, what the circuit does to the pins, and edges that somebody watches.

use crate::pins::{Edge, Level, Levels, PORTS, Pin, SwitchedInputs};

/// All pins.
#[derive(Clone, Debug)]
pub(super) struct Ports {
    latches: Levels,
    inputs: Levels,
    switched: Option<SwitchedInputs>,
    watched: [u8; PORTS],
    edges: Vec<Edge>,
}

impl Ports {
    pub(super) fn new() -> Self {
        Self {
            latches: Levels::HIGH,
            inputs: Levels::HIGH,
            switched: None,
            watched: [0; PORTS],
            edges: Vec::new(),
        }
    }

    /// What the chip does: a zero pulls the pin low.
    pub(super) fn latches(&self) -> Levels {
        self.latches
    }

    /// The levels of the pins.
    pub(super) fn levels(&self) -> Levels {
        let switched = self.switched();
        let mut levels = self.latches;
        for (port, level) in levels.0.iter_mut().enumerate() {
            *level &= self.inputs.0[port] & switched.0[port];
        }
        levels
    }

    /// What the circuit does to inputs that depend on a latch, by that latch.
    fn switched(&self) -> Levels {
        match &self.switched {
            None => Levels::HIGH,
            Some(inputs) if self.latches.level(inputs.by).is_high() => inputs.high,
            Some(inputs) => inputs.low,
        }
    }

    pub(super) fn latch(&self, port: usize) -> u8 {
        self.latches.0[port]
    }

    pub(super) fn level(&self, port: usize) -> u8 {
        self.latches.0[port] & self.inputs.0[port] & self.switched().0[port]
    }

    /// The program writes a port.
    pub(super) fn write(&mut self, port: usize, value: u8, cycle: u64) {
        let changed = self.latches.0[port] ^ value;
        self.latches.0[port] = value;
        let mut seen = changed & self.watched[port];
        while let Some(bit) = seen.checked_ilog2() {
            seen &= !(1 << bit);
            let pin = Pin::known(port as u8, bit as u8);
            let level = Level::of(value & pin.mask() != 0);
            self.edges.push(Edge { cycle, pin, level });
        }
    }

    /// The circuit pulls a pin low, or lets it go.
    pub(super) fn set_input(&mut self, pin: Pin, level: Level) {
        self.inputs.set(pin, level);
    }

    /// The circuit does so to all pins.
    pub(super) fn set_inputs(&mut self, levels: Levels) {
        self.inputs = levels;
    }

    /// The circuit lets inputs depend on a latch.
    pub(super) fn switch_inputs(&mut self, inputs: SwitchedInputs) {
        self.switched = Some(inputs);
    }

    /// Edges of a latch are kept from now on.
    pub(super) fn watch(&mut self, pin: Pin) {
        self.watched[pin.port()] |= pin.mask();
    }

    /// Edges since the last call, in their order.
    pub(super) fn take_edges(&mut self) -> Vec<Edge> {
        std::mem::take(&mut self.edges)
    }

    /// A reset lets all pins go.
    pub(super) fn reset(&mut self, cycle: u64) {
        for port in 0..PORTS {
            self.write(port, 0xFF, cycle);
        }
    }
}
