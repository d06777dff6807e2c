//! Single bits that flip in memory and registers while the robot stands, drives, cleans or charges (S21).
//!
//! Each flip is tried from a snapshot. The bit flips at the beginning of a millisecond (each course has another phase
//! between the core and the surroundings' milliseconds). At most 150 ms later an event requires motors or charger to be
//! off, and the monitor observes for longer than the watchdog's time. Bytes that the robot does not read in this time
//! without the flip are not tried, because they cannot change the program's path. Instructions that it executes neither
//! in this time nor after a reset are not tried either: the running check of the image finds them. As a check, one in
//! fifty of both is tried.

mod course;
mod idle_code;
mod place;

use std::collections::{BTreeMap, HashSet};

use home::Pcg;
use pic32::image::{Image, SymbolKind};
use rvac_protocol::message::Inhibit;
use serde::Serialize;

pub use course::{Fate, Situation};
pub use place::{BitLocation, BitStorage};

use crate::testbed::{Fixture, TestbedError};
use course::{Course, FLIP_MS};
use idle_code::idle_code;
use place::BitLocations;

const DRAWS: u64 = 0xF11B;
/// Of the flips that need not be tried, one in this many is tried as a check.
const CHECKED_EACH: u32 = 50;
/// A flipped bit in flash must be found within this time, ms: the image is checked every ten seconds.
const FOUND_MS: u64 = 13_000;
/// A chip with this many resets in that time does not get beyond its start-up code.
const STARTS_OVER: u64 = 10;

/// How a campaign is drawn.
#[derive(Clone, Copy, Debug)]
pub struct FlipPlan {
    /// Flips.
    pub count: u32,
    /// Seed of all random choices.
    pub seed: u64,
    /// Courses of each situation.
    pub courses: usize,
    /// Flips in flash that are left until the check of the image must have found them.
    pub image_checks: u32,
}

/// A flip that broke a rule.
#[derive(Clone, Debug, Serialize)]
pub struct Breach {
    /// When the bit flipped.
    pub situation: Situation,
    /// Number of the course.
    pub course: usize,
    /// Millisecond of the course.
    pub at_ms: usize,
    /// The bit.
    pub place: BitLocation,
    /// The function or variable that it belongs to.
    pub name: String,
    /// Its result.
    pub fate: Fate,
    /// For how long a rule was broken, ms.
    pub broken_ms: u32,
    /// The first breach.
    pub breach: String,
}

/// A flip of flash that was not reported in time.
#[derive(Clone, Debug, Serialize)]
pub struct Unreported {
    /// Which bit.
    pub place: BitLocation,
    /// The function or variable that it belongs to.
    pub name: String,
    /// Resets of the chip since the flip.
    pub resets: u64,
    /// Whether motors and charger were off at the end.
    pub is_off: bool,
}

/// Results of a campaign.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FlipTally {
    /// Flips.
    pub flips: u32,
    /// Flips that were tried in the emulator; the results of the others are certain.
    pub tried: u32,
    /// Flips by storage and fate.
    pub fates: BTreeMap<BitStorage, BTreeMap<Fate, u32>>,
    /// Flips by situation and fate.
    pub situations: BTreeMap<Situation, BTreeMap<Fate, u32>>,
    /// Certain flips that were tried as a check, and how many of them had another result.
    pub foreseen_checked: (u32, u32),
    /// Flips of flash that were left until the check of the image had to find them.
    pub image_checked: u32,
    /// Those of them in the start-up code, which the robot could not report: the check found them, and the chip
    /// restarts repeatedly, with motors and charger off.
    pub starting_over: Vec<Unreported>,
    /// Those of them that were neither reported nor ended the program.
    pub image_missed: Vec<Unreported>,
    /// Flips that broke a rule.
    pub breaches: Vec<Breach>,
}

impl FlipTally {
    /// Flips with this fate.
    #[must_use]
    pub fn of(&self, fate: Fate) -> u32 {
        self.fates.values().filter_map(|fates| fates.get(&fate)).sum()
    }

    /// Whether no result is unexplained.
    #[must_use]
    pub fn is_safe(&self) -> bool {
        self.of(Fate::Unsafe) == 0 && self.foreseen_checked.1 == 0 && self.image_missed.is_empty()
    }

    fn count(&mut self, situation: Situation, storage: BitStorage, fate: Fate) {
        self.flips += 1;
        *self.fates.entry(storage).or_default().entry(fate).or_default() += 1;
        *self
            .situations
            .entry(situation)
            .or_default()
            .entry(fate)
            .or_default() += 1;
    }
}

/// Flips bits. Calls `progress` with the tally after each course.
///
/// # Errors
/// When the robot does not get into a situation without any fault.
pub fn flip_bits(
    fixture: &Fixture,
    plan: &FlipPlan,
    mut progress: impl FnMut(&FlipTally),
) -> Result<FlipTally, TestbedError> {
    let mut random = Pcg::new(plan.seed, DRAWS);
    let mut tally = FlipTally::default();
    let all = plan.courses * Situation::ALL.len();
    let idle_code = idle_code(fixture)?;
    for number in 0..all {
        let Some(situation) = Situation::ALL.get(number % Situation::ALL.len()) else {
            continue;
        };
        let variables_end = variables_end(fixture.image());
        let mut places = None;
        let course = Course::live(fixture, *situation, number / Situation::ALL.len(), |machine| {
            let found = BitLocations::of(machine, variables_end);
            places.insert(found).chip().to_vec()
        })?;
        let Some(places) = places else { continue };
        let ground = FlipContext {
            image: fixture.image(),
            course: &course,
            places: &places,
            idle_code: &idle_code,
        };
        let share = |number: usize| (u64::from(plan.count) * number as u64 / all as u64) as u32;
        for _ in share(number)..share(number + 1) {
            ground.flip_one(&mut random, &mut tally);
        }
        if number == 0 {
            ground.check_image(plan.image_checks, &mut random, &mut tally);
        }
        progress(&tally);
    }
    Ok(tally)
}

/// A course and the bits that can flip in it.
struct FlipContext<'a> {
    image: &'a Image,
    course: &'a Course,
    places: &'a BitLocations,
    idle_code: &'a HashSet<u32>,
}

impl FlipContext<'_> {
    /// The result of a flip that is certain without trying it.
    fn foreseen(&self, place: BitLocation, at_ms: usize) -> Option<Fate> {
        let is_only_checked = self.idle_code.contains(&place.address) && !self.course.executes(place);
        match self.course.foreseen(place, at_ms) {
            None if place.storage == BitStorage::Flash && is_only_checked => Some(Fate::Detected),
            foreseen => foreseen,
        }
    }

    fn flip_one(&self, random: &mut Pcg, tally: &mut FlipTally) {
        let course = self.course;
        let place = self.places.draw(random);
        let at_ms = random.below(FLIP_MS as u32) as usize;
        let is_checked = random.below(CHECKED_EACH) == 0;
        let foreseen = self.foreseen(place, at_ms);
        if let (Some(fate), false) = (foreseen, is_checked) {
            tally.count(course.situation, place.storage, fate);
            return;
        }
        tally.tried += 1;
        let trace = course.try_out(place, at_ms);
        if let Some(foreseen) = foreseen {
            let expected = match foreseen {
                Fate::Detected => Fate::Detected,
                _ => Fate::Masked,
            };
            tally.foreseen_checked.0 += 1;
            tally.foreseen_checked.1 += u32::from(trace.fate != expected);
        }
        let fate = match trace.fate {
            Fate::Masked => foreseen.unwrap_or(Fate::Masked),
            fate => fate,
        };
        tally.count(course.situation, place.storage, fate);
        if let Some(breach) = trace.breach {
            tally.breaches.push(Breach {
                situation: course.situation,
                course: course.number(),
                at_ms,
                place,
                name: name_of(self.image, place),
                fate,
                broken_ms: trace.broken_ms,
                breach,
            });
        }
    }

    /// Waits until the robot reports a flipped bit; returns the state of the robot if it does not.
    fn leave(&self, place: BitLocation) -> Option<Unreported> {
        let mut testbed = self.course.first()?;
        let resets = testbed.robot().machine().reset_count();
        place.flip(testbed.robot_mut().machine_mut());
        for _ in 0..FOUND_MS {
            testbed.tick();
            if testbed.inhibits().contains(Inhibit::Memory) {
                return None;
            }
        }
        Some(Unreported {
            place,
            name: name_of(self.image, place),
            resets: testbed.robot().machine().reset_count() - resets,
            is_off: course::is_off(&testbed),
        })
    }

    /// Waits until the robot has found flipped bits of flash.
    fn check_image(&self, mut left: u32, random: &mut Pcg, tally: &mut FlipTally) {
        while left > 0 {
            let place = self.places.draw(random);
            // What is behind the image is no part of it: the calibration record has a check of its own, at the start.
            if !place.is_in_image() || self.course.foreseen(place, 0) != Some(Fate::Untouched) {
                continue;
            }
            left -= 1;
            tally.image_checked += 1;
            if let Some(unreported) = self.leave(place) {
                let starts_over = unreported.is_off && unreported.resets >= STARTS_OVER;
                let list = if starts_over {
                    &mut tally.starting_over
                } else {
                    &mut tally.image_missed
                };
                list.push(unreported);
            }
        }
    }
}

/// Where the program's variables end, physical.
fn variables_end(image: &Image) -> u32 {
    let variables = image.symbols().iter().filter(|symbol| {
        symbol.kind == SymbolKind::Object && (0x8000_0000..0x8000_8000).contains(&symbol.address)
    });
    let end = variables.map(|symbol| symbol.address + symbol.size).max();
    (end.unwrap_or(0x8000_8000) & 0xFFFF).next_multiple_of(4)
}

/// The function or variable that the bit belongs to.
fn name_of(image: &Image, place: BitLocation) -> String {
    let segment = match place.storage {
        BitStorage::Ram | BitStorage::Flash => 0x8000_0000,
        BitStorage::Core | BitStorage::Chip => {
            return format!("{} {:#x}", place.storage.name(), place.address);
        }
    };
    let address = segment + place.address;
    let holds = |start: u32, size: u32| (start..start + size.max(4)).contains(&address);
    let found = image
        .symbols()
        .iter()
        .find(|symbol| symbol.kind != SymbolKind::Plain && holds(symbol.address, symbol.size));
    found.map_or_else(|| format!("{address:#010x}"), |symbol| symbol.name.clone())
}
