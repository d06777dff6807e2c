//! Files of machines that are understood or refused, and what their pages say.

use super::data::{FactsOrigin, MachineFacts};
use super::page::{Background, text};
use crate::codegen::board::Pinout;
use crate::workspace;
use std::path::Path;

const SR8730: &str = "robots/samsung-sr8730";

fn parsed(file: &str, text: &str) -> Result<MachineFacts, String> {
    let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
    MachineFacts::parse(text, Path::new(file), &name).map_err(|error| format!("{error:#}"))
}

fn of_others(text: &str) -> Result<MachineFacts, String> {
    parsed(
        "robots/machines/acme.toml",
        &format!("title = \"Acme\"\nkind = \"vacuum\"\nruns = \"Nothing.\"\n{text}"),
    )
}

/// A sister of the SR8730 with these lines at the top of its file and those at its end.
fn sister(board: &str, end: &str) -> MachineFacts {
    let text = format!(
        "title = \"Acme\"\nkind = \"vacuum\"\nruns = \"Nothing.\"\nboard = \"{board}\"\nconfidence = \"one-source\"\n\
         source = \"a page\"\n{end}"
    );
    parsed(&format!("{SR8730}/variants/acme.toml"), &text).expect("a sound file")
}

fn pinout() -> Pinout {
    let root = workspace::root();
    Pinout::load(&root.join("robots"), &root.join(SR8730)).expect("a sound pinout")
}

fn display(segments: &str, unverified: &str) -> String {
    format!(
        "[display]\ndigits = [\"display-digit-1\", \"display-digit-2\", \"display-digit-3\", \"display-digit-4\"]\n\
         segments = [{segments}]\ncolon = \"display-colon\"\nunverified = [{unverified}]\n"
    )
}

const SEGMENTS: &str = "\"display-segment-a\", \"display-segment-b\", \"light-line-0\", \"light-line-1\", \"light-line-2\", \
                        \"light-line-3\", \"light-line-4\"";

#[test]
fn the_place_of_a_file_says_whose_facts_it_has() {
    let others = of_others("").expect("a sound file");
    assert!(matches!(others.origin, FactsOrigin::Others));
    let sister = sister("same", "");
    assert!(matches!(&sister.origin, FactsOrigin::Sister(sister) if sister.base == SR8730));
    let ours = parsed(
        &format!("{SR8730}/machine.toml"),
        "title = \"Acme\"\nkind = \"vacuum\"\nruns = \"Ours.\"\n",
    );
    assert!(matches!(ours.expect("a sound file").origin, FactsOrigin::Ours(folder) if folder == SR8730));
}

#[test]
fn what_a_file_lacks_or_has_too_much_is_refused_by_name() {
    let missing = parsed(
        &format!("{SR8730}/variants/acme.toml"),
        "title = \"Acme\"\nkind = \"vacuum\"\nruns = \"Nothing.\"\n",
    );
    assert!(missing.is_err_and(|said| said.contains("how much of the board it shares: board")));
    for (text, reason) in [
        ("board = \"same\"\n", "are for variants"),
        ("colour = \"red\"\n", "unknown field `colour`"),
        (
            "[[fact]]\nsection = \"chip\"\nabout = \"x\"\nsays = \"y\"\nconfidence = \"known\"\nsource = \" \"\n",
            "says nothing or has no source",
        ),
        (
            "[[fact]]\nsection = \"chip\"\nabout = \"x\"\nsays = \"y\"\nconfidence = \"sure\"\nsource = \"z\"\n",
            "unknown variant `sure`",
        ),
        (
            "[[table]]\nsection = \"pins\"\ntitle = \"T\"\ncolumns = [\"a\", \"b\"]\nrows = [[\"1\"]]\nconfidence = \"known\"\nsource = \"z\"\n",
            "has 2 columns, the row [\"1\"] has 1",
        ),
    ] {
        let refusal = of_others(text).expect_err(text);
        assert!(refusal.contains(reason), "{refusal}");
    }
}

#[test]
fn a_display_has_lines_that_the_base_has_each_once() {
    let pinout = pinout();
    let said = |segments: &str, unverified: &str| {
        let sister = sister("same", &display(segments, unverified));
        sister.check(&pinout).map_err(|error| error.to_string())
    };
    assert_eq!(said(SEGMENTS, "\"c\""), Ok(()));
    let strange = said(&SEGMENTS.replace("light-line-4", "light-line-5"), "");
    assert!(strange.is_err_and(|said| said.contains("\"light-line-5\", which pinout.toml does not know")));
    let twice = said(&SEGMENTS.replace("light-line-4", "light-line-3"), "");
    assert!(twice.is_err_and(|said| said.contains("\"light-line-3\" twice")));
    assert!(said(SEGMENTS, "\"h\"").is_err_and(|said| said.contains("no segment \"h\"")));
}

#[test]
fn a_page_says_of_each_part_what_is_known_or_that_nothing_is() {
    let machine = of_others(
        "unknown = [\"the chip\"]\n[[fact]]\nsection = \"protocol\"\nabout = \"line\"\nsays = \"a|b\"\nconfidence = \"one-source\"\n\
         source = \"a forum\"\n",
    )
    .expect("a sound file");
    let background = Background {
        pinout: None,
        base: None,
    };
    let page = text(&machine, &background).expect("a string takes everything");
    assert!(page.contains("## Chip\n\nNothing is known.\n"), "{page}");
    assert!(page.contains("| line | a\\|b | one source | a forum |"), "{page}");
    assert!(page.contains("## What nobody knows\n\n- the chip\n"), "{page}");
}

#[test]
fn a_sister_has_the_chip_of_its_base_only_where_the_board_is_taken_for_the_same() {
    let pinout = pinout();
    let base = parsed(
        &format!("{SR8730}/machine.toml"),
        "title = \"Base\"\nkind = \"vacuum\"\nruns = \"Ours.\"\n",
    )
    .expect("a sound file");
    let page = |board: &str, end: &str| {
        let background = Background {
            pinout: Some(&pinout),
            base: Some(&base),
        };
        text(&sister(board, end), &background).expect("a string takes everything")
    };
    let same = page("same", &display(SEGMENTS, "\"c\""));
    assert!(
        same.contains("## Chip\n\nAs the [Base](machine.md#chip).\n"),
        "{same}"
    );
    assert!(
        same.contains("| segment b | `display-segment-b` | RE1 | 94 | one source |"),
        "{same}"
    );
    assert!(
        same.contains("| segment c | `light-line-0` | RE2 | 98 | unverified |"),
        "{same}"
    );
    for board in ["similar", "unknown"] {
        let other = page(board, "");
        assert!(other.contains("## Chip\n\nNothing is known.\n"), "{other}");
        assert!(!other.contains("PIC32"), "{other}");
    }
}
