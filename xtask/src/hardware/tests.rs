//! The boards as they are committed keep every rule, and each rule can be broken.

use super::board::PadNets;
use super::schematic::{Pin, Schematic};
use super::{PROJECTS, connectors, rules};
use crate::workspace;
use std::collections::BTreeMap;

fn sources() -> (String, String, String) {
    let project = &PROJECTS[0];
    let pinout = workspace::root()
        .join("robots")
        .join(project.robot)
        .join("pinout.toml");
    (
        project.read("kicad_sch").expect("a schematic"),
        project.read("kicad_pcb").expect("a board"),
        std::fs::read_to_string(pinout).expect("a pinout"),
    )
}

fn schematic(text: &str) -> Schematic {
    Schematic::parse(text).expect("a valid schematic")
}

#[test]
fn the_committed_boards_keep_all_rules() {
    for project in &PROJECTS {
        let faults = project.faults().expect("readable files");
        assert!(faults.is_empty(), "{}: {faults:#?}", project.name);
    }
}

#[test]
fn the_schematic_has_what_the_board_is_for() {
    let nets = schematic(&sources().0).net_of_pins();
    let net = |reference: &str, number: &str| {
        let pin = Pin {
            reference: reference.to_owned(),
            number: number.to_owned(),
        };
        nets.get(&pin).map(String::as_str)
    };
    // The header of the Linux board: pins of a Raspberry Pi.
    let header = [
        ("2", "+5V"),
        ("4", "+5V"),
        ("1", "+3V3"),
        ("3", "SDA"),
        ("5", "SCL"),
        ("8", "UART_TX"),
        ("10", "UART_RX"),
        ("7", "PI_BUTTON_1"),
        ("11", "PI_BUTTON_2"),
        ("13", "PI_BUTTON_3"),
        ("15", "PI_LED_1"),
        ("16", "PI_LED_2"),
        ("18", "PI_LED_3"),
        ("29", "PI_LED_OK"),
        ("31", "PI_LED_UNKNOWN"),
        ("22", "MAIN_ENABLE"),
    ];
    for (pin, wanted) in header {
        assert_eq!(net("J4", pin), Some(wanted), "pin {pin}");
    }
    // The line to the microcontroller is pulled up to its own supply, and driven by an output that only pulls down.
    assert_eq!(
        (net("R10", "1"), net("R10", "2")),
        (Some("+5VP"), Some("RXD_MCU"))
    );
    assert_eq!(
        (net("U2", "2"), net("U2", "4")),
        (Some("UART_TX"), Some("RXD_DRIVE"))
    );
    // What switches the main board off lies between battery and main board.
    assert_eq!(
        (net("Q2", "1"), net("Q2", "5"), net("J6", "1")),
        (Some("VBAT"), Some("MAIN_POWER"), Some("MAIN_POWER"))
    );
}

/// What is said after the first such text of the schematic was replaced.
fn broken(from: &str, to: &str) -> Vec<String> {
    let text = sources().0;
    assert!(text.contains(from), "{from}");
    rules::electrical_faults(&schematic(&text.replacen(from, to, 1)))
}

#[test]
fn each_electrical_rule_can_be_broken() {
    let table = [
        ("(label \"SDA\"", "(label \"SCL2\"", "connected to nothing"),
        (
            "(label \"TXD_CLEAN\"",
            "(label \"BUTTON_1_OUT\"",
            "several outputs",
        ),
        (
            "(property \"Reference\" \"R10\"",
            "(property \"Reference\" \"R11\"",
            "two parts",
        ),
        ("(pin power_out", "(pin passive", "nothing supplies"),
    ];
    for (from, to, wanted) in table {
        let faults = broken(from, to);
        assert!(
            faults.iter().any(|fault| fault.contains(wanted)),
            "{to}: {faults:#?}"
        );
    }
}

#[test]
fn a_board_that_differs_from_its_schematic_is_found() {
    let (drawn, laid, _) = sources();
    let drawn = schematic(&drawn);
    let mut board = PadNets::parse(&laid).expect("a board");
    assert!(rules::differences(&drawn, &board).is_empty());
    let pad = Pin {
        reference: "U3".to_owned(),
        number: "2".to_owned(),
    };
    board.nets.insert(pad, "TXD_MCU".to_owned());
    board.parts.remove("C1");
    let faults = rules::differences(&drawn, &board);
    assert_eq!(faults.len(), 2, "{faults:#?}");
    assert!(faults[0].contains("U3.2: TXD_SENSE in the schematic, TXD_MCU on the board"));
}

#[test]
fn a_connector_that_differs_from_the_pinout_is_found() {
    let (_, laid, pinout) = sources();
    let board = PadNets::parse(&laid).expect("a board");
    let faults = |pinout: &str| connectors::differences(&board, pinout).expect("a pinout");
    assert!(faults(&pinout).is_empty());
    let swapped = pinout.replace("connector = 7", "connector = 5");
    assert!(
        faults(&swapped).iter().any(|fault| fault.contains("J3.5")),
        "{:?}",
        faults(&swapped)
    );
    let lost = pinout.replace("connector = 10\n", "");
    assert!(faults(&lost).iter().any(|fault| fault.contains("names 9 pins")));
}

#[test]
fn the_list_of_parts_names_each_part_once() {
    let path = PROJECTS[0].folder().join("bill-of-materials.csv");
    let text = std::fs::read_to_string(path).expect("a list of parts");
    let mut listed: BTreeMap<&str, usize> = BTreeMap::new();
    for line in text.lines().skip(1) {
        for reference in line.split(',').next().unwrap_or_default().split(' ') {
            *listed.entry(reference).or_default() += 1;
        }
    }
    let drawn = schematic(&sources().0).parts;
    let bought: Vec<&str> = drawn
        .keys()
        .map(String::as_str)
        .filter(|reference| !reference.starts_with("TP") && !reference.starts_with('H'))
        .collect();
    assert_eq!(listed.keys().copied().collect::<Vec<_>>(), bought);
    assert!(listed.values().all(|count| *count == 1), "{listed:?}");
}
