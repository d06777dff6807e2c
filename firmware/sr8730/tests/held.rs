//! After everything was switched off, charger and motors stay off until the next reset, whatever they are told. A program of
//! its own, because a program has one chip.

use cordlib::board::{ChargeDrive, Charger, CleaningMotor};
use pic32mx3_hal::Peripherals;
use pic32mx3_hal::interrupt::Source;
use rvac_protocol::crc::crc32c;
use rvac_units::{Ratio, Throttle};
use sr8730::board::off::{self, mask};
use sr8730::board::resets::Starts;
use sr8730::board::{service, wiring};
use sr8730::calibration::Calibration;
use sr8730::generated::calibration::{COUNT, ENTRIES};
use sr8730::generated::pins::{self, Signal};
use sr8730::logic::calibration_record::{MAGIC, VERSION};

/// A robot of which all is measured, so that it may charge.
fn measured() -> Calibration {
    let count = u16::try_from(COUNT).expect("few values");
    let mut record: Vec<u8> = [
        &MAGIC.to_le_bytes()[..],
        &VERSION.to_le_bytes(),
        &count.to_le_bytes(),
    ]
    .concat();
    record.extend(ENTRIES.iter().flat_map(|entry| entry.high.to_le_bytes()));
    record.extend((!crc32c(u32::MAX, &record)).to_le_bytes());
    Calibration::from_record(&record)
}

fn is_high(signal: Signal) -> bool {
    off::port(signal).latch() & mask(signal) != 0
}

#[test]
fn what_was_switched_off_with_everything_does_not_come_on_again() {
    let chip = Peripherals::take().expect("the first one");
    let mut board = wiring::assemble(chip, &measured(), Starts::take());
    assert!(board.charger.may_charge());
    let half = ChargeDrive::Duty(Ratio::from_millionths(500_000).expect("a ratio"));
    board.charger.drive(half);
    assert!(Source::Timer3.is_enabled(), "the gate's interrupt runs");

    board.vacuum.set(Throttle::FULL);
    assert!(is_high(pins::VACUUM));

    off::everything();
    for _ in 0..20 {
        board.charger.drive(half);
        assert!(!Source::Timer3.is_enabled());
        board.vacuum.set(Throttle::FULL);
        board.brush_sides.set(Throttle::FULL);
        assert!(!is_high(pins::VACUUM) && !is_high(pins::BRUSH_SIDES));
        service(&mut board);
    }
}
