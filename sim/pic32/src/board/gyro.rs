//! The gyro module: frame 1 of `robots/samsung-sr8730/gyro.md`, a placeholder, on the UART that the calibration names.

use home::GyroReading;

use super::CYCLES_PER_MS;
use super::calibration::Particulars;
use super::serial::{Rate, Sender};
use super::wiring::{Line, Wiring};
use crate::machine::Machine;
use crate::pins::{Level, Pin};

/// Milliseconds from power to the first frame, and from one frame to the next.
const FIRST_MS: u64 = 100;
const PERIOD_MS: u64 = 10;
const SYNC: [u8; 2] = [0xAA, 0x55];

/// The module.
#[derive(Clone, Debug)]
pub(super) struct GyroModule {
    power: Line,
    receive: Pin,
    sender: Sender,
    powered_ms: Option<u64>,
    heading_then: i32,
    edges: Vec<(u64, Level)>,
}

impl GyroModule {
    pub(super) fn new(wiring: &Wiring, particulars: &Particulars, seed: u64) -> Self {
        let uart = usize::from(particulars.gyro_uart.clamp(1, 2)) - 1;
        Self {
            power: wiring.gyro_power,
            receive: wiring.uart_receive[uart],
            sender: Sender::new(Rate::exact(particulars.gyro_baud), seed),
            powered_ms: None,
            heading_then: 0,
            edges: Vec::new(),
        }
    }

    /// The millisecond that begins at `from`.
    pub(super) fn pass_ms(&mut self, from: u64, reading: Option<GyroReading>, machine: &mut Machine) {
        let now_ms = from / CYCLES_PER_MS;
        let powered = self.power.is_on(machine.output(self.power.pin));
        let Some(reading) = reading.filter(|_| powered) else {
            self.powered_ms = None;
            self.sender.flush();
            return;
        };
        let since_ms = *self.powered_ms.get_or_insert_with(|| {
            self.heading_then = reading.heading.0;
            now_ms
        });
        let on_ms = now_ms - since_ms;
        if on_ms >= FIRST_MS && (on_ms - FIRST_MS).is_multiple_of(PERIOD_MS) {
            self.sender.send(&self.frame(reading));
        }
        self.edges.clear();
        self.sender.pass_ms(from, &mut self.edges);
        for (cycle, level) in &self.edges {
            machine.schedule_input(*cycle, self.receive, *level);
        }
    }

    fn frame(&self, reading: GyroReading) -> Vec<u8> {
        // Microradians to hundredths and tenths of a degree.
        let turned_urad = f64::from(reading.heading.0.wrapping_sub(self.heading_then));
        let heading = (turned_urad * 1e-6).to_degrees() * 100.0;
        let rate = (f64::from(reading.rate.0) * 1e-6).to_degrees() * 10.0;
        let mut body = (heading.round() as i32).to_le_bytes().to_vec();
        body.extend((rate.round() as i16).to_le_bytes());
        let sum = body.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        [&SYNC[..], &body, &[sum]].concat()
    }
}
