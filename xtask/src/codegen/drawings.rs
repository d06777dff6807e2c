//! Drawings of the ways into robots' chips, for the book, made from robots/*/pinout.toml and robots/chips.

use super::Generated;
use anyhow::Context;
use std::fmt::Write;
use std::path::Path;
use toml::Table;

const FOLDER: &str = "docs/book/src/images";
/// Around the package, for what is written beside pins. All lengths are pixels.
const MARGIN: i32 = 190;
/// From pin to pin of the package.
const PITCH: i32 = 16;
const SIDE_PINS: i32 = 25;
/// From contact to contact of the connector.
const CONTACT_PITCH: i32 = 30;

const HEAD: &str = "<!-- Made by cargo xtask codegen from robots/. Do not edit. -->\n";
const STYLE: &str = "<style>text{font:13px sans-serif;fill:#222}.small{font-size:11px}.body{fill:#fff;stroke:#222;stroke-width:2}\
                     .pin{fill:#bbb}.used{fill:#d33}.ground{fill:#333}.supply{fill:#e90}</style>\n";

/// Names of both drawings.
pub(crate) const DRAWINGS: [&str; 2] = ["way-in-sr8730.svg", "way-in-relax.svg"];

/// Both drawings.
pub(super) fn files(root: &Path) -> anyhow::Result<Vec<Generated>> {
    let robots = root.join("robots");
    let chip = table(&robots.join("chips/pic32mx360f256l.toml"))?;
    let sr8730 = table(&robots.join("samsung-sr8730/pinout.toml"))?;
    let relax = table(&robots.join("vileda-relax/pinout.toml"))?;
    let drawing = |name: &str, text: String| Generated {
        path: root.join(FOLDER).join(name),
        text,
    };
    let [of_sr8730, of_relax] = DRAWINGS;
    Ok(vec![
        drawing(of_sr8730, package(&chip, &sr8730)?),
        drawing(of_relax, connector(&relax)?),
    ])
}

fn table(path: &Path) -> anyhow::Result<Table> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    text.parse().with_context(|| path.display().to_string())
}

fn signals(pinout: &Table) -> impl Iterator<Item = &Table> {
    pinout
        .get("signal")
        .and_then(toml::Value::as_array)
        .into_iter()
        .flatten()
        .filter_map(toml::Value::as_table)
}

fn number(table: &Table, key: &str) -> Option<i32> {
    table
        .get(key)?
        .as_integer()
        .and_then(|value| i32::try_from(value).ok())
}

fn word<'a>(table: &'a Table, key: &str) -> &'a str {
    table.get(key).and_then(toml::Value::as_str).unwrap_or_default()
}

/// The package from above with the pins of the programming port and of the serial line, and supply and ground.
fn package(chip: &Table, pinout: &Table) -> anyhow::Result<String> {
    let pins = chip
        .get("pins")
        .and_then(toml::Value::as_table)
        .context("the chip has no pins")?;
    let body = PITCH * (SIDE_PINS + 1);
    let size = body + 2 * MARGIN;
    let mut text = format!(
        "{HEAD}<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {size} {size}\" role=\"img\">\n<title>{} from above: the pins of the \
         programming port and of the serial line</title>\n{STYLE}<rect class=\"body\" x=\"{MARGIN}\" y=\"{MARGIN}\" width=\"{body}\" \
         height=\"{body}\"/>\n<circle cx=\"{dot}\" cy=\"{dot}\" r=\"6\"/>\n",
        word(chip, "title"),
        dot = MARGIN + 16,
    );
    for pin in 1..=4 * SIDE_PINS {
        let functions = pins.get(&pin.to_string()).and_then(toml::Value::as_array);
        let is = |name: &str| {
            functions
                .into_iter()
                .flatten()
                .any(|one| one.as_str() == Some(name))
        };
        let signal = signals(pinout)
            .find(|signal| number(signal, "pin") == Some(pin) && word(signal, "name").starts_with("link-"));
        let (class, label) = match signal {
            Some(signal) => ("used", line_label(signal)),
            None if is("MCLR") => ("used", "MCLR".to_owned()),
            None if is("VSS") || is("AVSS") => ("ground", "ground".to_owned()),
            None if is("VDD") || is("AVDD") => ("supply", String::new()),
            None => ("pin", String::new()),
        };
        draw_pin(&mut text, (pin, class, &label))?;
    }
    writeln!(
        text,
        "<text x=\"{center}\" y=\"{center}\" text-anchor=\"middle\">{}</text>\n<text class=\"small\" x=\"{center}\" y=\"{below}\" \
         text-anchor=\"middle\">from above; dot = pin 1; orange = 3.3 V</text>\n</svg>",
        word(chip, "title"),
        center = size / 2,
        below = size / 2 + 20
    )?;
    Ok(text)
}

fn line_label(signal: &Table) -> String {
    let port = word(signal, "port");
    match (word(signal, "name"), word(signal, "function")) {
        ("link-receive", _) => format!("{port}: serial in"),
        ("link-transmit", function) => format!("{port}, {function}: data, serial out"),
        (_, function) => format!("{port}, {function}: clock"),
    }
}

/// Pin 1 is at the upper end of the left side; they go around against the clock.
fn draw_pin(text: &mut String, (pin, class, label): (i32, &str, &str)) -> anyhow::Result<()> {
    let (side, place) = ((pin - 1) / SIDE_PINS, (pin - 1) % SIDE_PINS + 1);
    let body = PITCH * (SIDE_PINS + 1);
    let (near, far) = (MARGIN, MARGIN + body);
    let along = place * PITCH;
    let (x, y) = match side {
        0 => (near - 12, near + along),
        1 => (near + along, far),
        2 => (far, far - along),
        _ => (far - along, near - 12),
    };
    let (width, height) = if side % 2 == 0 { (12, 6) } else { (6, 12) };
    writeln!(
        text,
        "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>"
    )?;
    if label.is_empty() {
        return Ok(());
    }
    let (text_x, text_y, anchor, turn) = match side {
        0 => (near - 18, y + 8, "end", 0),
        1 => (x + 8, far + 18, "end", -90),
        2 => (far + 18, y + 8, "start", 0),
        _ => (x + 8, near - 18, "start", -90),
    };
    writeln!(
        text,
        "<text class=\"small\" x=\"{text_x}\" y=\"{text_y}\" text-anchor=\"{anchor}\" transform=\"rotate({turn} {text_x} {text_y})\">{pin} \
         {label}</text>"
    )?;
    Ok(())
}

/// The connector of the button board, contact by contact.
fn connector(pinout: &Table) -> anyhow::Result<String> {
    let own = pinout.get("connector").and_then(toml::Value::as_table);
    let own = own.context("the pinout has no connector")?;
    let (supply, ground) = (number(own, "supply"), number(own, "ground"));
    let contacts = signals(pinout).filter_map(|signal| number(signal, "connector"));
    let last = contacts.chain(supply).chain(ground).max().unwrap_or(0);
    let height = CONTACT_PITCH * (last + 2);
    let mut text = format!(
        "{HEAD}<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 {height}\" role=\"img\">\n<title>The connector between main \
         board and button board</title>\n{STYLE}<rect class=\"body\" x=\"60\" y=\"{top}\" width=\"50\" height=\"{length}\"/>\n",
        top = CONTACT_PITCH / 2,
        length = CONTACT_PITCH * last + CONTACT_PITCH / 2,
    );
    for contact in 1..=last {
        let signal = signals(pinout).find(|signal| number(signal, "connector") == Some(contact));
        let (class, label) = match signal {
            _ if Some(contact) == supply => ("supply", "+5 V of the main board".to_owned()),
            _ if Some(contact) == ground => ("ground", "ground".to_owned()),
            Some(signal) => contact_label(signal),
            None => ("pin", "not connected".to_owned()),
        };
        let y = CONTACT_PITCH * contact;
        writeln!(
            text,
            "<circle class=\"{class}\" cx=\"85\" cy=\"{y}\" r=\"9\"/>\n<text x=\"50\" y=\"{base}\" text-anchor=\"end\">{contact}</text>\n<text \
             x=\"125\" y=\"{base}\">{label}</text>",
            base = y + 5
        )?;
    }
    writeln!(text, "</svg>")?;
    Ok(text)
}

fn contact_label(signal: &Table) -> (&'static str, String) {
    let (port, board) = (word(signal, "port"), word(signal, "button-board"));
    match word(signal, "name") {
        "link-receive" => (
            "used",
            format!("{port}: serial in, and the loader's (on the button board {board})"),
        ),
        "link-transmit" => (
            "used",
            format!("{port}: serial out, and the loader's (on the button board {board})"),
        ),
        name => ("pin", format!("{port}: {name}")),
    }
}
