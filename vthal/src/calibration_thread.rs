//! Calibration of the robot, on a thread of its own: the procedure waits for the robot and for the person as if at a terminal.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{self, Receiver};

use calibration::{
    CalibrationError, Danger, Hold, Plan, Question, Robot, RobotEvent, Screen, Shown, Side, Task, walk,
};
use calibration_values::{Catalog, Measurements, ValuesError};
use rvac_api::{CalibrationAnswer, CalibrationAsk, CalibrationPage, CalibrationValue};
use tokio::sync::mpsc::Sender;

use crate::event::Event;

/// From the thread.
#[derive(Debug)]
pub(crate) enum CalibrationEvent {
    /// Bytes for the robot.
    Bytes(Vec<u8>),
    /// What the client sees.
    Page(Box<CalibrationPage>),
    /// It has ended, and the robot is stopped.
    Over(Box<CalibrationPage>),
}

/// What is measured, and where it is kept.
#[derive(Debug)]
pub(crate) struct CalibrationJob {
    /// Name of the robot.
    pub(crate) device: String,
    /// Names of the values; none = all that are missing.
    pub(crate) names: Vec<String>,
    /// The file.
    pub(crate) file: PathBuf,
}

/// The thread's other end.
#[derive(Debug)]
pub(crate) struct CalibrationHandle {
    to_procedure: mpsc::Sender<RobotEvent>,
    page: Arc<AtomicU32>,
}

impl CalibrationHandle {
    /// Begins.
    ///
    /// # Errors
    /// No thread.
    pub(crate) fn start(job: CalibrationJob, events: Sender<Event>) -> io::Result<Self> {
        let (to_procedure, inbox) = mpsc::channel();
        let page = Arc::new(AtomicU32::new(0));
        let mut pages = Pages {
            events: events.clone(),
            count: Arc::clone(&page),
            shown: CalibrationPage::default(),
        };
        std::thread::Builder::new()
            .name("calibration".to_owned())
            .spawn(move || {
                let outcome = calibrate(job, inbox, &mut pages);
                let mut last = CalibrationPage {
                    page: pages.count.load(Ordering::Relaxed),
                    over: true,
                    ..CalibrationPage::default()
                };
                if let Err(error) = outcome {
                    last.reason = Some(error.reason().to_owned());
                    last.text = error.to_string();
                }
                // The daemon is gone when nobody takes it.
                let over = Event::Calibration(CalibrationEvent::Over(Box::new(last)));
                events.blocking_send(over).ok();
            })?;
        Ok(Self { to_procedure, page })
    }

    /// What happens goes to the procedure; one that has just ended takes nothing more.
    pub(crate) fn tell(&self, event: RobotEvent) {
        self.to_procedure.send(event).ok();
    }

    /// An answer of the person, unless it is to an earlier page; whether it was taken.
    pub(crate) fn answer(&self, page: u32, answer: CalibrationAnswer) -> bool {
        let is_current = self
            .page
            .compare_exchange(page, page + 1, Ordering::Relaxed, Ordering::Relaxed)
            .is_ok();
        if is_current {
            self.tell(RobotEvent::Typed(match answer {
                CalibrationAnswer::Go => String::new(),
                CalibrationAnswer::Again => "a".to_owned(),
                CalibrationAnswer::Skip => "s".to_owned(),
                CalibrationAnswer::Number(number) => number.to_string(),
            }));
        }
        is_current
    }
}

/// All values of a robot, with what the file holds of them, and the file as text.
pub(crate) fn measured(device: &str, file: &Path) -> Result<(Vec<CalibrationValue>, String), ValuesError> {
    let catalog = Catalog::of(device)?;
    let measured = Measurements::open(file, &catalog)?;
    let values = catalog.items.iter().map(|item| CalibrationValue {
        name: item.name.clone(),
        unit: item.unit.clone(),
        value: measured.get(&item.name),
        assumed: item.assumed,
    });
    Ok((values.collect(), measured.text(&catalog)))
}

fn calibrate(
    job: CalibrationJob,
    inbox: Receiver<RobotEvent>,
    pages: &mut Pages,
) -> Result<(), CalibrationError> {
    let catalog = Catalog::of(&job.device)?;
    let measured = Measurements::open(&job.file, &catalog)?;
    let mut plan = Plan {
        catalog,
        measured,
        names: job.names,
    };
    let to_robot = Box::new(ToRobot(pages.events.clone()));
    let mut robot = Robot::open(to_robot, inbox, Hold::Asked)?;
    let outcome = walk(&mut robot, &mut plan, pages);
    // Whatever went wrong, nothing is left running.
    robot.stop().ok();
    outcome
}

struct ToRobot(Sender<Event>);

impl Write for ToRobot {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let event = Event::Calibration(CalibrationEvent::Bytes(bytes.to_vec()));
        self.0
            .blocking_send(event)
            .map_err(|_gone| io::Error::from(io::ErrorKind::BrokenPipe))?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Pages for the client.
struct Pages {
    events: Sender<Event>,
    count: Arc<AtomicU32>,
    shown: CalibrationPage,
}

impl Pages {
    /// A question is a page of its own.
    fn ask(&mut self, asks: CalibrationAsk) {
        self.shown.page = self.count.fetch_add(1, Ordering::Relaxed) + 1;
        self.shown.asks = Some(asks);
    }

    /// Only what is of the value stays from page to page.
    fn clean(&mut self) {
        let CalibrationPage {
            value,
            unit,
            number,
            of,
            kept,
            danger,
            ..
        } = std::mem::take(&mut self.shown);
        self.shown = CalibrationPage {
            page: self.count.load(Ordering::Relaxed),
            value,
            unit,
            number,
            of,
            kept,
            danger,
            ..CalibrationPage::default()
        };
    }
}

impl Screen for Pages {
    fn show(&mut self, shown: Shown<'_>) -> Result<(), CalibrationError> {
        match shown {
            Shown::Counts { left, right } => self.shown.counts = Some([left, right]),
            Shown::Progress { done, of, reading } => {
                self.clean();
                self.shown.reading = Some(reading);
                self.shown.percent = u8::try_from(done * 100 / of.max(1)).ok();
            }
            Shown::Duty(permille) => {
                self.clean();
                self.shown.permille = Some(permille);
            }
            // The note is of the question that follows.
            Shown::Note(_) => return Ok(()),
            other => {
                self.clean();
                self.take(other);
            }
        }
        let page = Event::Calibration(CalibrationEvent::Page(Box::new(self.shown.clone())));
        self.events
            .blocking_send(page)
            .map_err(|_gone| CalibrationError::NobodyLeft)
    }
}

impl Pages {
    fn take(&mut self, shown: Shown<'_>) {
        match shown {
            Shown::Value {
                number,
                of,
                item,
                kept,
            } => {
                self.shown.danger = None;
                self.shown.value = item.name.clone();
                self.shown.unit = item.unit.clone();
                self.shown.number = u32::try_from(number).unwrap_or(u32::MAX);
                self.shown.of = u32::try_from(of).unwrap_or(u32::MAX);
                self.shown.kept = kept;
            }
            Shown::Ready(danger) => {
                self.ask(CalibrationAsk::Ready);
                self.shown.danger = danger.map(|danger| name_of_danger(danger).to_owned());
            }
            Shown::Do(task) => {
                self.ask(CalibrationAsk::Done);
                self.shown.task = Some(name_of_task(task).to_owned());
                if let Task::Paper { number, .. } = task {
                    self.shown.sensor = u32::try_from(number).ok();
                }
            }
            Shown::Ask(question) => {
                self.ask(CalibrationAsk::Number);
                self.shown.task = Some(name_of_question(question).to_owned());
            }
            Shown::HoldOn => self.ask(CalibrationAsk::Hold),
            Shown::Keep { value, .. } => {
                self.ask(CalibrationAsk::Keep);
                self.shown.found = Some(value);
                self.shown.danger = None;
            }
            Shown::Failed(error) => {
                self.ask(CalibrationAsk::Retry);
                self.shown.reason = Some(error.reason().to_owned());
                self.shown.text = error.to_string();
            }
            Shown::Malformed(line) => self.shown.text = format!("{line:?} is no answer."),
            Shown::Kept { value, .. } => self.shown.kept = Some(value),
            Shown::NotNeeded
            | Shown::Counts { .. }
            | Shown::Progress { .. }
            | Shown::Duty(_)
            | Shown::Note(_) => {}
        }
    }
}

const fn name_of_danger(danger: Danger) -> &'static str {
    match danger {
        Danger::Moves => "moves",
        Danger::Pulls => "pulls",
        Danger::Brush => "brush",
    }
}

const fn name_of_task(task: Task) -> &'static str {
    match task {
        Task::Push => "push",
        Task::Spin => "spin",
        Task::Roll(Side::Left) => "roll-left",
        Task::Roll(Side::Right) => "roll-right",
        Task::LightFloor => "light-floor",
        Task::DarkFloor => "dark-floor",
        Task::Drop => "drop",
        Task::FreeFront => "free-front",
        Task::Paper { .. } => "paper",
        Task::HoldWheelRead => "hold-wheel-read",
        Task::HoldWheel => "hold-wheel",
    }
}

const fn name_of_question(question: Question<'_>) -> &'static str {
    match question {
        Question::DistanceMm => "distance-mm",
        Question::AtRestMa => "at-rest-ma",
        Question::PulledMa => "pulled-ma",
        Question::PackMv => "pack-mv",
        Question::RoomDc => "room-dc",
        Question::Value(_) => "value",
    }
}
