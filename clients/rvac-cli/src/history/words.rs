//! Runs in words.

use jiff::Timestamp;
use jiff::tz::TimeZone;
use rvac_api::{Run, RunAsker, RunJob, RunRecord, RunResult, RunStop};

/// Runs, a line each.
pub(super) fn list(runs: &[Run], more: bool) -> String {
    let mut text = String::new();
    if runs.is_empty() {
        text += "no runs yet: a run appears when a job ends\n";
    }
    for run in runs {
        text += &format!(
            "{:<4} {:<20} {:<9} {:>7} {:>8} {:>8}  {}\n",
            run.number,
            when(run.start_s),
            job_name(&run.job),
            span(run.duration_s),
            format!("{:.1} m2", run.swept_m2),
            charge(run),
            run.text
        );
    }
    if let (true, Some(last)) = (more, runs.last()) {
        text += &format!("rvac history --before {} shows older ones\n", last.number);
    }
    text
}

/// All that is kept of a run, without its picture.
pub(super) fn record(record: &RunRecord) -> String {
    let run = &record.run;
    let share = run.share.map_or_else(String::new, |share| {
        format!(", {:.0} % of that floor as its map tells", 100.0 * share)
    });
    let mut text = format!(
        "run {}: {}\n\
         began     {}\n\
         ended     {}\n\
         order     {}, by {}\n\
         time      {}, {} of it in motion\n\
         cleaned   {:.1} m2{share}\n\
         distance  {:.0} m, {} bumps\n",
        run.number,
        run.text,
        when(run.start_s),
        match run.result {
            RunResult::CutShort => "nobody knows when".to_owned(),
            _ => when(run.end_s),
        },
        job(&run.job),
        asker(&run.by),
        span(run.duration_s),
        span(run.moving_s),
        run.swept_m2,
        run.path_m,
        run.bumps,
    );
    if let Some(by_s) = run.clock_set_s {
        let direction = if by_s < 0 { "back" } else { "forward" };
        let by = span(by_s.unsigned_abs() as f64);
        text += &format!("clock     set {direction} by {by} meanwhile; both times are by the later one\n");
    }
    text += &format!("battery   {}\n", charge(run));
    text += &match run.map {
        Some(map) => format!("map       version {map}\n"),
        None => "map       none\n".to_owned(),
    };
    for stop in &record.stops {
        text += &stop_line(stop);
    }
    let left_out = (run.stop_count as usize).saturating_sub(record.stops.len());
    if left_out > 0 {
        text += &format!("and {left_out} more stops\n");
    }
    if run.recordings.is_empty() {
        text += "not recorded\n";
    }
    for (place, recording) in run.recordings.iter().enumerate() {
        let size = match recording.bytes {
            Some(bytes) => format!("{:.1} MB", bytes as f64 / 1e6),
            None => "removed, newer ones took its place".to_owned(),
        };
        text += &format!("recording {}  {} ({size})\n", place + 1, recording.name);
    }
    text
}

fn stop_line(stop: &RunStop) -> String {
    let lasted = stop.lasted_s.map_or_else(
        || "until the end".to_owned(),
        |lasted_s| format!("for {}", span(lasted_s)),
    );
    let by = stop.by.as_ref().map_or_else(String::new, |by| format!(" ({by})"));
    let between = if stop.remedy.is_empty() { "" } else { " " };
    format!(
        "stop at {:>7}  {} {lasted}, at x {:.2} m, y {:.2} m: {}{between}{} ({}){by}\n",
        span(stop.at_s),
        stop.state,
        stop.place.x,
        stop.place.y,
        stop.text,
        stop.remedy,
        stop.reason
    )
}

/// A time as clocks here show it, with the name of the zone: a computer whose zone nobody has set shows another one.
pub(crate) fn when(utc_s: Option<i64>) -> String {
    when_in(utc_s, TimeZone::system())
}

fn when_in(utc_s: Option<i64>, zone: TimeZone) -> String {
    let time = utc_s.and_then(|utc_s| Timestamp::from_second(utc_s).ok());
    match time {
        Some(time) => time.to_zoned(zone).strftime("%Y-%m-%d %H:%M %Z").to_string(),
        None => "clock not set".to_owned(),
    }
}

fn span(seconds: f64) -> String {
    let seconds = seconds.max(0.0).round() as u64;
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3_600 => format!("{} min", seconds / 60),
        _ => format!("{} h {:02}", seconds / 3_600, seconds / 60 % 60),
    }
}

fn charge(run: &Run) -> String {
    let percent = |charge: f64| format!("{:.0}", 100.0 * charge);
    match (run.charge_start, run.charge_end) {
        (Some(start), Some(end)) => format!("{}-{} %", percent(start), percent(end)),
        _ => "-".to_owned(),
    }
}

fn job_name(job: &RunJob) -> &'static str {
    match job {
        RunJob::Clean {
            rooms,
            zones: 0,
            spots: 0,
            ..
        } if rooms.is_empty() => "clean",
        RunJob::Clean { .. } => "clean in",
        RunJob::Spot => "spot",
        RunJob::GoTo => "go",
        RunJob::Dock => "dock",
    }
}

fn job(job: &RunJob) -> String {
    let RunJob::Clean {
        strategy,
        rooms,
        zones,
        spots,
        passes,
    } = job
    else {
        return job_name(job).to_owned();
    };
    let mut parts: Vec<String> = rooms.iter().map(rvac_api::RoomHere::title).collect();
    match zones {
        0 => {}
        1 => parts.push("a zone".to_owned()),
        count => parts.push(format!("{count} zones")),
    }
    match spots {
        0 => {}
        1 => parts.push("a spot".to_owned()),
        count => parts.push(format!("{count} spots")),
    }
    if parts.is_empty() {
        parts.push("all".to_owned());
    }
    let times = match passes {
        1 => String::new(),
        times => format!(", {times} times"),
    };
    format!("clean {}{times}, {strategy}", parts.join(", "))
}

fn asker(by: &RunAsker) -> String {
    match by {
        RunAsker::Client(name) => name.clone(),
        RunAsker::Button => "the button on the robot".to_owned(),
        RunAsker::Schedule { number, name } => format!("schedule {number} ({name})"),
        RunAsker::Robot => "the robot itself".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::RunRecord;

    use jiff::tz::TimeZone;

    use super::{list, record, when_in};

    fn kept() -> RunRecord {
        let text = r#"{"run":{"number":7,"job":{"clean":{"strategy":"systematic","rooms":[{"id":2,"name":"Köök"}],
            "zones":1,"spots":2,"passes":2}},"by":{"schedule":{"number":3,"name":"Morning"}},"duration_s":3905.0,
            "moving_s":1800.0,"swept_m2":12.34,"share":0.955,"path_m":151.6,"bumps":12,"charge_start":0.98,
            "charge_end":0.71,"result":"gave-up","reason":"slip","text":"Gave up: its wheels slip.","stop_count":3,
            "map":12,"recordings":[{"name":"run-a.mcap","zero_s":1.0,"bytes":2500000},
            {"name":"run-b.mcap","zero_s":-60.0}]},
            "stops":[{"at_s":61.0,"lasted_s":12.0,"state":"paused","reason":"command","text":"Paused: it was requested.",
            "by":"panel","place":{"x":1.0,"y":-2.5,"heading":0.0,"t":3.0}}]}"#;
        serde_json::from_str(text).expect("is of the daemon's form")
    }

    #[test]
    fn a_run_is_shown_in_words() {
        assert_eq!(
            record(&kept()),
            "run 7: Gave up: its wheels slip.\nbegan     clock not set\nended     clock not set\n\
             order     clean Köök, a zone, 2 spots, 2 times, systematic, by schedule 3 (Morning)\n\
             time      1 h 05, 30 min of it in motion\ncleaned   12.3 m2, 96 % of that floor as its map tells\n\
             distance  152 m, 12 bumps\nbattery   98-71 %\nmap       version 12\n\
             stop at   1 min  paused for 12 s, at x 1.00 m, y -2.50 m: Paused: it was requested. (command) (panel)\n\
             and 2 more stops\nrecording 1  run-a.mcap (2.5 MB)\n\
             recording 2  run-b.mcap (removed, newer ones took its place)\n"
        );
    }

    #[test]
    fn a_time_says_in_which_zone_it_is() {
        let tallinn = TimeZone::get("Europe/Tallinn").expect("built in");
        assert_eq!(when_in(Some(1_764_500_400), tallinn), "2025-11-30 13:00 EET");
        assert_eq!(
            when_in(Some(1_764_500_400), TimeZone::UTC),
            "2025-11-30 11:00 UTC"
        );
        assert_eq!(when_in(None, TimeZone::UTC), "clock not set");
    }

    #[test]
    fn a_list_tells_how_to_see_older_ones() {
        assert!(list(&[], false).starts_with("no runs yet"));
        let text = list(&[kept().run], true);
        assert!(
            text.starts_with("7    clock not set        clean in   1 h 05  12.3 m2  98-71 %  Gave up"),
            "{text}"
        );
        assert!(text.ends_with("--before 7 shows older ones\n"), "{text}");
    }
}
