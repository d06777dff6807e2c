//! `rvac zone`: no-go zones and virtual walls.

use std::io::{Write as _, stdout};
use std::process::ExitCode;

use anyhow::bail;
use rvac_api::{HomeView, NoGoShape, NoGoView, RequestBody};

use crate::arguments::{Place, ZoneJob, ZoneVerb};
use crate::control;
use crate::home::known;
use crate::socket::Connection;

pub(crate) fn zones(job: &ZoneJob) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&job.daemon)?;
    let body = match &job.verb {
        None => {
            let home = known::ask(&mut connection)?.home;
            write!(stdout(), "{}", table(&home))?;
            return Ok(ExitCode::SUCCESS);
        }
        Some(ZoneVerb::Add {
            from,
            to,
            corner,
            name,
        }) => {
            let corners = [from, to].into_iter().chain(corner).map(pair).collect();
            RequestBody::AddNoGo {
                shape: NoGoShape::Zone(outline(corners)),
                name: name.clone(),
            }
        }
        Some(ZoneVerb::Wall { from, to, name }) => RequestBody::AddNoGo {
            shape: NoGoShape::Wall([pair(from), pair(to)]),
            name: name.clone(),
        },
        Some(ZoneVerb::Name { zone, name }) => RequestBody::NameNoGo {
            number: find(&known::ask(&mut connection)?.home, zone)?,
            name: Some(name.clone()),
        },
        Some(ZoneVerb::Unname { zone }) => RequestBody::NameNoGo {
            number: find(&known::ask(&mut connection)?.home, zone)?,
            name: None,
        },
        Some(ZoneVerb::Reshape {
            zone,
            from,
            to,
            corner,
        }) => {
            let corners = [from, to].into_iter().chain(corner).map(pair).collect();
            reshaped(&known::ask(&mut connection)?.home, zone, corners)?
        }
        Some(ZoneVerb::Remove { zone }) => RequestBody::RemoveNoGo {
            number: match zone.trim().parse() {
                Ok(number) => number,
                Err(_) => find(&known::ask(&mut connection)?.home, zone)?,
            },
        },
    };
    control::ask(&mut connection, body)
}

/// The number of the zone or wall with this name or number.
fn find(home: &HomeView, wanted: &str) -> anyhow::Result<u16> {
    let wanted = wanted.trim();
    let is_called = |no_go: &&NoGoView| {
        let name = no_go.name.as_deref();
        name.is_some_and(|name| name.to_lowercase() == wanted.to_lowercase())
    };
    let by_name = home.no_go.iter().find(is_called).map(|no_go| no_go.number);
    match by_name.or_else(|| wanted.parse().ok()) {
        Some(number) => Ok(number),
        None => bail!("no no-go zone or virtual wall is called {wanted:?}: `rvac zone` lists them"),
    }
}

/// What makes the wall or zone of this name lie between these corners.
fn reshaped(home: &HomeView, wanted: &str, corners: Vec<[f64; 2]>) -> anyhow::Result<RequestBody> {
    let number = find(home, wanted)?;
    let known = home.no_go.iter().find(|no_go| no_go.number == number);
    let is_wall = known.is_some_and(|known| matches!(known.shape, NoGoShape::Wall(_)));
    let shape = match (is_wall, corners.as_slice()) {
        (true, &[from, to]) => NoGoShape::Wall([from, to]),
        (true, _) => bail!("{wanted:?} is a virtual wall, which has two ends and no --corner"),
        (false, _) => NoGoShape::Zone(outline(corners)),
    };
    Ok(RequestBody::ReshapeNoGo {
        number,
        shape,
        was: None,
    })
}

fn pair(place: &Place) -> [f64; 2] {
    [place.x_m, place.y_m]
}

/// Two corners give a rectangle along the axes of the map.
pub(super) fn outline(corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    match corners.as_slice() {
        &[[x, y], [far_x, far_y]] => vec![[x, y], [far_x, y], [far_x, far_y], [x, far_y]],
        _ => corners,
    }
}

fn table(home: &HomeView) -> String {
    if home.no_go.is_empty() {
        return "no restricted areas\n".to_owned();
    }
    let mut text = "number  what\n".to_owned();
    for no_go in &home.no_go {
        let (kind, corners) = match &no_go.shape {
            NoGoShape::Zone(corners) => ("no-go zone   ", corners.as_slice()),
            NoGoShape::Wall(ends) => ("virtual wall ", ends.as_slice()),
        };
        let places: Vec<String> = corners.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        let name = no_go.name.as_ref();
        let name = name.map(|name| format!("  {name}")).unwrap_or_default();
        text += &format!("{:<7} {kind} {}{name}\n", no_go.number, places.join(" "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{find, outline, reshaped, table};
    use rvac_api::{HomeView, NoGoShape, NoGoView, RequestBody};

    #[test]
    fn a_wall_stays_a_wall_and_a_zone_a_zone() {
        let view = |number, shape| NoGoView {
            number,
            shape,
            name: None,
        };
        let home = HomeView {
            no_go: vec![
                view(3, NoGoShape::Wall([[0.0, 0.0], [1.0, 0.0]])),
                view(4, NoGoShape::Zone(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])),
            ],
            ..HomeView::default()
        };
        let ends = [[0.0, 1.0], [2.0, 3.0]];
        for (wanted, number, shape) in [
            ("3", 3, NoGoShape::Wall(ends)),
            ("4", 4, NoGoShape::Zone(outline(ends.to_vec()))),
        ] {
            let body = reshaped(&home, wanted, ends.to_vec()).expect("is there");
            assert_eq!(
                body,
                RequestBody::ReshapeNoGo {
                    number,
                    shape,
                    was: None
                }
            );
        }
        let three = vec![[0.0, 1.0], [2.0, 3.0], [0.0, 3.0]];
        assert!(reshaped(&home, "3", three.clone()).is_err());
        assert!(reshaped(&home, "4", three).is_ok());
    }

    #[test]
    fn two_corners_make_a_rectangle_and_more_are_what_they_are() {
        let rectangle = outline(vec![[0.0, 1.0], [2.0, 3.0]]);
        assert_eq!(rectangle, [[0.0, 1.0], [2.0, 1.0], [2.0, 3.0], [0.0, 3.0]]);
        let triangle = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(outline(triangle.clone()), triangle);
    }

    #[test]
    fn each_zone_has_a_line() {
        let home = HomeView {
            no_go: vec![NoGoView {
                number: 3,
                shape: NoGoShape::Wall([[0.0, -0.5], [1.0, 0.5]]),
                name: Some("Cats".to_owned()),
            }],
            ..HomeView::default()
        };
        assert_eq!(
            table(&home),
            "number  what\n3       virtual wall  0.00,-0.50 1.00,0.50  Cats\n"
        );
        for (wanted, number) in [("cats", 3), (" 3", 3), ("9", 9)] {
            assert_eq!(find(&home, wanted).expect("is found"), number, "{wanted}");
        }
        assert!(find(&home, "Dogs").is_err());
        assert_eq!(table(&HomeView::default()), "no restricted areas\n");
    }
}
