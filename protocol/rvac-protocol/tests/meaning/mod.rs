//! Meanings as language-neutral JSON, for comparing with the golden vectors. The matches have no wildcard: a new variant
//! does not compile until it has a meaning here, and then a test wants a vector of it.

use rvac_protocol::message::{
    Acknowledgement, Battery, Capabilities, ChargeEnd, ChargeFault, ChargeState, Command, DescribeRow, Event,
    Info, LinkCounters, LogLevel, MotionPhase, MotorSet, MoveEnd, ProbeTarget, ProbedContent, Report,
    RowContent, State,
};
use serde_json::{Value, json};

pub(crate) fn command(command: &Command) -> Value {
    match command {
        Command::Hello(hello) => json!({
            "command": "hello", "min": hello.version_min.0, "max": hello.version_max.0,
            "binary_state": hello.binary.state, "binary_drive": hello.binary.drive,
        }),
        Command::Hand => json!({"command": "hand"}),
        Command::Describe { row } => json!({"command": "describe", "row": row}),
        Command::Info => json!({"command": "info"}),
        Command::State => json!({"command": "state"}),
        Command::Drive(drive) => json!({
            "command": "drive", "speed_um_per_s": drive.speed.0, "turn_urad_per_s": drive.turn.0,
            "lease_ms": drive.lease_ms, "number": drive.sequence.0, "seen_tick_ms": drive.seen_tick.0,
        }),
        Command::Motor(motor) => json!({
            "command": "motor", "motor": motor.motor.name(), "throttle_millionths": motor.throttle.millionths(),
            "lease_ms": motor.lease_ms, "number": motor.sequence.0, "seen_tick_ms": motor.seen_tick.0,
        }),
        Command::Move(movement) => json!({
            "command": "move", "length_um": movement.length.0, "radius_um": movement.radius.map(|radius| radius.0),
            "number": movement.sequence.0, "seen_tick_ms": movement.seen_tick.0,
        }),
        Command::Stop => json!({"command": "stop"}),
        Command::Beep(beep) => json!({
            "command": "beep", "pitch_hz": beep.pitch.0, "duration_ms": beep.duration_ms,
            "volume_millionths": beep.volume.millionths(),
        }),
        Command::Led(led) => json!({
            "command": "led", "led": led.led, "pattern": led.pattern.name(),
            "brightness_millionths": led.brightness.millionths(),
        }),
        Command::Arm { sequence, undock } => {
            json!({"command": "arm", "number": sequence.0, "undock": undock})
        }
        Command::Clear { sequence, inhibit } => {
            json!({"command": "clear", "number": sequence.0, "inhibit": inhibit.name()})
        }
        Command::Set {
            sequence,
            parameter,
            value,
        } => json!({"command": "set", "number": sequence.0, "parameter": parameter.name(), "value": value}),
        Command::Ping { sequence } => json!({"command": "ping", "number": sequence.0}),
        Command::Seen { event } => json!({"command": "seen", "edge": event}),
        Command::Charge { sequence, wanted } => {
            json!({"command": "charge", "number": sequence.0, "wanted": wanted})
        }
        Command::Probe(probe) => {
            let mut meaning = target(probe.target);
            meaning["command"] = json!("probe");
            meaning["number"] = json!(probe.sequence.0);
            meaning["lease_ms"] = json!(probe.lease_ms);
            meaning
        }
    }
}

fn target(target: ProbeTarget) -> Value {
    match target {
        ProbeTarget::Analog => json!({"of": "analog"}),
        ProbeTarget::Encoders => json!({"of": "encoders"}),
        ProbeTarget::Lines => json!({"of": "lines"}),
        ProbeTarget::Buttons => json!({"of": "buttons"}),
        ProbeTarget::Serial { port, baud } => json!({"of": "serial", "port": port, "baud": baud}),
    }
}

pub(crate) fn report(report: &Report) -> Value {
    match report {
        Report::Hello(hello) => json!({
            "report": "hello", "min": hello.version_min.0, "max": hello.version_max.0, "device": hello.device.as_str(),
            "firmware": hello.firmware.as_str(), "session": hello.session, "packet_bytes_max": hello.packet_max,
            "boots": hello.boot_count, "reset": hello.reset_cause.name(), "binary_state": hello.binary.state,
            "binary_drive": hello.binary.drive, "tick_ms": hello.tick.0,
        }),
        Report::Describe(row) => describe(row),
        Report::Info(info) => firmware(info),
        Report::State(state) => telemetry(state),
        Report::Event(event) => {
            json!({"report": "edge", "number": event.number, "tick_ms": event.tick.0, "edge": event_kind(&event.kind)})
        }
        Report::Acknowledgement(Acknowledgement { sequence, refusal }) => json!({
            "report": "answer", "number": sequence.map(|sequence| sequence.0), "refusal": refusal.map(|refusal| refusal.name()),
        }),
        Report::Probed(probed) => {
            json!({"report": "probed", "tick_ms": probed.tick.0, "content": probed_content(&probed.content)})
        }
        Report::Log { level, text } => {
            json!({"report": "log", "level": log_level(*level), "text": text.as_str()})
        }
    }
}

fn probed_content(content: &ProbedContent) -> Value {
    match content {
        ProbedContent::Analog(counts) => json!({"analog": counts}),
        ProbedContent::Encoders(encoders) => {
            let mut told = json!({
                "left": encoders.left, "right": encoders.right, "left_illegal": encoders.left_illegal,
                "right_illegal": encoders.right_illegal,
            });
            if let Some(pulses) = encoders.brush {
                told["brush"] = json!(pulses);
            }
            told
        }
        ProbedContent::Lines(ports) => json!({"ports": ports}),
        ProbedContent::Buttons(buttons) => json!({"level": buttons.level, "pressed": buttons.pressed}),
        ProbedContent::Serial(serial) => {
            json!({"at": serial.at, "lost": serial.lost, "bytes": serial.bytes.as_slice()})
        }
    }
}

fn describe(row: &DescribeRow) -> Value {
    let content = match &row.content {
        RowContent::Limits(limits) => json!({
            "of": "limits", "speed_max_um_per_s": limits.speed_max.0, "turn_max_urad_per_s": limits.turn_max.0,
            "track_um": limits.track.0, "count_nm": limits.count_nm, "radius_um": limits.radius.0,
            "swath_um": limits.swath.0,
        }),
        RowContent::Capabilities(parts) => capabilities(parts),
        RowContent::Commands(commands) => json!({
            "of": "commands",
            "commands": rvac_protocol::message::CommandName::ALL
                .into_iter()
                .filter(|name| commands.contains(*name))
                .map(rvac_protocol::message::CommandName::name)
                .collect::<Vec<_>>(),
        }),
        RowContent::Parameter { parameter, min, max } => {
            json!({"of": "parameter", "parameter": parameter.name(), "min": min, "max": max})
        }
        RowContent::Motors(gaps) => {
            json!({"of": "motors", "unguarded": motors(gaps.unguarded), "unmeasured": motors(gaps.unmeasured)})
        }
        RowContent::Unknown => json!({"of": "unknown"}),
    };
    json!({"report": "describe", "row": row.row, "rows": row.rows, "content": content})
}

fn motors(set: MotorSet) -> Vec<&'static str> {
    let named = set.named().into_iter();
    named
        .filter_map(|(name, is_listed)| is_listed.then_some(name))
        .collect()
}

/// What was added later stands in the meaning only where it is there, so that older vectors keep theirs.
fn capabilities(parts: &Capabilities) -> Value {
    let mut meaning = json!({
        "of": "parts", "bumpers": parts.bumpers, "cliffs": parts.cliffs, "wheel_drops": parts.wheel_drops,
        "proximity": parts.proximity, "dock_receivers": parts.dock_receivers, "buttons": parts.buttons,
        "leds": parts.leds, "encoders": parts.encoders, "gyro": parts.gyro, "beeper": parts.beeper,
        "brush_main": parts.brush_main, "brush_sides": parts.brush_sides, "vacuum": parts.vacuum,
        "currents": parts.currents, "battery": parts.battery, "charger": parts.charger,
    });
    if parts.probe {
        meaning["probe"] = json!(true);
    }
    meaning
}

pub(crate) fn firmware(info: &Info) -> Value {
    let mut meaning = json!({
        "report": "info", "firmware_version": info.firmware_version.as_str(),
        "cordlib_version": info.cordlib_version.as_str(), "main_steps_hz": info.main_steps_hz,
        "bandwidth_in": info.bandwidth_in, "bandwidth_out": info.bandwidth_out,
        "battery": info.battery.as_ref().map(battery), "link": link(&info.link),
    });
    if let Some(arming) = info.arming {
        meaning["arming"] = json!(arming.name());
    }
    meaning
}

pub(crate) fn battery(battery: &Battery) -> Value {
    let mut meaning = json!({
        "charge_millionths": battery.charge.millionths(), "voltage_mv": battery.voltage.0,
        "current_ma": battery.current.0, "temperature_tenths": battery.temperature.map(|temperature| temperature.0),
        "state": charge_state(battery.state),
    });
    if let Some(charger) = battery.charger {
        meaning["charger"] = json!({
            "phase": charger.phase.name(), "end": charger.end.map(ChargeEnd::name),
            "fault": charger.fault.map(ChargeFault::name),
        });
    }
    meaning
}

pub(crate) fn link(link: &LinkCounters) -> Value {
    json!({
        "accepted": link.accepted, "bad_seal": link.bad_crc, "overrun": link.overrun, "framing": link.framing,
        "malformed": link.malformed, "refused": link.refused, "resync": link.resync,
    })
}

fn telemetry(state: &State) -> Value {
    json!({
        "report": "state", "tick_ms": state.tick.0, "count_left": state.count_left, "count_right": state.count_right,
        "heading_urad": state.gyro.map(|gyro| gyro.heading.0), "rate_urad_per_s": state.gyro.map(|gyro| gyro.rate.0),
        "bump": [state.bumpers.left, state.bumpers.right],
        "cliff": [state.cliffs.left, state.cliffs.middle, state.cliffs.right],
        "wheel_drop": [state.wheel_drops.left, state.wheel_drops.right],
        "proximity": state.proximity, "dock": state.dock, "buttons": state.buttons, "dust_box": state.dust_box,
        "current_ma": state.currents.map(|all| [all.wheel_left.0, all.wheel_right.0, all.brush_main.0]),
        "battery_mv": state.pack.map(|pack| pack.voltage.0), "battery_ma": state.pack.map(|pack| pack.current.0),
        "charge": charge_state(state.charge), "docked": state.docked, "inhibits": state.inhibits.bits(),
        "motion": motion_phase(state.motion), "cleaners": state.cleaners,
    })
}

fn event_kind(kind: &Event) -> Value {
    match kind {
        Event::Bump(bumpers) => json!({"bump": [bumpers.left, bumpers.right]}),
        Event::Cliff(cliffs) => json!({"cliff": [cliffs.left, cliffs.middle, cliffs.right]}),
        Event::Lift(drops) => json!({"lift": [drops.left, drops.right]}),
        Event::Button { button, pressed } => json!({"button": button, "pressed": pressed}),
        Event::Docked(docked) => json!({"docked": docked}),
        Event::MoveFinished(end) => json!({"move_finished": move_end(*end)}),
        Event::Inhibits(inhibits) => json!({"inhibits": inhibits.bits()}),
        Event::Stall(motor) => json!({"stall": motor.name()}),
    }
}

fn move_end(end: MoveEnd) -> &'static str {
    match end {
        MoveEnd::Done => "done",
        MoveEnd::Inhibited => "inhibited",
        MoveEnd::Replaced => "replaced",
        MoveEnd::TimedOut => "timed-out",
    }
}

fn charge_state(charge: ChargeState) -> &'static str {
    match charge {
        ChargeState::Discharging => "discharging",
        ChargeState::Charging => "charging",
        ChargeState::Full => "full",
        ChargeState::Fault => "fault",
    }
}

fn motion_phase(motion: MotionPhase) -> &'static str {
    match motion {
        MotionPhase::Idle => "idle",
        MotionPhase::Drive => "drive",
        MotionPhase::Move => "move",
        MotionPhase::Motor => "motor",
        MotionPhase::Reflex => "reflex",
    }
}

fn log_level(level: LogLevel) -> &'static str {
    match level {
        LogLevel::Debug => "debug",
        LogLevel::Info => "info",
        LogLevel::Warn => "warn",
        LogLevel::Error => "error",
    }
}
