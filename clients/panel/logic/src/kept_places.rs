//! Zones and spots that the robot keeps under names, as rows.

use rvac_api::{HomeView, PlaceShape, PlaceView};

use crate::sketch::extent;
use crate::words::Words;

/// A kept place as a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlaceRow {
    /// Its number.
    pub number: u16,
    /// What people call it.
    pub name: String,
    /// `zone of 1.5 x 0.8 m`
    pub words: String,
}

/// What is kept, by number.
#[must_use]
pub fn place_rows(words: &Words, home: &HomeView) -> Vec<PlaceRow> {
    let row = |place: &PlaceView| PlaceRow {
        number: place.number,
        name: place.name.clone(),
        words: shape_text(words, &place.shape),
    };
    home.places.iter().map(row).collect()
}

/// `zone of 1.5 x 0.8 m`, or `spot`
#[must_use]
pub(crate) fn shape_text(words: &Words, shape: &PlaceShape) -> String {
    match shape {
        PlaceShape::Zone(corners) => words.map.zone_of.fill([&extent(words, corners)]),
        PlaceShape::Spot(_) => words.map.spot.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{HomeView, PlaceShape, PlaceView};

    use super::place_rows;
    use crate::words::Language;

    #[test]
    fn each_place_is_shown_with_what_it_is() {
        let place = |number, name: &str, shape| PlaceView {
            number,
            name: name.to_owned(),
            shape,
        };
        let home = HomeView {
            places: vec![
                place(
                    2,
                    "Table",
                    PlaceShape::Zone(vec![[0.0, 0.0], [1.5, 0.0], [1.5, 0.8]]),
                ),
                place(5, "Bowl", PlaceShape::Spot([1.0, 1.0])),
            ],
            ..HomeView::default()
        };
        let rows = place_rows(Language::English.words(), &home);
        let told: Vec<(u16, &str, &str)> = rows
            .iter()
            .map(|row| (row.number, row.name.as_str(), row.words.as_str()))
            .collect();
        assert_eq!(
            told,
            [(2, "Table", "zone of 1.5 x 0.8\u{a0}m"), (5, "Bowl", "spot")]
        );
    }
}
