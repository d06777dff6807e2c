//! `rvac places`: zones and spots that are kept under names.

use std::io::{Write as _, stdout};
use std::process::ExitCode;

use anyhow::bail;
use rvac_api::{HomeView, PlaceShape, PlaceView, RequestBody};

use super::zones::outline;
use crate::arguments::{Place, PlacesJob, PlacesVerb};
use crate::control;
use crate::home::known;
use crate::socket::Connection;

pub(crate) fn places(job: &PlacesJob) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&job.daemon)?;
    let mut number = |place: &str| find(&known::ask(&mut connection)?.home, place);
    let body = match &job.verb {
        None => {
            write!(stdout(), "{}", table(&known::ask(&mut connection)?.home))?;
            return Ok(ExitCode::SUCCESS);
        }
        Some(PlacesVerb::Keep {
            name,
            zone,
            corner,
            spot,
        }) => RequestBody::KeepPlace {
            name: name.clone(),
            shape: shape(spot.as_ref(), zone.iter().chain(corner)),
            number: None,
        },
        Some(PlacesVerb::Reshape {
            place,
            zone,
            corner,
            spot,
        }) => RequestBody::ReshapePlace {
            number: number(place)?,
            shape: shape(spot.as_ref(), zone.iter().chain(corner)),
            was: None,
        },
        Some(PlacesVerb::Name { place, name }) => RequestBody::NamePlace {
            number: number(place)?,
            name: name.clone(),
        },
        Some(PlacesVerb::Forget { place }) => RequestBody::ForgetPlace {
            number: number(place)?,
        },
    };
    control::ask(&mut connection, body)
}

/// A spot if there is one, else a zone with these corners.
fn shape<'place>(spot: Option<&Place>, corners: impl Iterator<Item = &'place Place>) -> PlaceShape {
    let pair = |place: &Place| [place.x_m, place.y_m];
    match spot {
        Some(middle) => PlaceShape::Spot(pair(middle)),
        None => PlaceShape::Zone(outline(corners.map(pair).collect())),
    }
}

fn table(home: &HomeView) -> String {
    if home.places.is_empty() {
        return "no saved zones: `rvac places keep NAME --zone X,Y X,Y` saves one\n".to_owned();
    }
    let mut text = "number  what\n".to_owned();
    for place in &home.places {
        let (kind, corners) = match &place.shape {
            PlaceShape::Zone(corners) => ("zone", corners.as_slice()),
            PlaceShape::Spot(middle) => ("spot", core::slice::from_ref(middle)),
        };
        let corners: Vec<String> = corners.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        text += &format!(
            "{:<7} {kind}  {}  {}\n",
            place.number,
            corners.join(" "),
            place.name
        );
    }
    text
}

/// The number of the place with this name or number.
pub(super) fn find(home: &HomeView, wanted: &str) -> anyhow::Result<u16> {
    let wanted = wanted.trim();
    let is_called = |place: &&PlaceView| place.name.to_lowercase() == wanted.to_lowercase();
    let by_name = home.places.iter().find(is_called).map(|place| place.number);
    if let Some(number) = by_name.or_else(|| wanted.parse().ok()) {
        return Ok(number);
    }
    let names: Vec<String> = home
        .places
        .iter()
        .map(|place| format!("{} ({})", place.number, place.name))
        .collect();
    if names.is_empty() {
        bail!("no saved zone is called {wanted:?}: there are none");
    }
    bail!(
        "no place is called {wanted:?}: the map keeps {}",
        names.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use rvac_api::{HomeView, PlaceShape, PlaceView};

    use super::{find, table};

    fn home() -> HomeView {
        let place = |number, name: &str, shape| PlaceView {
            number,
            name: name.to_owned(),
            shape,
        };
        HomeView {
            places: vec![
                place(
                    2,
                    "Table",
                    PlaceShape::Zone(vec![[0.0, 0.5], [1.0, 0.5], [1.0, 2.0]]),
                ),
                place(4, "Bowl", PlaceShape::Spot([-0.5, 3.0])),
            ],
            ..HomeView::default()
        }
    }

    #[test]
    fn each_place_has_a_line() {
        assert_eq!(
            table(&home()),
            "number  what\n2       zone  0.00,0.50 1.00,0.50 1.00,2.00  Table\n4       spot  -0.50,3.00  Bowl\n"
        );
        assert!(table(&HomeView::default()).starts_with("no saved zones"));
    }

    #[test]
    fn a_place_is_found_by_its_name_and_else_by_its_number() {
        for (wanted, number) in [("bowl", 4), (" 2 ", 2), ("77", 77)] {
            assert_eq!(find(&home(), wanted).expect("is found"), number, "{wanted}");
        }
        let error = find(&home(), "Desk").expect_err("is unknown").to_string();
        assert!(error.contains("2 (Table), 4 (Bowl)"), "{error}");
    }
}
