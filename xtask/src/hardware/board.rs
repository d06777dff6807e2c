//! The nets of a board, as its pads name them.

use super::expression::Node;
use super::schematic::Pin;
use anyhow::Context;
use std::collections::BTreeMap;

/// What of a board must agree with its schematic.
#[derive(Debug)]
pub(super) struct PadNets {
    /// Net of each pad; a pad without a net is missing.
    pub(super) nets: BTreeMap<Pin, String>,
    /// Value and footprint of each part.
    pub(super) parts: BTreeMap<String, (String, String)>,
}

impl PadNets {
    /// Reads the text of a `.kicad_pcb`.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        let board = Node::parse(text)?;
        let (mut nets, mut parts) = (BTreeMap::new(), BTreeMap::new());
        for footprint in board.all("footprint") {
            let text = |kind: &str| {
                let found = footprint.all("fp_text").find(|text| text.word(1) == Some(kind));
                found.and_then(|text| text.word(2)).map(str::to_owned)
            };
            let reference = text("reference").context("a footprint without a reference")?;
            for pad in footprint.all("pad") {
                let number = pad.word(1).unwrap_or_default().to_owned();
                // Nets of the root sheet begin with a slash.
                let net = pad.one("net").and_then(|net| net.word(2)).unwrap_or_default();
                if !net.is_empty() {
                    let pin = Pin {
                        reference: reference.clone(),
                        number,
                    };
                    nets.insert(pin, net.trim_start_matches('/').to_owned());
                }
            }
            let name = footprint.word(1).unwrap_or_default().to_owned();
            parts.insert(reference, (text("value").unwrap_or_default(), name));
        }
        Ok(Self { nets, parts })
    }
}
