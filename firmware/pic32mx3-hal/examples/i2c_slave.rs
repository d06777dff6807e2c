//! A slave on I2C 2 (SDA RA3, SCL RA2) that is a memory of 16 bytes at address 0x50: the first byte that a master writes is
//! the place, those after it go there and on; reading goes on from the place. The handler does all of it.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use core::sync::atomic::AtomicU32;
use pic32mx3_hal::gpio::{Input, Pin};
use pic32mx3_hal::i2c::{Address, Answers, I2c, I2cSlave, SlaveEvent};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, cpu, entry, interrupt, reset};

const ADDRESS: Address = Address::Seven(0x50);
const SIZE: u8 = 16;

struct Memory {
    slave: I2cSlave<2, Pin<'A', 3, Input>, Pin<'A', 2, Input>>,
    bytes: [u8; SIZE as usize],
    place: u8,
    expects_place: bool,
}

impl Memory {
    fn here(&mut self) -> Option<&mut u8> {
        let place = usize::from(self.place);
        self.place = (self.place + 1) % SIZE;
        self.bytes.get_mut(place)
    }
}

static MEMORY: HandlerCell<vector::I2C_2, Memory> = HandlerCell::empty();
static NEVER: AtomicU32 = AtomicU32::new(0);

fn on_byte(context: &mut Context<vector::I2C_2>) {
    let Some(memory) = MEMORY.get(context) else { return };
    match memory.slave.take_event() {
        Some(SlaveEvent::Begins) => memory.expects_place = true,
        Some(SlaveEvent::Received(place)) if memory.expects_place => {
            memory.expects_place = false;
            memory.place = place % SIZE;
        }
        Some(SlaveEvent::Received(byte)) => {
            if let Some(here) = memory.here() {
                *here = byte;
            }
        }
        Some(SlaveEvent::Wanted { .. }) => {
            let byte = memory.here().map_or(0, |here| *here);
            memory.slave.answer(byte);
        }
        Some(SlaveEvent::Called | SlaveEvent::Lost) | None => {}
    }
}
interrupt!(I2C_2, on_byte);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let lines = (
        peripherals.pins.ra3.into_input(),
        peripherals.pins.ra2.into_input(),
    );
    let Ok(slave) = peripherals.i2c2.into_slave(lines, ADDRESS, Answers::default()) else {
        reset::software_reset()
    };
    let memory = Memory {
        slave,
        bytes: [0; SIZE as usize],
        place: 0,
        expects_place: false,
    };
    if MEMORY.hand_over(memory).is_err()
        || interrupt::set_priority(Vector::I2c2, Priority::Level3, SubPriority::Sub0).is_err()
    {
        reset::software_reset();
    }
    I2c::<2>::SLAVE.enable();
    interrupt::start();
    loop {
        cpu::sleep_while_zero(&NEVER);
    }
}
entry!(main);
