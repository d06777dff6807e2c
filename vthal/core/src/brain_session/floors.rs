//! On which floor the robot is: found out, said by a person, or lost.

use brain::mapping::StoredMap;
use brain::{Brain, Checkpoint, LoadedHome, StoreyPose};

use super::next_run::LoadingFloor;
use super::{BrainSession, Recorder};
use crate::edges::Sign;
use crate::floors::Floors;
use crate::storey_resolver::{Question, StoreyResolver};
use crate::{RunCause, RunEnd};

/// A wheel drop of this length means that somebody holds the robot.
const LIFTED_US: u64 = 1_000_000;

/// Whether hands had the robot since its floor was known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Hands {
    had_it: bool,
    /// Since when it is watched without a gap, microseconds.
    watched_us: Option<u64>,
}

impl Hands {
    /// The robot is at rest on a dock.
    fn rest(&mut self, hangs_since_us: Option<u64>) {
        if hangs_since_us.is_none() {
            self.watched_us = None;
        }
    }

    /// The robot may be held in hands. A wheel hangs since then, if one does.
    fn watch(&mut self, now_us: u64, hangs_since_us: Option<u64>) {
        let watched_us = *self.watched_us.get_or_insert(now_us);
        let is_held = |since_us: u64| now_us >= since_us.max(watched_us) + LIFTED_US;
        self.had_it |= hangs_since_us.is_some_and(is_held);
    }
}

/// What has become known of the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FloorNews {
    /// The robot is on the dock of this floor, whose map is loaded.
    Docked(u16),
    /// The robot has found itself on this floor, whose map is loaded.
    Found(u16),
    /// A person is asked.
    Asked(Question),
}

impl BrainSession {
    /// The floor on which the robot is, as far as that is known.
    pub(crate) fn floor(&self) -> Option<u16> {
        self.floor
    }

    /// Why a person is asked for the floor; `None` if no question is open.
    pub(crate) fn asked(&self) -> Option<Question> {
        self.storey_resolver
            .as_ref()
            .and_then(|storey_resolver| storey_resolver.asked)
    }

    /// Whether the floor is being searched.
    pub(crate) fn seeks_floor(&self) -> bool {
        self.floor.is_none() || self.storey_resolver.is_some()
    }

    /// Finds out on which floor the robot is: from the dock on which it is at rest, or from where it has driven. What it has drawn
    /// since, not knowing, is forgotten. To be called before each step.
    pub(crate) fn look_for_floor(
        &mut self,
        now_us: u64,
        floors: &Floors,
        recorder: &mut Recorder<'_>,
    ) -> Option<FloorNews> {
        let asked_before = self.asked();
        let loading_floor = self.loading_floor.take();
        let observation = self.observer.observation();
        if self.run.is_none() && observation.docked && observation.link_up {
            self.hands.rest(self.edges.since_us(Sign::WheelDrop));
            let news = self.know_dock(floors, loading_floor);
            return news.or_else(|| self.new_question(asked_before));
        }
        self.hands.watch(now_us, self.edges.since_us(Sign::WheelDrop));
        self.run?;
        let is_lost_among_several = self.brain.estimate().lost && floors.homes().nth(1).is_some();
        if self.floor.is_some() && !is_lost_among_several {
            self.storey_resolver = None;
            return None;
        }
        let storey_resolver = self.storey_resolver.get_or_insert_default();
        let seed = self.seed;
        match storey_resolver.follow(self.observer.observation(), (floors, &self.config, seed)) {
            // It has its map, and will find itself in it as well.
            Some(place) if self.floor == Some(place.floor) => None,
            Some(place) => {
                let home = floors.home(place.floor)?;
                let ready = self.home_of(loading_floor, (place.floor, home))?;
                self.move_to(now_us, (place, home, ready), recorder);
                Some(FloorNews::Found(place.floor))
            }
            None => self.new_question(asked_before),
        }
    }

    fn new_question(&self, before: Option<Question>) -> Option<FloorNews> {
        self.asked()
            .filter(|asked| before != Some(*asked))
            .map(FloorNews::Asked)
    }

    /// The robot is at rest on a dock.
    fn know_dock(&mut self, floors: &Floors, loading_floor: Option<LoadingFloor>) -> Option<FloorNews> {
        let docks = floors.homes().filter(|(_, home)| home.dock().is_some()).count();
        if self.floor.is_some() && self.hands.had_it && docks > 1 {
            self.forget_floor(None);
        }
        if self.floor.is_some() {
            return None;
        }
        let number = self.storey_resolver.get_or_insert_default().by_dock(floors)?;
        let home = self.home_of(loading_floor, (number, floors.home(number)?))?;
        self.begin_with(Brain::with_home(self.config, self.seed, home));
        self.change_floor(Some(number));
        self.storey_resolver = None;
        self.hands = Hands::default();
        Some(FloorNews::Docked(number))
    }

    /// The home of a floor; it takes some steps until it is ready.
    fn home_of(
        &mut self,
        loading_floor: Option<LoadingFloor>,
        floor: (u16, &StoredMap),
    ) -> Option<LoadedHome> {
        let mut floor = LoadingFloor::for_floor(loading_floor, floor, &self.config);
        let ready = floor.take();
        if ready.is_none() {
            self.loading_floor = Some(floor);
        }
        ready
    }

    /// The robot is at a place of a floor: its job continues there.
    fn move_to(
        &mut self,
        now_us: u64,
        (place, home, ready): (StoreyPose, &StoredMap, LoadedHome),
        recorder: &mut Recorder<'_>,
    ) {
        let checkpoint = Checkpoint {
            pose: place.pose,
            home: Some(home.clone()),
            tracking: Some(place.tracking),
            ..self.without_place()
        };
        self.go_on_with(now_us, (checkpoint, Some(ready)), recorder);
        self.change_floor(Some(place.floor));
        self.storey_resolver = None;
        self.hands = Hands::default();
    }

    /// What the brain is doing, without any map.
    fn without_place(&self) -> Checkpoint {
        let present = self.brain.checkpoint_without_home();
        Checkpoint {
            random_state: present.random_state,
            backed_m: present.backed_m,
            job: present.job,
            energy: present.energy,
            gyro: present.gyro,
            ..Checkpoint::default()
        }
    }

    fn go_on_with(
        &mut self,
        now_us: u64,
        (checkpoint, ready): (Checkpoint, Option<LoadedHome>),
        recorder: &mut Recorder<'_>,
    ) {
        if self.run.is_some() {
            self.end_run(now_us, RunEnd::Finished, recorder);
            self.begin_run(now_us, (RunCause::FloorFound, checkpoint, ready), recorder);
            self.prepare_anew();
        } else {
            self.map_base = self.map_number();
            self.begin_with(Brain::new(self.config, self.seed));
        }
    }

    /// The floor is not known any more, and what is known of it is not worth keeping; a person may have said which it is.
    fn forget_floor(&mut self, chosen: Option<u16>) {
        self.map_base = self.map_number();
        self.begin_with(Brain::new(self.config, self.seed));
        self.change_floor(None);
        self.storey_resolver = Some(chosen.map_or_else(StoreyResolver::default, StoreyResolver::for_floor));
    }

    /// A person says on which floor the robot is. Its map is loaded on the dock, or when the robot has found its position on it. A
    /// run that has nothing left to do ends before.
    pub(crate) fn choose_floor(&mut self, now_us: u64, number: u16, recorder: &mut Recorder<'_>) {
        if self.floor.is_none() && self.run.is_some() {
            self.storey_resolver = Some(StoreyResolver::for_floor(number));
        } else {
            self.end_run(now_us, RunEnd::Finished, recorder);
            self.forget_floor(Some(number));
        }
    }

    /// A person says that the robot is on a floor that is not stored. What it has drawn, not knowing where it was, is
    /// the map of this floor.
    pub(crate) fn begin_floor(&mut self, now_us: u64, number: u16, recorder: &mut Recorder<'_>) {
        if self.floor.is_some() {
            self.go_on_with(now_us, (self.without_place(), None), recorder);
        }
        self.change_floor(Some(number));
        self.storey_resolver = None;
        self.hands = Hands::default();
    }

    /// The map of a floor was replaced. If the robot is there, it is loaded when the robot is on its dock; a run that has nothing
    /// left to do ends before.
    pub(crate) fn offer(&mut self, now_us: u64, number: u16, recorder: &mut Recorder<'_>) {
        if self.floor.is_none_or(|floor| floor == number) {
            self.choose_floor(now_us, number, recorder);
        }
    }

    /// A floor was removed.
    pub(crate) fn lose_floor(&mut self, now_us: u64, number: u16, recorder: &mut Recorder<'_>) {
        let is_sought = self
            .storey_resolver
            .as_ref()
            .is_some_and(|storey_resolver| storey_resolver.chosen == Some(number));
        if self.floor == Some(number) || is_sought {
            self.end_run(now_us, RunEnd::Finished, recorder);
            self.forget_floor(None);
        }
    }
}
