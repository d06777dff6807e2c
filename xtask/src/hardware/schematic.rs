//! The nets of a schematic, from what is drawn: which pins touch which wires, and what the wires are called.
//!
//! A pin or a wire's end touches what ends at the same point, or what a dot or a label joins there.

use super::expression::Node;
use anyhow::{Context, bail};
use std::collections::{BTreeMap, BTreeSet};

/// What a pin does to its net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PinKind {
    /// Resistors, connectors, and what nothing else fits.
    Passive,
    /// It only listens.
    Input,
    /// It drives.
    Output,
    /// It pulls to ground or lets go.
    OpenCollector,
    /// It wants a supply.
    PowerIn,
    /// It is a supply.
    PowerOut,
}

impl PinKind {
    fn parse(word: &str) -> anyhow::Result<Self> {
        Ok(match word {
            "passive" => Self::Passive,
            "input" => Self::Input,
            "output" => Self::Output,
            "open_collector" => Self::OpenCollector,
            "power_in" => Self::PowerIn,
            "power_out" => Self::PowerOut,
            other => bail!("pins of the kind {other} are not known here; add what they may be joined with"),
        })
    }
}

/// A pin of a part.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Pin {
    /// Of the part.
    pub(super) reference: String,
    /// Of the pin.
    pub(super) number: String,
}

impl std::fmt::Display for Pin {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}.{}", self.reference, self.number)
    }
}

type Point = (i64, i64);

/// A pin on the sheet.
#[derive(Debug)]
struct Placed {
    pin: Pin,
    kind: PinKind,
    at: Point,
    /// The net that a supply's symbol names.
    supply: Option<String>,
}

/// Pins that are joined.
#[derive(Debug, Default)]
pub(super) struct Net {
    /// All names that it has; one is right.
    pub(super) names: BTreeSet<String>,
    /// Pins of parts.
    pub(super) pins: BTreeMap<Pin, PinKind>,
    /// A flag says that it is supplied from outside.
    pub(super) is_flagged: bool,
}

/// A sheet, with its nets.
#[derive(Debug)]
pub(super) struct Schematic {
    /// All nets that have pins.
    pub(super) nets: Vec<Net>,
    /// Pins with a cross: connected to nothing on purpose.
    pub(super) unused: BTreeSet<Pin>,
    /// Value and footprint of each part.
    pub(super) parts: BTreeMap<String, (String, String)>,
    /// References that two parts have.
    pub(super) doubled: Vec<String>,
}

impl Schematic {
    /// Reads the text of a `.kicad_sch`.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        let sheet = Node::parse(text)?;
        let library = sheet.one("lib_symbols").context("the sheet has no lib_symbols")?;
        let mut placed = Vec::new();
        let mut parts = BTreeMap::new();
        let mut doubled = Vec::new();
        for symbol in sheet.all("symbol") {
            let name = symbol.value("lib_id").context("a symbol without lib_id")?;
            let shape = library
                .all("symbol")
                .find(|shape| shape.word(1) == Some(name))
                .with_context(|| format!("the sheet does not hold its symbol {name}"))?;
            placed.extend(pins(symbol, shape).with_context(|| format!("symbol {name}"))?);
            let reference = symbol.property("Reference").unwrap_or_default();
            let text = |key| symbol.property(key).unwrap_or_default().to_owned();
            if !reference.starts_with('#')
                && parts
                    .insert(reference.to_owned(), (text("Value"), text("Footprint")))
                    .is_some()
            {
                doubled.push(reference.to_owned());
            }
        }
        let joints = Joints::of(&sheet)?;
        let crosses = points(&sheet, "no_connect")?;
        let unused = placed
            .iter()
            .filter(|placed| crosses.contains(&placed.at))
            .map(|placed| placed.pin.clone())
            .collect();
        Ok(Self {
            nets: joints.nets(&placed),
            unused,
            parts,
            doubled,
        })
    }

    /// Net of each pin that has one, by the net's first name.
    pub(super) fn net_of_pins(&self) -> BTreeMap<Pin, String> {
        let pins_of = |net: &Net| {
            let name = net.names.first().cloned().unwrap_or_default();
            net.pins
                .keys()
                .map(|pin| (pin.clone(), name.clone()))
                .collect::<Vec<_>>()
        };
        self.nets.iter().flat_map(pins_of).collect()
    }
}

/// The pins of a symbol, turned as the symbol is.
fn pins(symbol: &Node, shape: &Node) -> anyhow::Result<Vec<Placed>> {
    let reference = symbol.property("Reference").context("it has no reference")?;
    let place = symbol.one("at").context("it has no place")?;
    let (left, top, turn) = (place.length(1)?, place.length(2)?, place.word(3).unwrap_or("0"));
    if symbol.one("mirror").is_some() {
        bail!("mirrored symbols are not read here");
    }
    let mut found = Vec::new();
    for pin in shape.all("symbol").flat_map(|part| part.all("pin")) {
        let at = pin.one("at").context("a pin has no place")?;
        // In a library y points up, on a sheet down.
        let (x, y) = (at.length(1)?, -at.length(2)?);
        let (x, y) = match turn {
            "0" => (x, y),
            "90" => (y, -x),
            "180" => (-x, -y),
            "270" => (-y, x),
            other => bail!("{reference} is turned by {other}"),
        };
        let number = pin.value("number").context("a pin has no number")?;
        let kind = PinKind::parse(pin.word(1).unwrap_or_default())?;
        let is_supply = shape.one("power").is_some() && kind == PinKind::PowerIn;
        found.push(Placed {
            pin: Pin {
                reference: reference.to_owned(),
                number: number.to_owned(),
            },
            kind,
            at: (left + x, top + y),
            supply: is_supply.then(|| pin.value("name").unwrap_or_default().to_owned()),
        });
    }
    Ok(found)
}

fn points(sheet: &Node, head: &str) -> anyhow::Result<BTreeSet<Point>> {
    sheet.all(head).map(place).collect()
}

fn place(node: &Node) -> anyhow::Result<Point> {
    let at = node.one("at").context("an item has no place")?;
    Ok((at.length(1)?, at.length(2)?))
}

/// Wires, and what joins them.
struct Joints {
    wires: Vec<(Point, Point)>,
    dots: BTreeSet<Point>,
    labels: Vec<(Point, String)>,
}

impl Joints {
    fn of(sheet: &Node) -> anyhow::Result<Self> {
        let mut wires = Vec::new();
        for wire in sheet.all("wire") {
            let ends = wire.one("pts").context("a wire without points")?;
            let mut ends = ends.all("xy").map(|end| Ok((end.length(1)?, end.length(2)?)));
            let (Some(begin), Some(end)) = (ends.next(), ends.next()) else {
                bail!("a wire has two ends");
            };
            let wire: anyhow::Result<(Point, Point)> = begin.and_then(|begin| Ok((begin, end?)));
            wires.push(wire?);
        }
        let label = |label: &Node| Ok((place(label)?, label.word(1).unwrap_or_default().to_owned()));
        let labels = sheet.all("label").map(label).collect::<anyhow::Result<_>>()?;
        Ok(Self {
            wires,
            dots: points(sheet, "junction")?,
            labels,
        })
    }

    fn nets(&self, placed: &[Placed]) -> Vec<Net> {
        let mut groups = Groups::default();
        for (begin, end) in &self.wires {
            groups.join(Joint::At(*begin), Joint::At(*end));
        }
        for at in self.dots.iter().chain(self.labels.iter().map(|(at, _)| at)) {
            for wire in self.wires.iter().filter(|wire| lies_on(*at, **wire)) {
                groups.join(Joint::At(*at), Joint::At(wire.0));
            }
        }
        // What has one name is one net, wherever it stands.
        for (at, name) in &self.labels {
            groups.join(Joint::At(*at), Joint::Label(name.clone()));
        }
        for (at, supply) in placed
            .iter()
            .filter_map(|placed| Some((placed.at, placed.supply.clone()?)))
        {
            groups.join(Joint::At(at), Joint::Supply(supply));
        }
        let mut nets: BTreeMap<Joint, Net> = BTreeMap::new();
        for (_, name) in &self.labels {
            let net = nets.entry(groups.root(Joint::Label(name.clone()))).or_default();
            net.names.insert(name.clone());
        }
        for placed in placed {
            let net = nets.entry(groups.root(Joint::At(placed.at))).or_default();
            net.names.extend(placed.supply.clone());
            let of_part = !placed.pin.reference.starts_with('#');
            net.is_flagged |= placed.kind == PinKind::PowerOut && !of_part;
            if of_part {
                net.pins.insert(placed.pin.clone(), placed.kind);
            }
        }
        nets.into_values().filter(|net| !net.pins.is_empty()).collect()
    }
}

/// What can be joined: a point of the sheet, or a name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Joint {
    At(Point),
    Label(String),
    Supply(String),
}

/// Sets of joints, each known by one of its members.
#[derive(Default)]
struct Groups {
    parent: BTreeMap<Joint, Joint>,
}

impl Groups {
    fn root(&self, mut joint: Joint) -> Joint {
        while let Some(parent) = self.parent.get(&joint) {
            joint = parent.clone();
        }
        joint
    }

    fn join(&mut self, one: Joint, other: Joint) {
        let (one, other) = (self.root(one), self.root(other));
        if one != other {
            self.parent.insert(one, other);
        }
    }
}

/// Whether a point lies on a wire, its ends included. Wires are upright or level.
fn lies_on((x, y): Point, ((ax, ay), (bx, by)): (Point, Point)) -> bool {
    let between = |value: i64, a: i64, b: i64| a.min(b) <= value && value <= a.max(b);
    (ax == bx && ax == x && between(y, ay, by)) || (ay == by && ay == y && between(x, ax, bx))
}
