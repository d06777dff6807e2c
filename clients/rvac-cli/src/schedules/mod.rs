//! `rvac schedule`: what starts by itself.

mod words;

use std::io::{Write as _, stdout};
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context as _, bail};
use rvac_api::{
    InQuiet, JobOrder, QuietHours, RequestBody, ScheduleEntry, ScheduleTime, ScheduledJob, Schedules, Topic,
    Update,
};

use crate::arguments::{ScheduleJob, ScheduleOptions, ScheduleVerb};
use crate::control::{self, ANSWER};
use crate::floors;
use crate::orders;
use crate::socket::Connection;

pub(crate) fn run(job: &ScheduleJob) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&job.daemon)?;
    let Some(body) = request(job, &mut connection)? else {
        return show(job, &mut connection);
    };
    let lists = matches!(
        body,
        RequestBody::AddSchedule(_) | RequestBody::ChangeSchedule { .. }
    );
    let code = control::ask(&mut connection, body)?;
    if lists {
        show(job, &mut connection)?;
    }
    Ok(code)
}

/// What the verb asks of the daemon; `None` for those that only show.
fn request(job: &ScheduleJob, connection: &mut Connection) -> anyhow::Result<Option<RequestBody>> {
    let Some(verb) = &job.verb else { return Ok(None) };
    Ok(Some(match verb {
        ScheduleVerb::Next | ScheduleVerb::Past => return Ok(None),
        ScheduleVerb::Add { name, options } => RequestBody::AddSchedule(added(name, options, connection)?),
        ScheduleVerb::Change {
            number,
            name,
            options,
        } => {
            let known = kept(connection)?.0;
            let found = known.entries.into_iter().find(|view| view.number == *number);
            let Some(found) = found else {
                bail!("there is no schedule {number}: `rvac schedule` lists them");
            };
            let mut entry = found.entry;
            entry.name = name.clone().unwrap_or(entry.name);
            RequestBody::ChangeSchedule {
                number: *number,
                entry: changed(entry, options, connection)?,
                // It was read a moment ago.
                was: None,
            }
        }
        ScheduleVerb::Remove { number } => RequestBody::RemoveSchedule { number: *number },
        ScheduleVerb::Enable { number } => enable(*number, true),
        ScheduleVerb::Disable { number } => enable(*number, false),
        ScheduleVerb::SkipNext { number, undo } => RequestBody::SkipNext {
            number: *number,
            skip: !undo,
        },
        ScheduleVerb::RunNow { number } => RequestBody::RunSchedule { number: *number },
        ScheduleVerb::Quiet { from, to } => RequestBody::SetQuiet {
            quiet: quiet(from, to.as_deref())?,
        },
        ScheduleVerb::Zone { name } => RequestBody::SetZone {
            zone: (name != "system").then(|| name.clone()),
        },
    }))
}

fn enable(number: u32, enabled: bool) -> RequestBody {
    RequestBody::EnableSchedule { number, enabled }
}

fn quiet(from: &str, to: Option<&str>) -> anyhow::Result<Option<QuietHours>> {
    match (from, to) {
        ("off", None) => Ok(None),
        (from, Some(to)) => Ok(Some(QuietHours {
            from: from.to_owned(),
            to: to.to_owned(),
        })),
        _ => bail!(
            "quiet hours have a beginning and an end, for example `rvac schedule quiet 22:00 07:00`; `off` for none"
        ),
    }
}

fn added(
    name: &str,
    options: &ScheduleOptions,
    connection: &mut Connection,
) -> anyhow::Result<ScheduleEntry> {
    if options.at.is_none() || (options.days.is_none() && options.date.is_none()) {
        bail!("when? give --at with a time and --days or --date, for example --days weekdays --at 09:30");
    }
    let blank = ScheduleEntry {
        name: name.to_owned(),
        enabled: true,
        job: ScheduledJob::Start { strategy: None },
        when: ScheduleTime::Weekly {
            days: Vec::new(),
            at: String::new(),
        },
        late_min: 0,
        in_quiet: InQuiet::Refuse,
        floor: None,
    };
    changed(blank, options, connection)
}

/// The entry with what the options say.
fn changed(
    mut entry: ScheduleEntry,
    options: &ScheduleOptions,
    connection: &mut Connection,
) -> anyhow::Result<ScheduleEntry> {
    entry.when = time(entry.when, options);
    entry.late_min = options.late.unwrap_or(entry.late_min);
    entry.in_quiet = options.in_quiet.map_or(entry.in_quiet, InQuiet::from);
    let chosen = chosen_floor(options, connection)?;
    let order = match &chosen {
        Some(ChosenFloor::Other(_)) => orders::to_order_elsewhere(&options.parts)?,
        Some(ChosenFloor::Here(_)) | None => orders::to_order(&options.parts, connection)?,
    };
    let known = entry.job.clone();
    entry.job = if options.strategy.is_some() || options.all && order == JobOrder::default() {
        ScheduledJob::Start {
            strategy: options.strategy.clone(),
        }
    } else if options.all {
        ScheduledJob::Clean(order)
    } else {
        with_order(entry.job, order)
    };
    entry.floor = match chosen {
        Some(ChosenFloor::Here(number) | ChosenFloor::Other(number)) => Some(number),
        None if options.any_floor => None,
        // Other places are on the robot's floor, which the daemon knows.
        None => entry.floor.filter(|_| known.places() == entry.job.places()),
    };
    if options.any_floor && entry.job.names_places() {
        bail!("its rooms, zones and spots lie on one floor: give --all besides to clean all of any floor");
    }
    Ok(entry)
}

/// The floor for which an entry shall be.
enum ChosenFloor {
    /// The robot is there, so that its rooms have names.
    Here(u16),
    Other(u16),
}

fn chosen_floor(
    options: &ScheduleOptions,
    connection: &mut Connection,
) -> anyhow::Result<Option<ChosenFloor>> {
    let Some(wanted) = &options.floor else {
        return Ok(None);
    };
    let (floors, _) = floors::ask(connection)?;
    let number = floors::find(&floors, wanted)?;
    Ok(Some(if floors.here == Some(number) {
        ChosenFloor::Here(number)
    } else {
        ChosenFloor::Other(number)
    }))
}

/// The job with what was ordered: as long as no place is named, what is cleaned stays as it is.
fn with_order(job: ScheduledJob, order: JobOrder) -> ScheduledJob {
    match job {
        unchanged if order == JobOrder::default() => unchanged,
        ScheduledJob::Clean(known) if order.parts.is_empty() && order.avoid.is_empty() => {
            ScheduledJob::Clean(JobOrder {
                passes: if order.passes > 1 {
                    order.passes
                } else {
                    known.passes
                },
                power: order.power.or(known.power),
                pattern: order.pattern.or(known.pattern),
                ..known
            })
        }
        _ => ScheduledJob::Clean(order),
    }
}

fn time(known: ScheduleTime, options: &ScheduleOptions) -> ScheduleTime {
    let (ScheduleTime::Weekly { at: known_at, .. } | ScheduleTime::Once { at: known_at, .. }) = &known;
    let at = options.at.clone().unwrap_or_else(|| known_at.clone());
    match (&options.days, &options.date, known) {
        (Some(days), _, _) => ScheduleTime::Weekly {
            days: days.0.clone(),
            at,
        },
        (None, Some(date), _) => ScheduleTime::Once {
            date: date.clone(),
            at,
        },
        (None, None, ScheduleTime::Weekly { days, .. }) => ScheduleTime::Weekly { days, at },
        (None, None, ScheduleTime::Once { date, .. }) => ScheduleTime::Once { date, at },
    }
}

fn show(job: &ScheduleJob, connection: &mut Connection) -> anyhow::Result<ExitCode> {
    let (schedules, text) = kept(connection)?;
    if job.json {
        writeln!(stdout(), "{text}")?;
        return Ok(ExitCode::SUCCESS);
    }
    let text = match job.verb {
        Some(ScheduleVerb::Next) => words::next(&schedules),
        Some(ScheduleVerb::Past) => words::past(&schedules),
        _ => words::list(&schedules),
    };
    write!(stdout(), "{text}")?;
    Ok(ExitCode::SUCCESS)
}

/// What the daemon keeps, and its own text.
fn kept(connection: &mut Connection) -> anyhow::Result<(Schedules, String)> {
    connection.watch(vec![])?;
    connection.watch(vec![Topic::Schedules])?;
    let deadline = Instant::now() + ANSWER;
    while let Some(message) = connection.receive_until(deadline)? {
        if let Some(Update::Schedules(schedules)) = message.update {
            return Ok((schedules, message.text));
        }
    }
    None.with_context(|| {
        format!(
            "vthal told nothing of its schedules within {} s",
            ANSWER.as_secs()
        )
    })
}
