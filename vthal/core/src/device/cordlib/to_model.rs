//! From the words of the wire to those of the device model: the only place where a struct exists twice.

use brain::observation::{Cliffs, Contacts, MotorCurrents};
use brain::{Inhibit, Inhibits};
use rvac_protocol::message::{
    self, Capabilities, ChargePhase, Info, MotionPhase, ProtocolVersion, RobotHello, State,
};
use rvac_protocol::quality;

use super::super::{
    Arrivals, Battery, ChargeState, Charger, CleanersRunning, DeadManKind, Description, DriveLimits,
    Identity, Level, LinkQuality, Odometry, Part, ReflexSite, Reflexes, Report, SensorCounts, Shape,
    SlowFacts, StopSite, WheelDrops, WheelTravel,
};

/// A share of fewer packets says little: those of a second in which the robot drives.
const COUNTED_MIN: u32 = 20;

/// What the robot is and can do.
pub(super) fn description(hello: Option<&RobotHello>, table: &message::Description) -> Description {
    let has = table.capabilities;
    let limits = table.limits;
    Description {
        identity: identity(hello),
        // Without calibrated encoders the firmware refuses every command with a speed.
        levels: if has.encoders { &[Level::Motion] } else { &[] },
        shape: Shape::Circle {
            radius_m: limits.radius.as_m(),
        },
        swath_m: limits.swath.as_m(),
        drive: DriveLimits {
            track_m: limits.track.as_m(),
            speed_max_m_per_s: limits.speed_max.as_m_per_s(),
            turn_max_rad_per_s: limits.turn_max.as_rad_per_s(),
            dead_man: DeadManKind::PerCommand,
        },
        odometry: Odometry {
            resolution_m: f64::from(limits.count_nm) * 1e-9,
            sign_reliable: true,
        },
        reflexes: Reflexes {
            bump: reflex(has.bumpers),
            cliff: reflex(has.cliffs),
            lift: reflex(has.wheel_drops),
        },
        stop: StopSite::Device,
        sensors: SensorCounts {
            bumpers: has.bumpers,
            cliffs: has.cliffs,
            wheel_drops: has.wheel_drops,
            proximity: has.proximity,
            dock_receivers: has.dock_receivers,
            buttons: has.buttons,
            leds: has.leds,
        },
        parts: parts(has),
        unguarded: names(table.motors.unguarded),
        unmeasured: names(table.motors.unmeasured),
    }
}

fn names(motors: message::MotorSet) -> Vec<&'static str> {
    let named = motors.named().into_iter();
    named
        .filter_map(|(name, is_listed)| is_listed.then_some(name))
        .collect()
}

fn identity(hello: Option<&RobotHello>) -> Identity {
    let Some(hello) = hello else {
        return Identity::default();
    };
    let newest = ProtocolVersion::CURRENT.min(hello.version_max);
    Identity {
        device: hello.device.as_str().to_owned(),
        firmware: hello.firmware.as_str().to_owned(),
        protocol: newest.0,
    }
}

fn reflex(sensors: u8) -> ReflexSite {
    if sensors == 0 {
        ReflexSite::Absent
    } else {
        ReflexSite::Device
    }
}

fn parts(has: Capabilities) -> Vec<Part> {
    [
        (Part::Gyro, has.gyro),
        (Part::BrushMain, has.brush_main),
        (Part::BrushSides, has.brush_sides),
        (Part::Vacuum, has.vacuum),
        (Part::Beeper, has.beeper),
        (Part::Battery, has.battery),
        (Part::Currents, has.currents),
        (Part::Charger, has.charger),
    ]
    .into_iter()
    .filter_map(|(part, present)| present.then_some(part))
    .collect()
}

/// Telemetry of a robot with these parts, whose wheels have come so far.
pub(super) fn report(
    state: &State,
    has: Capabilities,
    unmeasured: message::MotorSet,
    travel: WheelTravel,
) -> Report {
    Report {
        uptime_ms: Some(state.tick.0),
        travel,
        heading_urad: state.gyro.filter(|_| has.gyro).map(|gyro| gyro.heading.0),
        is_driven: state.motion != MotionPhase::Idle,
        contacts: Contacts {
            left: state.bumpers.left,
            right: state.bumpers.right,
        },
        cliffs: Cliffs {
            left: state.cliffs.left,
            middle: state.cliffs.middle,
            right: state.cliffs.right,
        },
        wheel_drops: WheelDrops {
            left: state.wheel_drops.left,
            right: state.wheel_drops.right,
        },
        proximity: state.proximity.map(|raw| f32::from(raw) / 255.0),
        dock_beams: state.dock,
        docked: state.docked,
        dust_box: state.dust_box,
        cleaners: CleanersRunning {
            brush_main: state.cleaners & 1 != 0,
            brush_sides: state.cleaners & 2 != 0,
            vacuum: state.cleaners & 4 != 0,
        },
        buttons: state.buttons,
        currents: state
            .currents
            .filter(|_| has.currents)
            .map(|all| currents(all, unmeasured)),
        inhibits: inhibits(state.inhibits),
    }
}

fn currents(all: message::Currents, unmeasured: message::MotorSet) -> MotorCurrents {
    let brush_main_a = all.brush_main.as_a() as f32;
    MotorCurrents {
        wheel_left_a: all.wheel_left.as_a() as f32,
        wheel_right_a: all.wheel_right.as_a() as f32,
        brush_main_a: (!unmeasured.brush_main).then_some(brush_main_a),
    }
}

/// Bits of newer firmware are kept as one unknown inhibit.
fn inhibits(wire: message::Inhibits) -> Inhibits {
    let mut all: Inhibits = wire.iter().map(inhibit).collect();
    let known = message::Inhibit::ALL
        .into_iter()
        .fold(message::Inhibits::NONE, |mut all, inhibit| {
            all.insert(inhibit);
            all
        });
    if !wire.without(known).is_empty() {
        all.insert_unknown();
    }
    all
}

const fn inhibit(wire: message::Inhibit) -> Inhibit {
    match wire {
        message::Inhibit::NotArmed => Inhibit::NotArmed,
        message::Inhibit::ResetLoop => Inhibit::ResetLoop,
        message::Inhibit::LinkLost => Inhibit::LinkLost,
        message::Inhibit::Bumper => Inhibit::Bumper,
        message::Inhibit::BumperStuck => Inhibit::BumperStuck,
        message::Inhibit::Cliff => Inhibit::Cliff,
        message::Inhibit::CliffTrapped => Inhibit::CliffTrapped,
        message::Inhibit::CliffSensorFault => Inhibit::CliffSensorFault,
        message::Inhibit::WheelDrop => Inhibit::WheelDrop,
        message::Inhibit::WheelStall => Inhibit::WheelStall,
        message::Inhibit::BrushStall => Inhibit::BrushStall,
        message::Inhibit::Runaway => Inhibit::Runaway,
        message::Inhibit::EncoderFault => Inhibit::EncoderFault,
        message::Inhibit::NotMoving => Inhibit::NotMoving,
        message::Inhibit::Docked => Inhibit::Docked,
        message::Inhibit::ButtonStop => Inhibit::ButtonStop,
        message::Inhibit::Stopped => Inhibit::Stopped,
        message::Inhibit::InternalFault => Inhibit::InternalFault,
        message::Inhibit::BatteryLow => Inhibit::BatteryLow,
        message::Inhibit::BatteryWeak => Inhibit::BatteryWeak,
        message::Inhibit::BatteryEmpty => Inhibit::BatteryEmpty,
        message::Inhibit::BatteryHot => Inhibit::BatteryHot,
        message::Inhibit::BatteryOverheated => Inhibit::BatteryOverheated,
        message::Inhibit::Thermistor => Inhibit::Thermistor,
        message::Inhibit::ChargerFault => Inhibit::ChargerFault,
        message::Inhibit::ChargerShorted => Inhibit::ChargerShorted,
        message::Inhibit::Clock => Inhibit::Clock,
        message::Inhibit::Memory => Inhibit::Memory,
    }
}

/// The inhibit of the wire, for the commands that name one.
pub(super) fn inhibit_of_wire(wanted: Inhibit) -> Option<message::Inhibit> {
    message::Inhibit::ALL
        .into_iter()
        .find(|wire| inhibit(*wire) == wanted)
}

/// What changes slowly.
pub(super) fn slow_facts(info: &Info) -> SlowFacts {
    SlowFacts {
        library: Some(info.cordlib_version.as_str().to_owned()),
        main_loop_hz: Some(info.main_steps_hz),
        battery: info.battery.as_ref().map(battery),
    }
}

fn battery(battery: &message::Battery) -> Battery {
    Battery {
        charge: battery.charge.as_f64(),
        voltage_v: battery.voltage.as_v(),
        current_a: battery.current.as_a(),
        temperature_c: battery.temperature.map(rvac_units::Temperature::as_celsius),
        state: match battery.state {
            message::ChargeState::Discharging => ChargeState::Discharging,
            message::ChargeState::Charging => ChargeState::Charging,
            message::ChargeState::Full => ChargeState::Full,
            message::ChargeState::Fault => ChargeState::Fault,
        },
        charger: battery.charger.map(|status| Charger {
            phase: status.phase.name(),
            end: status.end.map(message::ChargeEnd::name),
            fault: status.fault.map(message::ChargeFault::name),
            has_failed: status.phase == ChargePhase::Fault,
        }),
    }
}

/// How good the link is.
pub(super) fn link_quality(wire: quality::LinkQuality, arrivals: quality::Arrivals) -> LinkQuality {
    let sent = wire.outbound;
    LinkQuality {
        arrivals: Arrivals {
            reports: arrivals.states,
            garbled: arrivals.garbled,
            corrupted: arrivals.corrupted,
            repeated: arrivals.repeated,
            stray: arrivals.stray,
            clock_jumps: arrivals.clock_jumps,
        },
        bad_share: wire.both().bad_share(),
        lost_share: if sent.all() >= COUNTED_MIN {
            sent.bad_share()
        } else {
            0.0
        },
        round_trip_ms: wire.round_trip_ms.map(f64::from),
        is_binary: false,
    }
}

/// Level of a line of the firmware's log.
pub(super) const fn log_level(level: message::LogLevel) -> rvac_api::LogLevel {
    match level {
        message::LogLevel::Debug => rvac_api::LogLevel::Debug,
        message::LogLevel::Info => rvac_api::LogLevel::Info,
        message::LogLevel::Warn => rvac_api::LogLevel::Warn,
        message::LogLevel::Error => rvac_api::LogLevel::Error,
    }
}

#[cfg(test)]
mod tests {
    use brain::LinkFault;
    use rvac_protocol::message;

    use super::{Inhibit, inhibit, inhibit_of_wire, inhibits};

    #[test]
    fn inhibits_have_the_same_names_on_the_wire() {
        let of_host = |inhibit: &Inhibit| {
            *inhibit == Inhibit::NotCalibrated || LinkFault::from_name(inhibit.name()).is_some()
        };
        let here: Vec<_> = Inhibit::all()
            .filter(|inhibit| !of_host(inhibit))
            .map(|inhibit| (inhibit.name(), inhibit.is_latched()))
            .collect();
        let wire = message::Inhibit::ALL.map(|inhibit| (inhibit.name(), inhibit.is_latched()));
        assert_eq!(here, wire);
        for wire in message::Inhibit::ALL {
            assert_eq!(inhibit(wire).name(), wire.name());
            assert_eq!(inhibit_of_wire(inhibit(wire)), Some(wire));
        }
    }

    #[test]
    fn inhibits_of_newer_firmware_are_not_lost() {
        let mut wire = message::Inhibits::from_bits(1 << 31);
        wire.insert(message::Inhibit::WheelDrop);
        assert!(inhibits(wire).names().eq(["wheel-drop", "unknown-inhibit"]));
        assert!(inhibits(message::Inhibits::NONE).is_empty());
    }
}
