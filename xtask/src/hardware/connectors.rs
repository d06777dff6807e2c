//! Whether the adapter's connectors carry what the robot's pinout says.

use super::board::PadNets;
use super::schematic::Pin;
use anyhow::Context;
use serde::Deserialize;

/// The connector to the main board, and the one to the button board.
const MAIN_BOARD: &str = "J2";
const BUTTON_BOARD: &str = "J3";

/// What of a pinout.toml matters here; the rest is checked by `cargo xtask codegen`.
#[derive(Deserialize)]
struct RobotPinout {
    connector: Connector,
    signal: Vec<ConnectorLine>,
}

/// Pins of the connector that are no port pins.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Connector {
    supply: u8,
    ground: u8,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct ConnectorLine {
    name: String,
    function: Option<String>,
    /// Pin of the connector between main board and button board.
    connector: Option<u8>,
    /// What the line is on the button board, when the microcontroller uses it for something else.
    button_board: Option<String>,
}

/// Where the board's connectors differ from the pinout.
pub(super) fn differences(board: &PadNets, pinout: &str) -> anyhow::Result<Vec<String>> {
    let pinout: RobotPinout = toml::from_str(pinout).context("the robot's pinout")?;
    let mut wanted = Vec::new();
    for connector in [MAIN_BOARD, BUTTON_BOARD] {
        wanted.push((connector, pinout.connector.supply, Some("+5VP".to_owned())));
        wanted.push((connector, pinout.connector.ground, Some("GND".to_owned())));
    }
    for signal in &pinout.signal {
        let Some(pin) = signal.connector else { continue };
        // The microcontroller keeps the serial line for itself; all else goes past it to the Linux board.
        let serial = signal.function.as_ref().map(|function| format!("{function}_MCU"));
        wanted.push((MAIN_BOARD, pin, serial));
        let line = signal.button_board.as_ref().unwrap_or(&signal.name);
        wanted.push((BUTTON_BOARD, pin, Some(line.replace('-', "_").to_uppercase())));
    }
    let named = wanted
        .iter()
        .filter(|(connector, ..)| *connector == MAIN_BOARD)
        .count();
    let pads = board.parts.get(MAIN_BOARD).map_or(0, |_| CONNECTOR_PINS);
    let mut faults = Vec::new();
    if named != pads {
        faults.push(format!(
            "the pinout names {named} pins of the connector, the board has {pads}"
        ));
    }
    for (connector, pin, net) in wanted {
        let pad = Pin {
            reference: connector.to_owned(),
            number: pin.to_string(),
        };
        let laid = board.nets.get(&pad);
        if laid != net.as_ref() {
            faults.push(format!("{pad} should be {net:?} and is {laid:?}"));
        }
    }
    Ok(faults)
}

/// Pins of the robot's connector.
const CONNECTOR_PINS: usize = 10;
