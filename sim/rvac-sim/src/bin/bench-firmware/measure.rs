//! The measurements, one after the other.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::bail;
use home::{Home, Noise, RobotModel, World};
use robot::{RobotSettings, SimulatedRobot};
use std::sync::Arc;

use crate::desk::{Desk, Shop};
use crate::profile::Profile;
use crate::report::{FirmwareReport, MeasuredLineRate, Vector};

/// What is measured with what.
#[derive(Debug)]
pub(crate) struct MeasurementPlan {
    /// The firmware.
    pub(crate) firmware: PathBuf,
    /// The same with a main loop that does not sleep.
    pub(crate) free_running: PathBuf,
    /// Floor plan.
    pub(crate) home: PathBuf,
    /// Simulated time of the line at full load.
    pub(crate) flood_ms: u64,
}

/// Usual rate of the serial line.
const BAUD: u32 = 230_400;
/// All rates that the line can have.
const RATES: [u32; 6] = [9_600, 19_200, 38_400, 57_600, 115_200, 230_400];
/// Time in which a second of the main loop's own count is whole.
const SETTLE_MS: u64 = 3_000;
/// Time of driving that is measured.
const DRIVE_MS: u64 = 20_000;
/// Time at full load of each rate.
const RATE_MS: u64 = 3_000;
const CYCLES_PER_US: f64 = 80.0;
/// Top of RAM, where the stack begins.
const STACK_TOP: u32 = 0x8000_8000;
/// Vectors of the line's two directions.
const CHANGE_NOTICE: u8 = 26;
const TIMER_4: u8 = 16;

/// Runs everything.
pub(crate) fn measure(plan: &MeasurementPlan) -> anyhow::Result<FirmwareReport> {
    let free_running = Shop::open(&plan.free_running, &plan.home)?;
    let shop = Shop::open(&plan.firmware, &plan.home)?;
    let (idle_hz, driving_hz) = main_loop(&free_running)?;
    let mut report = FirmwareReport {
        main_loop_idle_hz: idle_hz,
        main_loop_driving_hz: driving_hz,
        host_built_real_time: host_built(&plan.home)?,
        ..FirmwareReport::default()
    };
    driving(&shop, &mut report)?;
    for baud in RATES {
        report.uart.push(line(&shop, baud)?);
    }
    flood(&shop, plan.flood_ms, &mut report)?;
    Ok(report)
}

/// Milliseconds of each situation that are sampled once each.
const PROFILE_MS: u64 = 10_000;

/// What happens in a millisecond of a situation.
type Pass = fn(&mut Desk);

/// Prints in which functions the time goes.
pub(crate) fn profile(plan: &MeasurementPlan) -> anyhow::Result<()> {
    let shop = Shop::open(&plan.firmware, &plan.home)?;
    let situations: [(&str, Pass); 3] = [
        ("standing", |desk| desk.pass_ms(1)),
        ("driving", |desk| desk.circle_ms(1)),
        ("full load of the serial line", |desk| desk.flood_ms(1)),
    ];
    for (name, pass) in situations {
        let mut desk = shop.desk(BAUD);
        desk.connect()?;
        let mut profile = Profile::default();
        for _ in 0..PROFILE_MS {
            pass(&mut desk);
            profile.sample(desk.machine(), &shop.image);
        }
        writeln!(io::stdout(), "{name}:\n{}", profile.text())?;
    }
    Ok(())
}

/// How often the main loop could pass in a second: standing without a host, and driving with 50 reports a second.
fn main_loop(shop: &Shop) -> anyhow::Result<(u32, u32)> {
    let mut desk = shop.desk(BAUD);
    desk.connect()?;
    desk.pass_ms(SETTLE_MS);
    let idle = desk.ask_info()?.main_steps_hz;
    desk.circle_ms(SETTLE_MS);
    must_drive(&desk)?;
    let driving = desk.ask_info()?.main_steps_hz;
    Ok((idle, driving))
}

fn must_drive(desk: &Desk) -> anyhow::Result<()> {
    match desk.conduct() {
        (true, 0, 0) => Ok(()),
        (drives, resets, breaches) => bail!(
            "the robot should drive undisturbed, but: driving {drives}, {resets} resets, {breaches} breaches of safety rules"
        ),
    }
}

/// Driving: where the time goes, how late interrupts are, how deep the stack gets, and how fast all this is emulated.
fn driving(shop: &Shop, report: &mut FirmwareReport) -> anyhow::Result<()> {
    let mut desk = shop.desk(BAUD);
    desk.connect()?;
    desk.circle_ms(1_000);
    desk.restart_accounts();
    let begun = Instant::now();
    desk.circle_ms(DRIVE_MS);
    report.emulator_real_time = DRIVE_MS as f64 / 1e3 / begun.elapsed().as_secs_f64();
    must_drive(&desk)?;
    let machine = desk.machine();
    let account = machine.accounting();
    report.idle_share = account.idle_share(desk.cycle());
    report.stack_deepest_bytes = machine.deepest_stack().map_or(0, |deepest| STACK_TOP - deepest);
    report.unknown_accesses = machine.unknown_accesses().len();
    report.misuses = machine.misuses().len();
    let seconds = DRIVE_MS as f64 / 1e3;
    for (number, vector) in account.vectors() {
        report.vectors.push(Vector {
            number,
            per_second: vector.entries as f64 / seconds,
            share: vector.cycles as f64 / account.total_cycles(desk.cycle()) as f64,
            longest_us: vector.longest_cycles as f64 / CYCLES_PER_US,
            latency_us: vector.worst_latency_cycles as f64 / CYCLES_PER_US,
        });
    }
    Ok(())
}

/// One rate of the line at full load in both directions.
fn line(shop: &Shop, baud: u32) -> anyhow::Result<MeasuredLineRate> {
    let mut desk = shop.desk(baud);
    desk.connect()?;
    desk.flood_ms(1_000);
    desk.restart_accounts();
    let (heard, sent) = desk.bytes();
    desk.flood_ms(RATE_MS);
    let (heard_after, sent_after) = desk.bytes();
    let account = desk.machine().accounting();
    let total = account.total_cycles(desk.cycle()) as f64;
    let share = |vector| {
        account
            .vector(vector)
            .map_or(0.0, |vector| vector.cycles as f64 / total)
    };
    let full = f64::from(baud) / 10.0 * RATE_MS as f64 / 1e3;
    Ok(MeasuredLineRate {
        baud,
        receive_load: (sent_after - sent) as f64 / full,
        transmit_load: (heard_after - heard) as f64 / full,
        receive_share: share(CHANGE_NOTICE),
        transmit_share: share(TIMER_4),
        busy_share: 1.0 - account.idle_share(desk.cycle()),
    })
}

/// Full load in both directions for long: nothing may be lost.
fn flood(shop: &Shop, ms: u64, report: &mut FirmwareReport) -> anyhow::Result<()> {
    let mut desk = shop.desk(BAUD);
    desk.connect()?;
    let before = desk.ask_info()?.link;
    desk.restart_accounts();
    desk.flood_ms(ms);
    desk.pass_ms(1_000);
    let after = desk.ask_info()?.link;
    let host = desk.counters();
    let (heard, sent) = desk.bytes();
    report.uart_flood_seconds = ms as f64 / 1e3;
    report.uart_bytes_checked = heard + sent;
    let in_robot =
        after.overrun - before.overrun + after.framing - before.framing + after.bad_crc - before.bad_crc;
    report.uart_bytes_lost = u64::from(in_robot + after.malformed - before.malformed)
        + u64::from(host.bad_crc + host.framing + host.overrun + host.malformed);
    let latencies = desk
        .machine()
        .accounting()
        .vectors()
        .map(|(_, vector)| vector.worst_latency_cycles);
    report.isr_latency_max_us = latencies.max().unwrap_or(0) as f64 / CYCLES_PER_US;
    let (_, resets, breaches) = desk.conduct();
    report.resets = resets;
    report.violations = breaches;
    Ok(())
}

/// The baseline in the same run: the same logic built for this machine, standing in the same home.
fn host_built(home: &Path) -> anyhow::Result<f64> {
    const MS: u32 = 60_000;
    let model = RobotModel::by_name("sr8730")?;
    let home = Arc::new(Home::load(home, &model)?);
    let world = World::new(home, &model, &Noise::ideal(), 1, None);
    let mut robot: SimulatedRobot = SimulatedRobot::new(&model, world, &RobotSettings::default());
    let begun = Instant::now();
    let mut bytes = Vec::new();
    for _ in 0..MS {
        robot.tick(&mut bytes);
        bytes.clear();
    }
    Ok(f64::from(MS) / 1e3 / begun.elapsed().as_secs_f64())
}
