//! `info`: the keys of 2016, in three packets because together they do not fit into one.

use rvac_units::{Current, Ratio, Temperature, Voltage};

use super::fields::{Fields, UnknownKeys};
use super::report_robot::read_name;
use super::write::ObjectWriter;
use crate::buffer::{EncodeError, PacketBuffer};
use crate::message::{
    ArmingState, Battery, ChargeEnd, ChargeFault, ChargePhase, ChargeState, ChargerStatus, Info,
    LinkCounters, Name, Refusal,
};
use crate::span;

/// Content of one `info` packet. Packets come in the order battery, link, firmware; older firmware sends all in one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InfoPart {
    /// Versions and rates.
    pub firmware: Option<FirmwareInfo>,
    /// Battery readings.
    pub battery: Option<Battery>,
    /// Link counters of the robot.
    pub link: Option<LinkCounters>,
}

/// Versions and rates.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FirmwareInfo {
    /// `firmware-version`
    pub firmware_version: Name,
    /// `cordlib-version`
    pub cordlib_version: Name,
    /// `main-steps`
    pub main_steps_hz: u32,
    /// `bandwidth-in`
    pub bandwidth_in: u32,
    /// `bandwidth-out`
    pub bandwidth_out: u32,
    /// `arming`
    pub arming: Option<ArmingState>,
}

const CHARGE_STATES: [(ChargeState, &str); 4] = [
    (ChargeState::Discharging, "discharging"),
    (ChargeState::Charging, "charging"),
    (ChargeState::Full, "full"),
    (ChargeState::Fault, "fault"),
];

const FIRMWARE_KEYS: [&str; 7] = [
    "c",
    "firmware-version",
    "cordlib-version",
    "main-steps",
    "bandwidth-in",
    "bandwidth-out",
    "arming",
];

const BATTERY_KEYS: [&str; 9] = [
    "c",
    "battery-status",
    "battery-voltage",
    "battery-current",
    "battery-temperature",
    "battery-state",
    "charge-phase",
    "charge-end",
    "charge-fault",
];

const LINK_KEYS: [&str; 8] = [
    "c",
    "accepted",
    "bad-seals",
    "overruns",
    "framing-errors",
    "malformed",
    "refused",
    "resyncs",
];

pub(super) fn write_firmware(info: &Info, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let mut object = ObjectWriter::new(buffer);
    object
        .name("c", "info")
        .name("firmware-version", &info.firmware_version)
        .name("cordlib-version", &info.cordlib_version)
        .number("main-steps", info.main_steps_hz, span::TOTAL)
        .number("bandwidth-in", info.bandwidth_in, span::TOTAL)
        .number("bandwidth-out", info.bandwidth_out, span::TOTAL);
    if let Some(arming) = info.arming {
        object.name("arming", arming.name());
    }
    object.finish()
}

pub(super) fn write_battery(battery: &Battery, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let state = match battery.state {
        ChargeState::Discharging => "discharging",
        ChargeState::Charging => "charging",
        ChargeState::Full => "full",
        ChargeState::Fault => "fault",
    };
    let mut object = ObjectWriter::new(buffer);
    object
        .name("c", "info")
        .number("battery-status", battery.charge.millionths(), span::RATIO)
        .measured("battery-voltage", battery.voltage.0, span::VOLTAGE)
        .measured("battery-current", battery.current.0, span::CURRENT);
    if let Some(temperature) = battery.temperature {
        object.measured("battery-temperature", temperature.0, span::TEMPERATURE);
    }
    object.name("battery-state", state);
    if let Some(charger) = battery.charger {
        object.name("charge-phase", charger.phase.name());
        if let Some(end) = charger.end {
            object.name("charge-end", end.name());
        }
        if let Some(fault) = charger.fault {
            object.name("charge-fault", fault.name());
        }
    }
    object.finish()
}

pub(super) fn write_link(link: &LinkCounters, buffer: &mut PacketBuffer) -> Result<(), EncodeError> {
    let totals = [
        link.accepted,
        link.bad_crc,
        link.overrun,
        link.framing,
        link.malformed,
        link.refused,
        link.resync,
    ];
    let mut object = ObjectWriter::new(buffer);
    object.name("c", "info");
    for (key, total) in LINK_KEYS.into_iter().skip(1).zip(totals) {
        object.number(key, total, span::TOTAL);
    }
    object.finish()
}

pub(super) fn read(text: &[u8]) -> Result<InfoPart, Refusal> {
    let firmware = Fields::read(text, FIRMWARE_KEYS, UnknownKeys::Ignore)?;
    let battery = Fields::read(text, BATTERY_KEYS, UnknownKeys::Ignore)?;
    let link = Fields::read(text, LINK_KEYS, UnknownKeys::Ignore)?;
    Ok(InfoPart {
        firmware: firmware.has(1).then(|| read_firmware(&firmware)).transpose()?,
        battery: battery.has(1).then(|| read_battery(&battery)).transpose()?,
        link: link.has(1).then(|| read_link(&link)).transpose()?,
    })
}

fn read_firmware(fields: &Fields<'_, 7>) -> Result<FirmwareInfo, Refusal> {
    Ok(FirmwareInfo {
        firmware_version: read_name(fields.text(1)?)?,
        cordlib_version: read_name(fields.text(2)?)?,
        main_steps_hz: fields.total(3)?,
        bandwidth_in: fields.total(4)?,
        bandwidth_out: fields.total(5)?,
        // A name of a newer robot is ignored.
        arming: ArmingState::from_name(fields.text_or_empty(6)?),
    })
}

fn read_battery(fields: &Fields<'_, 9>) -> Result<Battery, Refusal> {
    let state = fields.text_or_empty(5)?;
    let charge = fields.int(1, span::RATIO)?;
    Ok(Battery {
        charge: Ratio::from_millionths(charge).map_err(|_| Refusal::Range)?,
        voltage: Voltage(fields.int(2, span::VOLTAGE)?),
        current: Current(fields.int(3, span::CURRENT)?),
        temperature: read_temperature(fields)?,
        // Firmware of 2016 does not send it.
        state: CHARGE_STATES
            .into_iter()
            .find(|(_, name)| name.as_bytes() == state)
            .map_or(ChargeState::Discharging, |(state, _)| state),
        charger: read_charger(fields)?,
    })
}

fn read_temperature(fields: &Fields<'_, 9>) -> Result<Option<Temperature>, Refusal> {
    if !fields.has(4) {
        return Ok(None);
    }
    let tenths = fields.number(4, span::TEMPERATURE)?;
    i16::try_from(tenths)
        .map(|tenths| Some(Temperature(tenths)))
        .map_err(|_| Refusal::Range)
}

/// Names of a newer robot are ignored, so that the battery's figures can still be read.
fn read_charger(fields: &Fields<'_, 9>) -> Result<Option<ChargerStatus>, Refusal> {
    let phase = ChargePhase::from_name(fields.text_or_empty(6)?);
    let end = ChargeEnd::from_name(fields.text_or_empty(7)?);
    let fault = ChargeFault::from_name(fields.text_or_empty(8)?);
    Ok(phase.map(|phase| ChargerStatus { phase, end, fault }))
}

fn read_link(fields: &Fields<'_, 8>) -> Result<LinkCounters, Refusal> {
    Ok(LinkCounters {
        accepted: fields.total(1)?,
        bad_crc: fields.total(2)?,
        overrun: fields.total(3)?,
        framing: fields.total(4)?,
        malformed: fields.total(5)?,
        refused: fields.total(6)?,
        resync: fields.total(7)?,
    })
}
