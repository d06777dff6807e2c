//! What a robot tells about itself, against its pins.

use super::{FORWARD, OFF, Rule, SESSION, Scene, WireDirection, packet_crc};
use crate::{Sensed, Sides};

const PARTS: &str = r#"{"c":"describe","row":1,"rows":5,"of":"parts","bumpers":2,"cliffs":3,"wheel-drops":2,"proximity":8,"dock-receivers":4,"buttons":3,"leds":4,"has":"encoders gyro currents battery"}"#;

/// A report without anything, and with these keys of the wheels and these flags.
fn state(flags: &str, counts: [i32; 2], currents_a: [f64; 2]) -> String {
    let ([left, right], [x, y]) = (counts, currents_a);
    format!(
        r#"{{"c":"state","t":1,"l":{left},"r":{right},"p":"0000000000000000","d":"00000000","f":"{flags}","k":0,"x":{x},"y":{y},"z":0,"v":15,"a":0,"s":"di","i":0}}"#
    )
}

impl Scene {
    fn tell(&mut self, json: &str) {
        let crc = packet_crc(json.as_bytes(), WireDirection::FromRobot, SESSION);
        self.robot(&format!("{json}*{crc:08X}"));
    }

    /// A robot that has told its parts and stands on a floor.
    fn described(parts: &str) -> Self {
        let mut scene = Self::armed();
        scene.pins.sides = Some(Sides::default());
        scene.tell(parts);
        scene.pass(1_000, OFF);
        scene
    }

    /// Lets `ms` pass with a report of these flags every 20 ms.
    fn telling(&mut self, ms: u32, flags: &str) -> Vec<Rule> {
        let mut broken = Vec::new();
        for _ in 0..ms / 20 {
            broken = self.pass(20, OFF);
            self.tell(&state(flags, self.pins.counts, [0.0; 2]));
        }
        self.pass(1, OFF);
        broken.extend(self.monitor.violations().iter().map(|violation| violation.rule));
        broken.dedup();
        broken
    }
}

/// What happens to the switches.
type Touch = fn(&mut Sides);

#[test]
fn each_switch_is_told_by_its_own_name() {
    let table: [(Touch, &str); 4] = [
        (|sides| sides.bumpers[0] = true, "b"),
        (|sides| sides.bumpers[1] = true, "B"),
        (|sides| sides.wheel_drops[0] = true, "w"),
        (|sides| sides.wheel_drops[1] = true, "W"),
    ];
    for (presses, name) in table {
        for told in ["b", "B", "w", "W", ""] {
            let mut scene = Scene::described(PARTS);
            presses(scene.pins.sides.as_mut().unwrap());
            let expected: &[Rule] = if told == name { &[] } else { &[Rule::ReportsSide] };
            assert_eq!(scene.telling(400, told), expected, "{name} told as {told:?}");
        }
    }
}

#[test]
fn a_report_is_as_late_as_debouncing_and_no_later() {
    let mut scene = Scene::described(PARTS);
    let press = |scene: &mut Scene, on| scene.pins.sides.as_mut().unwrap().bumpers[0] = on;
    press(&mut scene, true);
    assert_eq!(scene.telling(180, ""), []);
    assert_eq!(scene.telling(200, "b"), []);
    press(&mut scene, false);
    assert_eq!(scene.telling(380, "b"), []);
    assert_eq!(scene.telling(60, "b"), [Rule::ReportsSide]);
}

#[test]
fn a_cliff_is_not_told_in_place_of_another_and_a_blind_receiver_may_be() {
    let mut scene = Scene::described(PARTS);
    assert_eq!(scene.telling(400, "c"), [], "blind");
    scene.pins.sides.as_mut().unwrap().cliffs = [false, false, true];
    assert_eq!(scene.telling(400, "cC"), []);
    assert_eq!(scene.telling(400, "c"), [Rule::ReportsSide]);
}

#[test]
fn nothing_is_judged_that_was_not_declared_or_is_too_young() {
    let press = |scene: &mut Scene| scene.pins.sides.as_mut().unwrap().bumpers[0] = true;
    let mut scene = Scene::described(&PARTS.replace(r#""bumpers":2"#, r#""bumpers":1"#));
    press(&mut scene);
    assert_eq!(scene.telling(400, ""), [], "one zone has no sides");
    let mut scene = Scene::described(PARTS);
    press(&mut scene);
    scene.monitor.reset(scene.now_ms, super::ResetCause::Watchdog);
    scene.open_session(SESSION);
    scene.tell(PARTS);
    assert_eq!(scene.telling(900, ""), []);
    assert_eq!(scene.telling(400, ""), [Rule::ReportsSide]);
}

/// What the robot tells of its wheels for two seconds in which both count 1 a millisecond and draw 0.4 A.
fn wheels(told: impl Fn([i32; 2]) -> [i32; 2], currents_a: [f64; 2]) -> Vec<Rule> {
    let mut scene = Scene::described(PARTS);
    scene.pins.sensed.currents_ma = Some([400, 400]);
    let mut broken = Vec::new();
    for _ in 0..100 {
        broken = scene.pass_driven(20, FORWARD);
        let counts = told(scene.pins.counts);
        scene.tell(&state("", counts, currents_a));
    }
    broken
}

#[test]
fn counts_and_currents_are_those_of_the_wheels() {
    let sound = [0.4, 0.4];
    assert_eq!(wheels(|counts| counts, sound), []);
    assert_eq!(
        wheels(|[left, right]| [left + 7_000, right - 3], sound),
        [],
        "another zero"
    );
    assert_eq!(
        wheels(|[left, right]| [left, right * 7 / 10], sound),
        [Rule::ReportsCount]
    );
    assert_eq!(
        wheels(|[left, right]| [-left, right], sound),
        [Rule::ReportsCount]
    );
    assert_eq!(wheels(|counts| counts, [0.4, 0.75]), [], "not calibrated");
    assert_eq!(wheels(|counts| counts, [0.4, 0.85]), [Rule::ReportsCurrent]);
    assert_eq!(wheels(|counts| counts, [-0.1, 0.4]), [Rule::ReportsCurrent]);
}

/// What a robot with a pack of 15 V and 25 degrees tells four times.
fn pack(told: &str) -> Vec<Rule> {
    let mut scene = Scene::described(PARTS);
    scene.pins.sensed = Sensed {
        pack_mv: Some(15_000),
        temperature_dc: Some(250),
        ..Sensed::default()
    };
    for _ in 0..4 {
        scene.pass(1_000, OFF);
        scene.tell(&format!(
            r#"{{"c":"info","battery-status":0.5,{told},"battery-state":"discharging"}}"#
        ));
    }
    scene.pass(1, OFF)
}

#[test]
fn voltage_and_temperature_are_those_of_the_pack() {
    assert_eq!(pack(r#""battery-voltage":15.6,"battery-temperature":28.9"#), []);
    assert_eq!(
        pack(r#""battery-voltage":15.0"#),
        [],
        "a temperature that is not known is not told"
    );
    for told in [
        r#""battery-voltage":16.0,"battery-temperature":25"#,
        r#""battery-voltage":14.0,"battery-temperature":25"#,
        r#""battery-voltage":15.0,"battery-temperature":29.1"#,
        r#""battery-voltage":15.0,"battery-temperature":0"#,
    ] {
        assert_eq!(pack(told), [Rule::ReportsPack], "{told}");
    }
}

#[test]
fn a_part_that_is_not_there_shows_nothing() {
    for (gone, told) in [
        (
            r#" gyro"#,
            state("", [0; 2], [0.0; 2]).replace(r#""p":"#, r#""h":0.1,"g":0,"p":"#),
        ),
        (r#"encoders "#, state("", [1, 0], [0.0; 2])),
        (r#" currents"#, state("", [0; 2], [0.0, 0.1])),
    ] {
        let mut scene = Scene::described(PARTS);
        scene.tell(&told);
        let sound: Vec<Rule> = scene.pass(1, OFF);
        assert_eq!(sound, [], "{told}");
        let mut scene = Scene::described(&PARTS.replace(gone, ""));
        scene.tell(&told);
        assert_eq!(scene.pass(1, OFF), [Rule::ReportsAbsent], "{gone}");
    }
    let mut scene = Scene::described(&PARTS.replace(" battery", ""));
    scene.tell(r#"{"c":"info","battery-status":0.5,"battery-voltage":15,"battery-state":"discharging"}"#);
    assert_eq!(scene.pass(1, OFF), [Rule::ReportsAbsent]);
}

#[test]
fn a_button_is_told_by_its_number() {
    for (down, told, is_false) in [
        (2, 2, false),
        (2, 1, true),
        (2, 0, true),
        (6, 2, false),
        (0, 0, false),
    ] {
        let mut scene = Scene::described(PARTS);
        scene.pins.sides.as_mut().unwrap().buttons = down;
        scene.pass(300, OFF);
        scene.tell(&state("", [0; 2], [0.0; 2]).replace(r#""k":0"#, &format!(r#""k":{told}"#)));
        assert_eq!(
            scene.pass(1, OFF).contains(&Rule::ReportsSide),
            is_false,
            "{down} told as {told}"
        );
    }
}

#[test]
fn something_near_is_told_at_its_own_sensor() {
    let mut shown = [0; 8];
    shown[2] = 220;
    let told = |place: usize, byte: &str| {
        let mut digits = "0000000000000000".to_owned();
        digits.replace_range(2 * place..2 * place + 2, byte);
        state("", [0; 2], [0.0; 2]).replace("0000000000000000", &digits)
    };
    for (report, is_false) in [
        (told(2, "90"), false),
        (told(2, "20"), true),
        (told(3, "90"), true),
        (told(2, "ff"), false),
    ] {
        let mut scene = Scene::described(PARTS);
        scene.pins.sensed.proximity = Some(shown);
        scene.pass(1_100, OFF);
        scene.tell(&report);
        assert_eq!(
            scene.pass(1, OFF).contains(&Rule::ReportsNear),
            is_false,
            "{report}"
        );
    }
}

/// The binary form, byte by byte from section 8 of SPEC.md.
#[test]
fn a_binary_report_is_read_as_well() {
    let mut body = vec![0; 50];
    body[32] = 1;
    let mut packet = vec![0x82];
    packet.extend(&body);
    let crc = packet_crc(&packet, WireDirection::FromRobot, SESSION);
    packet.extend(crc.to_le_bytes());
    let mut scene = Scene::described(PARTS);
    for (place, byte) in packet.iter().enumerate() {
        if place > 0 && [0x1D, 0x1E, 0x1F].contains(byte) {
            scene.monitor.said(scene.now_ms, 0x1D);
            scene.monitor.said(scene.now_ms, byte ^ 0x20);
        } else {
            scene.monitor.said(scene.now_ms, *byte);
        }
    }
    scene.monitor.said(scene.now_ms, 0x1F);
    assert_eq!(scene.pass(1, OFF), [Rule::ReportsSide]);
}
