//! The whole board on registers that are plain memory: what the parts write to the chip when they are put together, and when
//! they are used. One test, because a program has one chip.

use cordlib::board::{Beeper, ChargeDrive, Charger, CleaningMotor, Lights, WheelDrive, WheelMotors};
use pic32mx3_hal::Peripherals;
use pic32mx3_hal::gpio::Port;
use pic32mx3_hal::interrupt::Source;
use rvac_units::{Frequency, Ratio, Throttle};
use sr8730::board::off::{self, mask};
use sr8730::board::resets::Starts;
use sr8730::board::{service, wiring};
use sr8730::calibration::Calibration;
use sr8730::generated::pins::{self, Signal};

fn is_high(signal: Signal) -> bool {
    off::port(signal).latch() & mask(signal) != 0
}

/// Outputs whose level differs from the safe one as soon as the parts have them: the speaker's channel, and the right wheel's
/// PHASE, which is high for forward. Neither matters while nothing is enabled.
const CHANGED: [Signal; 4] = [
    pins::SOUND_SELECT_A,
    pins::SOUND_SELECT_B,
    pins::SOUND_SELECT_C,
    pins::WHEEL_RIGHT_PHASE,
];

fn changed(port: Port) -> u16 {
    CHANGED
        .iter()
        .filter(|signal| off::port(**signal) == port)
        .map(|signal| mask(*signal))
        .sum()
}

/// Outputs of which the link makes inputs, and its attention line, which is low while there is nothing to say.
fn of_the_link(port: Port) -> (u16, u16) {
    match port {
        Port::F if cfg!(feature = "link-spi") => (mask(pins::GYRO_POWER), 0),
        Port::B if cfg!(not(serial_link)) => (0, mask(pins::LINK_TRANSMIT)),
        _ => (0, 0),
    }
}

#[test]
fn the_board_puts_on_the_pins_what_its_parts_are_told() {
    let chip = Peripherals::take().expect("the first one");
    let calibration = Calibration::from_record(&[0xFF; 4_096]);
    let mut board = wiring::assemble(chip, &calibration, Starts::take());

    for start in pins::START {
        let port = off::port_of(start.port);
        let (inputs, attention) = of_the_link(port);
        let outputs = !(start.tris as u16) & !inputs;
        assert_eq!(port.driven() & outputs, outputs, "{port:?}");
        let safe = start.lat as u16 & outputs & !attention | changed(port);
        assert_eq!(port.latch() & outputs, safe, "{port:?}");
    }
    assert!(
        is_high(pins::WHEEL_LEFT_MODE) && is_high(pins::WHEEL_RIGHT_MODE),
        "the bridges brake"
    );
    assert!(!is_high(pins::BRUSH_MAIN_DECAY));

    // The left wheel, mirrored, drives forward with PHASE low.
    let forward = WheelDrive::Duty(Throttle::FULL);
    board.wheels.drive(forward, forward);
    assert!(!is_high(pins::WHEEL_LEFT_PHASE) && is_high(pins::WHEEL_RIGHT_PHASE));
    board.brush_sides.set(Throttle::FULL);
    board.vacuum.set(Throttle::FULL);
    assert!(is_high(pins::BRUSH_SIDES) && is_high(pins::VACUUM));
    for _ in 0..60 {
        service(&mut board);
    }
    assert!(
        !is_high(pins::BRUSH_SIDES) && !is_high(pins::VACUUM),
        "nobody asked again"
    );

    board.beeper.sound(Frequency(1_000), Ratio::ONE);
    assert!(is_high(pins::SOUND_ENABLE));
    board.all_off();
    assert!(!is_high(pins::SOUND_ENABLE));

    board.lights.set(5, Ratio::ONE);
    let mut lit = 0;
    for _ in 0..100 {
        service(&mut board);
        assert!(!(is_high(pins::LIGHT_SUPPLY_MAIN) && is_high(pins::LIGHT_SUPPLY_BATTERY)));
        lit += u32::from(is_high(pins::LIGHT_SUPPLY_BATTERY) && is_high(pins::LIGHT_LINE_2));
    }
    assert_eq!(lit, 50);

    // Nobody has tried this robot's power stage on a bench.
    board.charger.drive(ChargeDrive::Duty(Ratio::ONE));
    assert!(!Source::Timer3.is_enabled());

    board.vacuum.set(Throttle::FULL);
    off::everything();
    assert!(!is_high(pins::VACUUM));
}
