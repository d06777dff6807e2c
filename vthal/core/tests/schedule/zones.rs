//! Every local time fires once a day, in every zone, whatever its clocks do. The oracle walks the minutes and only asks how
//! far a zone is from UTC at each of them.

use jiff::Timestamp;
use jiff::civil::{Date, DateTime, Time};
use jiff::tz::{TimeZone, TimeZoneDatabase};
use vthal_core::schedule::{Days, EditError, Outcome, When, Zone};

use crate::{Draw, book, decide, plan};

const MINUTE_S: i64 = 60;
const HOUR_S: i64 = 3_600;
/// The walk begins and ends so far from the change.
const SPAN_S: i64 = 60 * HOUR_S;
/// Minutes between the change of the clocks and the time of an entry.
const DISTANCES_MIN: [i64; 11] = [-90, -60, -30, -15, -1, 0, 1, 29, 30, 59, 60];
const SAMPLES: u64 = 5_000;

/// A change of clocks.
struct Change {
    name: String,
    rules: TimeZone,
    at_s: i64,
}

#[derive(Clone, Copy, Debug)]
enum RuleKind {
    Daily,
    OnTheDay,
    OnTheDayAfter,
    Once,
    OnceTheDayAfter,
}

const RULE_KINDS: [RuleKind; 5] = [
    RuleKind::Daily,
    RuleKind::OnTheDay,
    RuleKind::OnTheDayAfter,
    RuleKind::Once,
    RuleKind::OnceTheDayAfter,
];

fn second(text: &str) -> Timestamp {
    text.parse().expect("an instant")
}

/// All changes of all zones from 2000 to 2037.
fn changes() -> Vec<Change> {
    let (from, to) = (second("2000-01-01T00:00:00Z"), second("2038-01-01T00:00:00Z"));
    let all = TimeZoneDatabase::bundled();
    let mut names: Vec<String> = all.available().map(|name| name.to_string()).collect();
    names.sort();
    assert!(names.len() > 500, "the database has {} zones", names.len());
    let of = |name: &String| {
        let rules = all.get(name).expect("is there");
        let instants = rules.following(from).map(|change| change.timestamp());
        let changes = instants
            .take_while(|instant| *instant < to)
            .map(|instant| Change {
                name: name.clone(),
                rules: rules.clone(),
                at_s: instant.as_second(),
            });
        changes.collect::<Vec<_>>()
    };
    names.iter().flat_map(of).collect()
}

/// What clocks show, from the distance to UTC alone.
fn local(rules: &TimeZone, utc_s: i64) -> DateTime {
    let offset = rules.to_offset(Timestamp::from_second(utc_s).expect("an instant"));
    let shown = Timestamp::from_second(utc_s + i64::from(offset.seconds())).expect("an instant");
    TimeZone::UTC.to_datetime(shown)
}

/// The first minute at which clocks show the target or later, if they ever show its date.
fn oracle(walk: &[(i64, DateTime)], date: Date, at: Time) -> Option<i64> {
    let target = date.to_datetime(at);
    let exists = walk.iter().any(|(_, shown)| shown.date() == date);
    let reached = walk.iter().find(|(_, shown)| *shown >= target);
    reached.filter(|_| exists).map(|(minute_s, _)| *minute_s)
}

fn rule(kind: RuleKind, day: Date, at: Time) -> When {
    let after = day.tomorrow().expect("a date");
    let weekly = |days: &[Date]| When::Weekly {
        days: days
            .iter()
            .fold(Days::default(), |all, day| all.with(day.weekday())),
        at,
    };
    match kind {
        RuleKind::Daily => {
            let week: Vec<Date> = (0..7)
                .map(|shift| day.saturating_add(jiff::Span::new().days(shift)))
                .collect();
            weekly(&week)
        }
        RuleKind::OnTheDay => weekly(&[day]),
        RuleKind::OnTheDayAfter => weekly(&[after]),
        RuleKind::Once => When::Once { date: day, at },
        RuleKind::OnceTheDayAfter => When::Once { date: after, at },
    }
}

/// Minutes around a change in which each is looked at: the largest step back, three hours of Antarctica, and the largest distance.
const NEAR_MIN: i64 = 3 * 60 + 60 + 20;

/// Instants at which a daemon looks at its clock: each half hour, and each minute around the change and a day before and after.
fn looks(at_s: i64) -> Vec<i64> {
    let near = |centre_s: i64| {
        let minutes = -NEAR_MIN..=NEAR_MIN;
        minutes.map(move |minute| centre_s - centre_s.rem_euclid(MINUTE_S) + minute * MINUTE_S)
    };
    let days = [-48, -24, 0, 24, 48]
        .into_iter()
        .flat_map(|hours| near(at_s + hours * HOUR_S));
    let start_s = at_s - SPAN_S;
    let grid = (0..2 * SPAN_S / (HOUR_S / 2)).map(|step| start_s + step * HOUR_S / 2);
    let mut all: Vec<i64> = days.chain(grid).collect();
    all.sort_unstable();
    all.dedup();
    all
}

fn try_case(change: &Change, kind: RuleKind, distance_min: i64) {
    let case = format!("{} at {} {kind:?} {distance_min} min", change.name, change.at_s);
    let zone = Zone::named(&change.name).expect("known");
    let minute_s = change.at_s - change.at_s.rem_euclid(MINUTE_S);
    let walk: Vec<(i64, DateTime)> = (-SPAN_S / MINUTE_S..=SPAN_S / MINUTE_S)
        .map(|minute| minute_s + minute * MINUTE_S)
        .map(|utc_s| (utc_s, local(&change.rules, utc_s)))
        .collect();
    // The clock as it stood before the change, so that times that are left out are met.
    let old_offset_s = i64::from(
        change
            .rules
            .to_offset(Timestamp::from_second(change.at_s - 1).expect("an instant"))
            .seconds(),
    );
    let shown =
        Timestamp::from_second(minute_s + old_offset_s + distance_min * MINUTE_S).expect("an instant");
    let shown = TimeZone::UTC.to_datetime(shown);
    let when = rule(kind, shown.date(), shown.time());
    let start_s = minute_s - SPAN_S;
    let mut book = vthal_core::schedule::Book::default();
    let added = book.edit(
        vthal_core::schedule::ScheduleEdit::Add(plan(when)),
        zone.at(start_s),
    );
    if let Err(EditError::NoSuchDate(date)) = added {
        assert!(walk.iter().all(|(_, shown)| shown.date() != date), "{case}");
        return;
    }
    added.expect("is a plan");
    let mut fired = Vec::new();
    for now_s in looks(change.at_s).into_iter().filter(|now_s| *now_s > start_s) {
        for verdict in decide(&mut book, &zone, now_s) {
            assert_eq!(verdict.outcome, Outcome::Starting, "{case} {verdict:?} {now_s}");
            fired.push((verdict.date, now_s));
        }
    }
    let end_s = minute_s + 50 * HOUR_S;
    let first = walk.first().expect("is long").1.date();
    let days = (0..8).map(|shift| first.saturating_add(jiff::Span::new().days(shift)));
    let expected: Vec<(Date, i64)> = days
        .filter(|date| when.is_on(*date))
        .filter_map(|date| Some((date, oracle(&walk, date, shown.time())?)))
        .filter(|(_, due_s)| *due_s < end_s && *due_s > minute_s - 50 * HOUR_S)
        .collect();
    let is_meant = |run: &&(Date, i64)| run.1 < end_s && run.1 > minute_s - 50 * HOUR_S;
    let fired: Vec<(Date, i64)> = fired.iter().filter(is_meant).copied().collect();
    assert_eq!(fired, expected, "{case}");
}

#[test]
fn each_local_time_fires_once_a_day_at_sampled_changes() {
    let changes = changes();
    let mut draw = Draw(2_000);
    for _ in 0..SAMPLES {
        let change = &changes[draw.below(changes.len() as u64) as usize];
        let kind = RULE_KINDS[draw.below(RULE_KINDS.len() as u64) as usize];
        let distance_min = DISTANCES_MIN[draw.below(DISTANCES_MIN.len() as u64) as usize];
        try_case(change, kind, distance_min);
    }
}

#[test]
#[ignore = "minutes: every change, rule and distance; run it with --release"]
fn each_local_time_fires_once_a_day_at_every_change() {
    let changes = changes();
    let mut cases = 0_u64;
    for change in &changes {
        for kind in RULE_KINDS {
            for distance_min in DISTANCES_MIN {
                try_case(change, kind, distance_min);
                cases += 1;
            }
        }
    }
    println!("{} changes, {cases} cases", changes.len());
}

#[test]
fn a_date_that_a_zone_leaves_out_has_no_run_and_its_neighbours_have_one() {
    let zone = Zone::named("Pacific/Apia").expect("known");
    let at = jiff::civil::time(8, 0, 0, 0);
    let thursday = jiff::civil::date(2011, 12, 29);
    let start_s = crate::instant(&zone, thursday, at) - 1;
    let mut book = book(&[plan(rule(RuleKind::Daily, thursday, at))], &zone, start_s);
    let fired: Vec<i8> = (0..72 * 60)
        .flat_map(|minute| decide(&mut book, &zone, start_s + minute * MINUTE_S))
        .map(|verdict| verdict.date.day())
        .collect();
    assert_eq!(fired, [29, 31, 1]);
}
