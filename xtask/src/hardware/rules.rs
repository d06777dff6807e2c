//! The electrical rules: KiCad 6 has no command that checks them without a window.

use super::board::PadNets;
use super::schematic::{Net, Pin, PinKind, Schematic};
use std::collections::{BTreeMap, BTreeSet};

/// What is wrong with a schematic; empty = nothing.
pub(super) fn electrical_faults(schematic: &Schematic) -> Vec<String> {
    let mut faults: Vec<String> = schematic
        .doubled
        .iter()
        .map(|reference| format!("{reference}: two parts have this reference"))
        .collect();
    for net in &schematic.nets {
        faults.extend(net_faults(net, &schematic.unused));
    }
    faults
}

fn net_faults(net: &Net, unused: &BTreeSet<Pin>) -> Vec<String> {
    let pins: Vec<String> = net.pins.keys().map(ToString::to_string).collect();
    let shown = pins.join(" ");
    let crossed = net.pins.keys().any(|pin| unused.contains(pin));
    let mut faults = Vec::new();
    if crossed && (net.pins.len() > 1 || !net.names.is_empty()) {
        faults.push(format!("{shown}: marked as unused, and connected"));
    }
    if crossed {
        return faults;
    }
    match net.names.len() {
        0 => faults.push(format!("{shown}: this net has no name")),
        1 => {}
        _ => {
            let names: Vec<&str> = net.names.iter().map(String::as_str).collect();
            faults.push(format!("{} are one net: {shown}", names.join(" and ")));
        }
    }
    if net.pins.len() < 2 {
        faults.push(format!(
            "{shown}: connected to nothing; mark it as unused if that is meant"
        ));
    }
    let count = |kind: PinKind| net.pins.values().filter(|have| **have == kind).count();
    let drivers = count(PinKind::Output) + count(PinKind::PowerOut);
    if drivers > 1 || (drivers == 1 && count(PinKind::OpenCollector) > 0) {
        faults.push(format!("{shown}: several outputs drive this net"));
    }
    if count(PinKind::PowerIn) > 0 && drivers == 0 && !net.is_flagged {
        faults.push(format!("{shown}: a supply pin that nothing supplies"));
    }
    let heard = count(PinKind::Input);
    if heard > 0 && heard == net.pins.len() {
        faults.push(format!("{shown}: only inputs, which nothing drives"));
    }
    faults
}

/// Where board and schematic differ.
pub(super) fn differences(schematic: &Schematic, board: &PadNets) -> Vec<String> {
    let drawn: BTreeMap<Pin, String> = schematic
        .net_of_pins()
        .into_iter()
        .filter(|(pin, _)| !schematic.unused.contains(pin))
        .collect();
    let mut faults = Vec::new();
    for pin in drawn.keys().chain(board.nets.keys()).collect::<BTreeSet<_>>() {
        let (drawn, laid) = (drawn.get(pin), board.nets.get(pin));
        if drawn != laid {
            let name = |net: Option<&String>| net.cloned().unwrap_or_else(|| "nothing".to_owned());
            faults.push(format!(
                "{pin}: {} in the schematic, {} on the board",
                name(drawn),
                name(laid)
            ));
        }
    }
    for reference in schematic
        .parts
        .keys()
        .chain(board.parts.keys())
        .collect::<BTreeSet<_>>()
    {
        let (drawn, laid) = (schematic.parts.get(reference), board.parts.get(reference));
        if drawn != laid {
            faults.push(format!(
                "{reference}: {drawn:?} in the schematic, {laid:?} on the board"
            ));
        }
    }
    faults
}
