//! A schedule while a person fills it in.

use rvac_api::{
    InQuiet, JobOrder, JobPart, PlaceShape, RequestBody, ScheduleEntry, ScheduleTime, ScheduleView,
    ScheduledJob, Weekday, name_problem,
};

use crate::clock_field::time_of_day;
use crate::job_settings::JobSettings;
use crate::kept_places::shape_text;
use crate::room_choice::PASSES_MAX;
use crate::words::Words;

/// The content of the fields.
#[derive(Clone, Debug, PartialEq)]
pub struct ScheduleForm {
    /// Number of the schedule that is changed; none for a new one.
    pub number: Option<u32>,
    /// Name.
    pub name: String,
    /// Time of day, as `07:30` or as it was typed.
    pub at: String,
    /// One day only: its date. Empty for days of the week.
    pub date: String,
    /// Whether it is for one day only.
    pub is_once: bool,
    /// Days of the week.
    pub days: Vec<Weekday>,
    /// Rooms, kept places, zones and spots in their order; none for the whole home.
    pub parts: Vec<JobPart>,
    /// How often each room is cleaned.
    pub passes: u8,
    /// Power and pattern.
    pub settings: JobSettings,
    /// How late it may start, minutes.
    pub late_min: u16,
    /// Whether it waits for the end of the quiet hours.
    pub waits: bool,
    /// The floor of its rooms; none for a new one, whose floor is that on which the robot is.
    pub floor: Option<u16>,
    enabled: bool,
    /// What it was when the change began.
    was: Option<Box<ScheduleEntry>>,
    /// What it starts, with all that these fields cannot say.
    job: ScheduledJob,
}

impl Default for ScheduleForm {
    fn default() -> Self {
        Self {
            number: None,
            name: String::new(),
            at: "09:30".to_owned(),
            date: String::new(),
            is_once: false,
            days: Weekday::ALL.into_iter().take(5).collect(),
            parts: Vec::new(),
            passes: 1,
            settings: JobSettings::default(),
            late_min: 0,
            waits: false,
            floor: None,
            enabled: true,
            was: None,
            job: ScheduledJob::Start { strategy: None },
        }
    }
}

impl ScheduleForm {
    /// The fields of a schedule that is there.
    #[must_use]
    pub fn of(view: &ScheduleView) -> Self {
        let entry = &view.entry;
        let (is_once, days, date, at) = match &entry.when {
            ScheduleTime::Weekly { days, at } => (false, days.clone(), String::new(), at),
            ScheduleTime::Once { date, at } => (true, Vec::new(), date.clone(), at),
        };
        let (parts, passes) = parts_of(&entry.job);
        Self {
            number: Some(view.number),
            name: entry.name.clone(),
            at: at.clone(),
            date,
            is_once,
            days,
            parts,
            passes,
            settings: settings_of(&entry.job),
            late_min: entry.late_min,
            waits: entry.in_quiet == InQuiet::Wait,
            floor: entry.floor,
            enabled: entry.enabled,
            was: Some(Box::new(entry.clone())),
            job: entry.job.clone(),
        }
    }

    /// Takes a day in, or out.
    pub fn toggle_day(&mut self, day: Weekday) {
        if self.days.contains(&day) {
            self.days.retain(|chosen| *chosen != day);
        } else {
            self.days.push(day);
            self.days.sort_unstable();
        }
    }

    /// Takes a part in as the last one, or out.
    pub fn toggle_part(&mut self, part: JobPart) {
        if self.parts.contains(&part) {
            self.parts.retain(|chosen| *chosen != part);
        } else {
            self.parts.push(part);
        }
    }

    /// Zones and spots that were drawn elsewhere: they can only be taken out.
    #[must_use]
    pub fn drawn(&self, words: &Words) -> Vec<(JobPart, String)> {
        let drawn = |part: &JobPart| {
            let shape = match part {
                JobPart::Zone(corners) => PlaceShape::Zone(corners.clone()),
                JobPart::Spot(middle) => PlaceShape::Spot(*middle),
                JobPart::Room(_) | JobPart::Place(_) => return None,
            };
            Some((part.clone(), shape_text(words, &shape)))
        };
        self.parts.iter().filter_map(drawn).collect()
    }

    /// The person has seen what somebody else has made of it, and keeps what is filled in.
    pub fn keep_mine(&mut self, theirs: &ScheduleView) {
        self.was = Some(Box::new(theirs.entry.clone()));
        // Whether it starts by itself is no field of the form: the last word on it stands.
        self.enabled = theirs.entry.enabled;
    }

    /// What is asked of the daemon.
    ///
    /// # Errors
    /// A sentence that says what is missing.
    pub fn request(&self, words: &Words) -> Result<RequestBody, &'static str> {
        let entry = self.entry(words)?;
        Ok(match self.number {
            Some(number) => RequestBody::ChangeSchedule {
                number,
                entry,
                was: self.was.clone(),
            },
            None => RequestBody::AddSchedule(entry),
        })
    }

    fn entry(&self, words: &Words) -> Result<ScheduleEntry, &'static str> {
        let texts = &words.schedule;
        if self.name.trim().is_empty() {
            return Err(texts.need_name);
        }
        if name_problem(&self.name).is_some() {
            return Err(texts.bad_name);
        }
        let at = time_of_day(&self.at).ok_or(texts.need_time)?;
        let when = match (self.is_once, self.date.is_empty(), self.days.is_empty()) {
            (true, true, _) => return Err(texts.need_date),
            (false, _, true) => return Err(texts.need_days),
            (true, ..) => ScheduleTime::Once {
                date: self.date.clone(),
                at,
            },
            (false, ..) => ScheduleTime::Weekly {
                days: self.days.clone(),
                at,
            },
        };
        let job = self.job();
        // Other parts can be chosen only while the robot is on this floor.
        let is_bound = job.names_places() || job == self.job;
        Ok(ScheduleEntry {
            name: self.name.trim().to_owned(),
            enabled: self.enabled,
            job,
            when,
            late_min: self.late_min,
            in_quiet: if self.waits {
                InQuiet::Wait
            } else {
                InQuiet::Refuse
            },
            floor: self.floor.filter(|_| is_bound),
        })
    }

    /// Places to keep out of stay as they are, and strategies as long as no parts are chosen.
    fn job(&self) -> ScheduledJob {
        let passes = self.passes.clamp(1, PASSES_MAX);
        let is_same = (self.parts.clone(), passes) == parts_of(&self.job);
        if is_same && self.settings == settings_of(&self.job) {
            return self.job.clone();
        }
        let known = match &self.job {
            ScheduledJob::Clean(order) => order.clone(),
            ScheduledJob::Start { .. } => JobOrder::default(),
        };
        let order = JobOrder {
            parts: self.parts.clone(),
            passes,
            ..known
        };
        let order = self.settings.said_by(order);
        if order == JobOrder::default() {
            return ScheduledJob::Start { strategy: None };
        }
        ScheduledJob::Clean(order)
    }
}

fn settings_of(job: &ScheduledJob) -> JobSettings {
    match job {
        ScheduledJob::Start { .. } => JobSettings::default(),
        ScheduledJob::Clean(order) => JobSettings::of(order),
    }
}

fn parts_of(job: &ScheduledJob) -> (Vec<JobPart>, u8) {
    match job {
        ScheduledJob::Start { .. } => (Vec::new(), 1),
        ScheduledJob::Clean(order) => (order.parts.clone(), order.passes),
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::{
        CleaningPower, InQuiet, JobOrder, JobPart, RequestBody, ScheduleEntry, ScheduleTime, ScheduleView,
        ScheduledJob, Weekday,
    };

    use super::ScheduleForm;
    use crate::words::{Language, Words};

    const ENGLISH: &Words = Language::English.words();

    fn filled() -> ScheduleForm {
        ScheduleForm {
            name: " Kitchen ".to_owned(),
            at: "730".to_owned(),
            ..ScheduleForm::default()
        }
    }

    #[test]
    fn what_is_missing_is_said() {
        let missing = |form: ScheduleForm| form.request(ENGLISH).expect_err("is not whole");
        assert_eq!(missing(ScheduleForm::default()), "Give it a name.");
        let mut no_days = filled();
        no_days.days.clear();
        assert_eq!(missing(no_days), "Choose at least one day of the week.");
        let once = ScheduleForm {
            is_once: true,
            ..filled()
        };
        assert_eq!(missing(once), "Choose the day on which it starts.");
    }

    #[test]
    fn a_new_one_for_rooms_is_asked_for() {
        let mut form = filled();
        for room in [4, 2, 7, 4] {
            form.toggle_part(JobPart::Room(room));
        }
        form.toggle_day(Weekday::Su);
        form.toggle_day(Weekday::Mo);
        form.waits = true;
        let Ok(RequestBody::AddSchedule(entry)) = form.request(ENGLISH) else {
            panic!("is whole");
        };
        let parts = vec![JobPart::Room(2), JobPart::Room(7)];
        assert_eq!(
            entry,
            ScheduleEntry {
                name: "Kitchen".to_owned(),
                enabled: true,
                job: ScheduledJob::Clean(JobOrder {
                    parts,
                    ..JobOrder::default()
                }),
                when: ScheduleTime::Weekly {
                    days: vec![Weekday::Tu, Weekday::We, Weekday::Th, Weekday::Fr, Weekday::Su],
                    at: "07:30".to_owned(),
                },
                late_min: 0,
                in_quiet: InQuiet::Wait,
                floor: None,
            }
        );
    }

    #[test]
    fn what_the_fields_cannot_say_is_not_lost() {
        let job = ScheduledJob::Clean(JobOrder {
            parts: vec![
                JobPart::Zone(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]),
                JobPart::Spot([1.0, 2.0]),
            ],
            passes: 2,
            ..JobOrder::default()
        });
        let entry = ScheduleEntry {
            job: job.clone(),
            enabled: false,
            floor: Some(2),
            ..match filled().request(ENGLISH) {
                Ok(RequestBody::AddSchedule(entry)) => entry,
                other => panic!("{other:?}"),
            }
        };
        let mut form = ScheduleForm::of(&ScheduleView {
            number: 3,
            entry: entry.clone(),
            skip_next: false,
            next: vec![],
            refused_now: None,
        });
        assert_eq!(
            form.request(ENGLISH),
            Ok(RequestBody::ChangeSchedule {
                number: 3,
                entry: entry.clone(),
                was: Some(Box::new(entry.clone())),
            })
        );
        form.settings.choose_power("quiet");
        let Ok(RequestBody::ChangeSchedule { entry, .. }) = form.request(ENGLISH) else {
            panic!("is whole");
        };
        let ScheduledJob::Clean(order) = &entry.job else {
            panic!("cleans parts");
        };
        assert_eq!(order.power, Some(CleaningPower::QUIET));
        assert_eq!(order.parts.len(), 2, "zone and spot are still there");
        assert_eq!(entry.floor, Some(2));
        form.toggle_part(JobPart::Room(2));
        form.toggle_part(JobPart::Place(9));
        assert_eq!(form.drawn(ENGLISH).len(), 2);
        form.toggle_part(JobPart::Spot([1.0, 2.0]));
        let Ok(RequestBody::ChangeSchedule { entry, .. }) = form.request(ENGLISH) else {
            panic!("is whole");
        };
        let zone = job.places().0[0].clone();
        assert_eq!(entry.job.places().0, [zone, JobPart::Room(2), JobPart::Place(9)]);
        assert_eq!(entry.floor, Some(2));
    }
    #[test]
    fn what_somebody_else_has_changed_meanwhile_is_seen_and_then_replaced() {
        let view = |name: &str, enabled: bool| ScheduleView {
            number: 3,
            entry: ScheduleEntry {
                name: name.to_owned(),
                enabled,
                ..match filled().request(ENGLISH) {
                    Ok(RequestBody::AddSchedule(entry)) => entry,
                    other => panic!("{other:?}"),
                }
            },
            skip_next: false,
            next: vec![],
            refused_now: None,
        };
        let (ours, theirs) = (view("Ours", false), view("Theirs", true));
        let mut form = ScheduleForm::of(&ours);
        let saved = |form: &ScheduleForm| match form.request(ENGLISH) {
            Ok(RequestBody::ChangeSchedule { entry, was, .. }) => (entry, was.map(|was| *was)),
            other => panic!("{other:?}"),
        };
        assert_eq!(saved(&form).1, Some(ours.entry.clone()));
        form.keep_mine(&theirs);
        let (entry, was) = saved(&form);
        assert_eq!(was, Some(theirs.entry));
        assert_eq!(entry.name, "Ours");
        assert!(entry.enabled, "the last word on that stands");
    }
}
