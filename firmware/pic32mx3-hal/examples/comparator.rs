//! Comparator 1 watches RB4 (C1IN-) against a reference of 1.65 V (of 3.3 V): each time the pin falls below it or rises above it, the
//! lamp on RG7 follows, high for above. Comparator 2 holds RB3 against the internal 1.2 V; the lamp
//! on RG8 shows that once a millisecond.
#![cfg_attr(target_arch = "mips", no_std, no_main)]

mod board;

use embedded_hal::delay::DelayNs;
use pic32mx3_hal::comparator::{Comparator, Comparing, Event, Internal, Range, Reference, Sense};
use pic32mx3_hal::core_timer::Delay;
use pic32mx3_hal::gpio::{Analog, Level, Output, Pin};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, SubPriority, Vector, vector};
use pic32mx3_hal::{Peripherals, entry, interrupt, reset};

const SETTLE_US: u32 = 10;
/// 8/32 and 8/32 of the supply.
const HALF: (Range, u8) = (Range::High, 8);

struct Watch {
    comparing: Comparing<1, (Reference, Pin<'B', 4, Analog>)>,
    lamp: Pin<'G', 7, Output>,
}

impl Watch {
    fn follow(&mut self) {
        self.lamp.set_level(if self.comparing.is_high() {
            Level::High
        } else {
            Level::Low
        });
    }
}

static WATCH: HandlerCell<vector::COMPARATOR_1, Watch> = HandlerCell::empty();

fn on_crossing(context: &mut Context<vector::COMPARATOR_1>) {
    Comparator::<1>::SOURCE.clear();
    if let Some(watch) = WATCH.get(context) {
        watch.follow();
    }
}
interrupt!(COMPARATOR_1, on_crossing);

fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let pins = peripherals.pins;
    let mut reference = peripherals.voltage_reference;
    reference.set(HALF.0, HALF.1);
    let inputs = (Reference, pins.rb4.into_analog());
    // The pin is the second input: inverted, the output is high while the pin is above.
    let comparing = peripherals
        .comparator1
        .start(inputs, Sense::Inverted, Event::Both);
    let inputs = (pins.rb3.into_analog(), Internal);
    let second = peripherals.comparator2.start(inputs, Sense::Plain, Event::None);
    let mut delay = Delay::new(board::CONFIGURATION.clocks());
    delay.delay_us(SETTLE_US);
    Comparator::<1>::SOURCE.clear();
    let mut watch = Watch {
        comparing,
        lamp: pins.rg7.into_output(Level::Low),
    };
    watch.follow();
    if WATCH.hand_over(watch).is_err()
        || interrupt::set_priority(Vector::Comparator1, Priority::Level3, SubPriority::Sub0).is_err()
    {
        reset::software_reset();
    }
    Comparator::<1>::SOURCE.enable();
    interrupt::start();
    let mut lamp = pins.rg8.into_output(Level::Low);
    loop {
        lamp.set_level(if second.is_high() { Level::High } else { Level::Low });
        delay.delay_ms(1);
    }
}
entry!(main);
