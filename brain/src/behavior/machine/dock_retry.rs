//! When a run retries from its dock, [`DockRetry`].

use super::Behavior;
use crate::behavior::dock_retry::DockRetry;
use crate::behavior::job::Job;
use crate::behavior::parameters::CHARGING;
use crate::model::reason::Reason;
use crate::navigation::Situation;

impl Behavior {
    /// Whether the running job, which ends for this reason, retries from the dock.
    pub(super) fn retries_from_dock(&mut self, reason: Reason, situation: &Situation<'_>) -> bool {
        let has_left_much = self
            .swept_share(situation.map)
            .is_some_and(|swept| 1.0 - swept.share > CHARGING.retry_left_share);
        let Some(job) = &mut self.job else { return false };
        let retries = reason == Reason::RestOutOfReach
            && has_left_much
            && (!situation.is_tracked || job.task.is_floor_shut_off())
            && situation.map.dock().is_some()
            && job.order.is_for_whole_home()
            && job.dock_retry == DockRetry::NotYet;
        if retries {
            job.dock_retry = DockRetry::Due;
        }
        retries
    }

    /// Whether the job returned to the dock only to retry.
    pub(super) fn is_retry_due(&self) -> bool {
        let is_due = |job: &Job| job.dock_retry == DockRetry::Due;
        self.job.as_ref().is_some_and(is_due)
    }

    /// Whether such a job has waited long enough, and has enough charge to resume.
    pub(super) fn may_retry(&self, situation: &Situation<'_>) -> bool {
        let wait_us = if situation.is_tracked {
            CHARGING.retry_wait_us
        } else {
            0
        };
        let has_waited = self
            .home_us
            .is_none_or(|home_us| self.facts.now_us >= home_us + wait_us);
        let charge = situation.observation.battery_charge;
        self.is_retry_due() && has_waited && charge.is_some_and(|charge| charge >= CHARGING.retry_charge)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Mode;
    use super::{Behavior, Job, Reason};
    use crate::behavior::{BehaviorState, JobFigures, JobKind};
    use crate::mapping::{BeamMemory, Cell, CellKnowledge, Map, Raster, StoredMap, SweptRun};
    use crate::model::action::Motion;
    use crate::model::advance::Advance;
    use crate::model::command::StrategyName;
    use crate::model::config::BrainConfig;
    use crate::model::geometry::Pose2;
    use crate::model::observation::Observation;
    use crate::model::pose_estimate::PoseEstimate;
    use crate::model::random::Random;
    use crate::model::swept_share::SweptShare;
    use crate::navigation::{Situation, Task, TaskContext, TaskStatus};

    /// A job that has swept this share and gets no further.
    #[derive(Debug)]
    struct AtItsEnd {
        share: f64,
        /// What came into the way since the job began shuts off the rest.
        is_floor_shut_off: bool,
    }

    impl Task for AtItsEnd {
        fn step(&mut self, _: &Situation<'_>, _: &mut TaskContext) -> TaskStatus {
            TaskStatus::Finished(Reason::RestOutOfReach)
        }

        fn interrupted(&mut self) {}

        fn is_floor_shut_off(&self) -> bool {
            self.is_floor_shut_off
        }

        fn looks_again(&mut self) {
            self.is_floor_shut_off = false;
        }

        fn swept_share(&self, _: &Map) -> Option<SweptShare> {
            Some(SweptShare {
                share: self.share,
                share_low: self.share,
                left_m2: 40.0 * (1.0 - self.share),
            })
        }
    }

    /// A robot at work in a home with a known dock.
    struct Stage {
        behavior: Behavior,
        mind: TaskContext,
        map: Map,
        observation: Observation,
        is_tracked: bool,
    }

    impl Stage {
        /// On a first run, which has swept this share.
        fn with_swept(share: f64) -> Self {
            let task = AtItsEnd {
                share,
                is_floor_shut_off: false,
            };
            Self::with(task, false)
        }

        /// In a known home, of which it has swept this share.
        fn in_known_home(share: f64, is_floor_shut_off: bool) -> Self {
            let task = AtItsEnd {
                share,
                is_floor_shut_off,
            };
            Self::with(task, true)
        }

        fn with(task: AtItsEnd, is_tracked: bool) -> Self {
            let config = BrainConfig::of_tests();
            let floor = Raster::filled(Cell { x: 0, y: 0 }, 80, 80, CellKnowledge::Free);
            let mut map = Map::new(config.body, config.sensors);
            map.load(&StoredMap::from_raster(&floor, Some(Pose2::IDENTITY)));
            let swept_rows = (0..(80.0 * task.share) as i32).map(|y| SweptRun {
                start: Cell { x: 0, y },
                length: 80,
            });
            map.restore(&swept_rows.collect::<Vec<_>>(), &[], &[]);
            let mut behavior = Behavior::new(config);
            behavior.mode = Mode::Working;
            behavior.job = Some(Job {
                task: Box::new(task),
                ..Job::new(JobKind::Clean(StrategyName::Systematic), JobFigures::default())
            });
            Self {
                behavior,
                mind: TaskContext {
                    random: Random::new(1),
                    journal: Vec::new(),
                },
                map,
                observation: Observation::default(),
                is_tracked,
            }
        }

        /// One step of the job, or of the wait for charge; gives the state after it.
        fn step(
            &mut self,
            step: fn(&mut Behavior, &Situation<'_>, &mut TaskContext),
        ) -> (BehaviorState, Reason) {
            let (config, beams) = (BrainConfig::of_tests(), BeamMemory::default());
            let situation = Situation {
                observation: &self.observation,
                advance: Advance::default(),
                pose: Pose2::IDENTITY,
                estimate: PoseEstimate::default(),
                map: &self.map,
                is_tracked: self.is_tracked,
                gyro_scale_sigma: None,
                gyro_bias_sigma_rad_per_s: None,
                reverse_budget_m: 0.15,
                beams: &beams,
                config: &config,
                knows_heading: true,
                hears_beacons: false,
                gyro_fault: None,
                touching: false,
                at_cliff: false,
            };
            step(&mut self.behavior, &situation, &mut self.mind);
            (self.behavior.state(), self.behavior.reason)
        }

        fn works(&mut self) -> (BehaviorState, Reason) {
            self.step(|behavior, situation, mind| {
                assert_eq!(behavior.work(situation, mind), Motion::Halt);
            })
        }

        /// It has docked with this charge.
        fn waits_with(&mut self, charge: f32) -> (BehaviorState, Reason) {
            self.observation.battery_charge = Some(charge);
            self.behavior.facts.docked = true;
            if self.behavior.mode == Mode::Working {
                self.behavior.arrive(&mut self.mind);
            }
            self.step(Behavior::watch_charge)
        }
    }

    #[test]
    fn a_first_run_that_left_much_resumes_from_its_dock_at_once_and_only_once() {
        let mut stage = Stage::with_swept(0.7);
        assert_eq!(stage.works(), (BehaviorState::Docking, Reason::LookAgain));
        assert!(!stage.behavior.has_covered_home(), "the job is not over");
        assert_eq!(
            stage.waits_with(0.6),
            (BehaviorState::Starting, Reason::LookAgain)
        );
        stage.behavior.mode = Mode::Working;
        assert_eq!(stage.works(), (BehaviorState::Docking, Reason::RestOutOfReach));
        assert!(stage.behavior.has_covered_home());
    }

    #[test]
    fn with_little_charge_it_waits_for_more_before_it_retries() {
        let mut stage = Stage::with_swept(0.7);
        stage.works();
        assert_eq!(stage.waits_with(0.4), (BehaviorState::Docked, Reason::LookAgain));
        assert_eq!(
            stage.waits_with(0.95),
            (BehaviorState::Starting, Reason::LookAgain)
        );
    }

    #[test]
    fn in_a_known_home_it_waits_on_its_dock_until_people_have_left_the_door() {
        let mut stage = Stage::in_known_home(0.7, true);
        assert_eq!(stage.works(), (BehaviorState::Docking, Reason::LookAgain));
        assert_eq!(stage.waits_with(0.9), (BehaviorState::Docked, Reason::LookAgain));
        stage.behavior.facts.now_us += 170_000_000;
        assert_eq!(stage.waits_with(0.9), (BehaviorState::Docked, Reason::LookAgain));
        stage.behavior.facts.now_us += 20_000_000;
        assert_eq!(
            stage.waits_with(0.9),
            (BehaviorState::Starting, Reason::LookAgain)
        );
        stage.behavior.mode = Mode::Working;
        assert_eq!(stage.works(), (BehaviorState::Docking, Reason::RestOutOfReach));
    }

    #[test]
    fn in_a_known_home_it_does_not_go_out_again_for_a_room_that_was_shut_before() {
        let mut stage = Stage::in_known_home(0.7, false);
        assert_eq!(stage.works(), (BehaviorState::Docking, Reason::RestOutOfReach));
    }

    #[test]
    fn a_job_that_left_little_is_over() {
        let mut stage = Stage::with_swept(0.93);
        assert_eq!(stage.works(), (BehaviorState::Docking, Reason::RestOutOfReach));
    }
}
