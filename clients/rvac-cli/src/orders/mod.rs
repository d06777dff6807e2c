//! `rvac clean`, `rvac estimate`, `rvac rooms`, `rvac places` and `rvac zone`: jobs for parts of the home, and what people say of it.

mod places;
mod rooms;
mod zones;

pub(crate) use places::places;
pub(crate) use rooms::rooms;
pub(crate) use zones::zones;

use std::io::{Write as _, stdout};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::Context as _;
use rvac_api::{
    CleaningPattern, CleaningPower, HomeView, JobEstimate, JobOrder, JobPart, NoGoShape, RequestBody, Update,
};

use crate::arguments::{EstimateOptions, OrderOptions, OrderParts, Place};
use crate::control;
use crate::home::known;
use crate::socket::Connection;

/// A plan of a large home takes a small board some seconds.
const PATIENCE: Duration = Duration::from_secs(60);

pub(crate) fn clean(order: &OrderOptions) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&order.daemon)?;
    let body = RequestBody::Clean(to_order(&order.parts, &mut connection)?);
    control::ask(&mut connection, body)
}

pub(crate) fn estimate(options: &EstimateOptions) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&options.order.daemon)?;
    let order = to_order(&options.order.parts, &mut connection)?;
    let request = RequestBody::Estimate(order);
    let (estimate, text) =
        control::answer(&mut connection, request, PATIENCE, |update, text| match update {
            Update::JobEstimate(estimate) => Some((estimate, text)),
            _ => None,
        })?;
    if options.json {
        writeln!(stdout(), "{text}")?;
    } else {
        write!(stdout(), "{}", in_words(&estimate))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn in_words(estimate: &JobEstimate) -> String {
    let charging = match estimate.recharges {
        0 => String::new(),
        1 => ", so it will charge once in between".to_owned(),
        times => format!(", so it will charge {times} times in between"),
    };
    format!(
        "floor     {:.1} m2\ntime      about {:.0} min\nbattery   {:.0} % of a full one, with the way home{charging}\n\
         coverage  about {:.0} %; {:.0} % if the position is half as accurate as estimated\n",
        estimate.floor_m2,
        (estimate.time_s / 60.0).ceil(),
        100.0 * estimate.charge,
        100.0 * estimate.share,
        100.0 * estimate.share_low,
    )
}

/// Rooms first, then zones, then spots, then kept places, each in the order in which they were given.
pub(crate) fn to_order(options: &OrderParts, connection: &mut Connection) -> anyhow::Result<JobOrder> {
    let names_any = !(options.room.is_empty() && options.place.is_empty());
    let home = if names_any {
        known::ask(connection)?.home
    } else {
        HomeView::default()
    };
    order_of(options, |kind, wanted| match kind {
        Named::Room => rooms::find(&home, wanted),
        Named::Place => places::find(&home, wanted),
    })
}

/// The same for a floor where the robot is not: of its map only numbers are known here.
pub(crate) fn to_order_elsewhere(options: &OrderParts) -> anyhow::Result<JobOrder> {
    order_of(options, |_, wanted| {
        wanted.trim().parse().with_context(|| {
            format!("{wanted:?} is no number, and the robot tells names only of the floor on which it is")
        })
    })
}

/// What of the home has a name, and a number.
enum Named {
    Room,
    Place,
}

fn order_of(
    options: &OrderParts,
    number: impl Fn(Named, &str) -> anyhow::Result<u16>,
) -> anyhow::Result<JobOrder> {
    let mut parts = Vec::new();
    for name in &options.room {
        parts.push(JobPart::Room(number(Named::Room, name)?));
    }
    parts.extend(rectangles(&options.zone).map(JobPart::Zone));
    parts.extend(
        options
            .spot
            .iter()
            .map(|place| JobPart::Spot([place.x_m, place.y_m])),
    );
    for name in &options.place {
        parts.push(JobPart::Place(number(Named::Place, name)?));
    }
    Ok(JobOrder {
        parts,
        passes: options.passes,
        avoid: rectangles(&options.avoid).map(NoGoShape::Zone).collect(),
        power: options.power.map(CleaningPower::from),
        pattern: options.pattern.map(CleaningPattern::from),
    })
}

/// Corners of the rectangles between pairs of places.
fn rectangles(places: &[Place]) -> impl Iterator<Item = Vec<[f64; 2]>> + '_ {
    places
        .chunks_exact(2)
        .map(|pair| zones::outline(pair.iter().map(|place| [place.x_m, place.y_m]).collect()))
}

#[cfg(test)]
mod tests {
    use super::in_words;
    use rvac_api::JobEstimate;

    #[test]
    fn an_estimate_says_what_a_job_takes() {
        let estimate = JobEstimate {
            id: Some(1),
            floor_m2: 31.42,
            time_s: 2_410.0,
            charge: 1.2,
            recharges: 1,
            share: 0.978,
            share_low: 0.91,
        };
        assert_eq!(
            in_words(&estimate),
            "floor     31.4 m2\ntime      about 41 min\nbattery   120 % of a full one, with the way home, so it will \
             charge once in between\ncoverage  about 98 %; 91 % if the position is half as accurate as estimated\n"
        );
    }
}
