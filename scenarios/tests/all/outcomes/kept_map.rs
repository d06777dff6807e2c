//! Runs on maps that an earlier version of this program has stored: old files are read, and mean what they meant.

use std::fs;
use std::path::PathBuf;

use brain::StoredMap;
use brain::command::StrategyName;
use content_hash::ContentHash;
use scenarios::{JOB_S, Table, Watched, generated, scene};
use vthal_core::stored_map;

/// A file of `tests/kept/`.
fn kept(name: &str) -> StoredMap {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/kept/{name}.map"));
    stored_map::decode(&fs::read(path).expect("the file is there")).expect("it is a map")
}

#[test]
fn kept_maps_say_what_they_said() {
    let mut table = Table::new(
        "kept-maps",
        "maps as they were stored: content, and content after it was stored again",
    );
    for name in ["two-room-flat", "generated-14"] {
        let map = kept(name);
        let again = stored_map::decode(&stored_map::encode(&map)).expect("what was stored can be read");
        assert_eq!(map, again, "{name}");
        table.line(&format!(
            "{name:<16} {:>3} rooms {:016x} {:016x}",
            map.room_count(),
            ContentHash::of_stored_map(&map).value(),
            ContentHash::of_stored_map(&again).value()
        ));
    }
    table.compare();
}

#[test]
fn runs_on_kept_maps() {
    let mut table = Table::of_outcomes(
        "runs-on-kept-maps",
        "systematic on a map that was stored, seed 11",
    );
    for (name, scene) in [
        ("two-room-flat", scene("two-room-flat", "nominal")),
        ("generated-14", generated(14)),
    ] {
        let mut watched = Watched::new(&scene, 11).with_map(kept(name));
        watched.pass_s(3);
        table.row(&format!("{name}, at rest"), &watched);
        watched.clean(Some(StrategyName::Systematic));
        watched.finish(JOB_S);
        table.row(&format!("{name}, at the end"), &watched);
    }
    table.compare();
}
