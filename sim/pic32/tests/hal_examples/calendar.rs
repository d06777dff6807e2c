//! The example of the calendar, with a crystal and without.

use crate::{MS, assert_clean, image, run, text};
use pic32::machine::{Machine, Uart};

#[test]
fn a_leap_day_begins_while_the_chip_sleeps() {
    let Some(image) = image("calendar") else { return };
    let mut machine = Machine::new(&image);
    machine.fit_watch_crystal();
    run(&mut machine, 5_500 * MS);
    let said = text(&mut machine, Uart::One);
    let expected = "2028-02-28 1 23:59:58\n2028-02-28 1 23:59:59\n2028-02-29 2 00:00:00\n\
                    2028-02-29 2 00:00:01\n2028-02-29 2 00:00:02\n";
    assert_eq!(said, expected);
    assert_clean(&machine);
}

#[test]
fn without_a_crystal_it_says_so() {
    let Some(image) = image("calendar") else { return };
    let mut machine = Machine::new(&image);
    run(&mut machine, 2_000 * MS);
    assert_eq!(text(&mut machine, Uart::One), "no calendar: Err(NoClock)\n");
}
