//! Battery, charger and dock.

use home::{SensorFault, SensorId};
use pic32::board::Contact;
use rvac_protocol::message::Inhibit;

use super::{fault, hold};
use crate::limits;
use crate::scene::OperatingState::{Charging, Cleaning, HotStanding, Standing, WarmCleaning};
use crate::scene::show_temperature;
use crate::testbed::Testbed;
use crate::trial::Expectation::{DrivesOff, OffSaying, Says};
use crate::trial::{MotorGroup, Trial};

/// Pack voltages: 0.95, 0.85 and 1.05 V a cell.
const PACK_WEAK_MV: i32 = 11_400;
const PACK_EMPTY_MV: i32 = 10_200;
const PACK_LOW_MV: i32 = 12_600;
/// Counts of a thermistor that is not plugged in, and of one that is shorted (sr8730.md section 7).
const OPEN: u16 = 1_000;
const SHORTED: u16 = 20;
/// Just below the two limits, tenths of a degree, where the warmest that a measured thermistor may mean lies above them. The
/// way there from the pack of the scene is no jump of a broken thermistor.
const HOT_DC: i32 = 545;
const OVERHEATED_DC: i32 = 598;

/// The pack is as warm from the next millisecond on.
fn heat_to(testbed: &mut Testbed, temperature_dc: i32) -> u64 {
    show_temperature(testbed, temperature_dc);
    testbed.robot().cycle()
}

/// The pack has this voltage from the next millisecond on.
fn show_voltage(testbed: &mut Testbed, pack_mv: i32) -> u64 {
    fault(testbed, SensorId::BatteryVoltage, SensorFault::StuckAt(pack_mv))
}

fn read_thermistor(testbed: &mut Testbed, counts: u16, cycle: u64) -> u64 {
    let channel = testbed.robot().wiring().thermistor;
    let robot = testbed.robot_mut();
    robot.hold_analog(channel, counts, (cycle, u64::MAX));
    cycle
}

fn short_the_switch(testbed: &mut Testbed) -> u64 {
    testbed.robot_mut().short_charging_switch();
    testbed.robot().cycle()
}

pub(super) fn trials() -> Vec<Trial> {
    [voltage(), heat(), dock()].concat()
}

fn voltage() -> Vec<Trial> {
    vec![
        Trial::new(
            "pack-empty",
            "pack below 0.9 V a cell: all motors",
            Cleaning,
            |testbed, _| show_voltage(testbed, PACK_EMPTY_MV),
        )
        .expects(
            OffSaying(MotorGroup::All, Inhibit::BatteryEmpty),
            limits::S16_EMPTY,
        ),
        Trial::new(
            "pack-weak",
            "pack below 1.0 V a cell: brushes and suction",
            Cleaning,
            |testbed, _| show_voltage(testbed, PACK_WEAK_MV),
        )
        .expects(
            OffSaying(MotorGroup::Cleaners, Inhibit::BatteryWeak),
            limits::S16_WEAK,
        ),
        Trial::new(
            "pack-low",
            "pack below 1.1 V a cell; reported",
            Standing,
            |testbed, _| show_voltage(testbed, PACK_LOW_MV),
        )
        .expects(Says(Inhibit::BatteryLow), limits::S16_LOW),
    ]
}

fn heat() -> Vec<Trial> {
    let unknown = OffSaying(MotorGroup::All, Inhibit::Thermistor);
    vec![
        Trial::new(
            "pack-hot",
            "pack that may be above 55 °C: all motors",
            WarmCleaning,
            |testbed, _| heat_to(testbed, HOT_DC),
        )
        .expects(OffSaying(MotorGroup::All, Inhibit::BatteryHot), limits::S17_HOT),
        Trial::new(
            "pack-overheated",
            "pack that may be above 60 °C; reported",
            HotStanding,
            |testbed, _| heat_to(testbed, OVERHEATED_DC),
        )
        .expects(Says(Inhibit::BatteryOverheated), limits::S17_HOT),
        Trial::new(
            "thermistor-open",
            "thermistor unplugged: all motors",
            Cleaning,
            |testbed, cycle| read_thermistor(testbed, OPEN, cycle),
        )
        .expects(unknown, limits::S17_UNMEASURED),
        Trial::new(
            "thermistor-shorted",
            "thermistor shorted: all motors",
            Cleaning,
            |testbed, cycle| read_thermistor(testbed, SHORTED, cycle),
        )
        .expects(unknown, limits::S17_UNMEASURED),
    ]
}

fn dock() -> Vec<Trial> {
    vec![
        Trial::new(
            "switch-shorted",
            "the charging switch is shorted, the host does nothing: backs off",
            Charging,
            |testbed, _| short_the_switch(testbed),
        )
        .expects(DrivesOff, limits::S18_ESCAPE),
        Trial::new(
            "switch-shorted-armed",
            "the charging switch is shorted, the host has armed it to leave: backs off",
            Charging,
            |testbed, _| {
                testbed.arm_to_leave();
                testbed.run(100);
                short_the_switch(testbed)
            },
        )
        .expects(DrivesOff, limits::S18_ESCAPE),
        Trial::new(
            "switch-shorted-host-dead",
            "the charging switch is shorted, the host is dead: backs off",
            Charging,
            |testbed, _| {
                testbed.set_speaking(false);
                short_the_switch(testbed)
            },
        )
        .expects(DrivesOff, limits::S18_ESCAPE),
        Trial::new(
            "contacts-close",
            "the dock's contacts close",
            Cleaning,
            |testbed, cycle| hold(testbed, Contact::Adapter, cycle),
        )
        .expects(OffSaying(MotorGroup::All, Inhibit::Docked), limits::S19_STOP),
        Trial::new(
            "leaving-runs-out",
            "a host arms the robot to leave its dock and does nothing; locked, reported",
            Charging,
            |testbed, _| {
                let from = testbed.robot().cycle();
                testbed.arm_to_leave();
                testbed.run(200);
                from
            },
        )
        .expects(Says(Inhibit::NotArmed), limits::S19_LEAVING),
    ]
}
