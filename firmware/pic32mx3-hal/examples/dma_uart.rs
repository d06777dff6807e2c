//! What comes in on UART 1 (RF2) goes out again (RF3), 115200 baud, both by DMA: the program looks at its ring each time that what it sent has left. When
//! the line was disturbed or the ring overrun, a `?` goes out.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use pic32mx3_hal::dma::{FirstOf, StaticBuffer};
use pic32mx3_hal::gpio::Level;
use pic32mx3_hal::{Peripherals, entry, reset};

const BAUD: u32 = 115_200;
static RING: StaticBuffer<u8, 256> = StaticBuffer::new([0; 256]);
static ANSWER: StaticBuffer<u8, 64> = StaticBuffer::new([0; 64]);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let (Some(ring), Some(answer)) = (RING.take(), ANSWER.take()) else {
        reset::software_reset()
    };
    let pins = (
        peripherals.pins.rf3.into_output(Level::High),
        peripherals.pins.rf2.into_input(),
    );
    let clocks = board::CONFIGURATION.clocks();
    let Ok((mut transmitter, receiver)) = peripherals.uart1.start(pins, BAUD, clocks.peripheral_hz) else {
        reset::software_reset()
    };
    let channels = peripherals.dma.start();
    let Ok(mut ring) = receiver.receive_into_ring(channels.channel1, ring) else {
        reset::software_reset()
    };
    let mut channel = channels.channel0;
    let mut answer = answer;
    loop {
        let count = ring.read(answer).unwrap_or_else(|_| {
            answer.fill(b'?');
            1
        });
        if count == 0 {
            continue;
        }
        let Ok(sending) = transmitter.send_by_dma(channel, FirstOf::new(answer, count)) else {
            reset::software_reset()
        };
        let sent = sending.wait();
        (channel, transmitter) = (sent.channel, sent.driver);
        answer = sent.buffer.into_inner();
    }
}
entry!(main);
