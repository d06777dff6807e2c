//! Jobs, edits, orders and schedules by chance: each job that was accepted, or that a schedule says it began, is in the history, once, and
//! what it says of swept floor agrees with the world.

use std::collections::BTreeSet;

use home::Pcg;
use rayon::prelude::*;
use rvac_api::{InQuiet, NoGoShape, RequestBody, RunJob, ScheduleEntry, ScheduleTime, ScheduledJob, Weekday};
use rvac_sim::{Host, Household};
use scenarios::{household, scene, settings};
use vthal_core::ClientId;

const HOME: &str = "furnished-room";
/// Stream of the draws.
const STREAM: u64 = 38;
/// A run is kept some seconds after its robot has come to rest; a robot on its way home needs longer, milliseconds.
const END_MS: u64 = 20_000;
/// One wait in so many is long enough to sweep some floor.
const LONG_WAITS: u32 = 30;
const LONG_WAIT_MS: u64 = 40_000;
/// Who asks.
const PERSON: ClientId = ClientId(7);
/// By how much the robot's own figure of swept floor may differ from the world's: a share, and square metres.
const OFF_SHARE: f64 = 0.15;
const OFF_M2: f64 = 0.4;

/// Jobs by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Jobs {
    clean: usize,
    spot: usize,
}

/// Monday 2026-11-23, 08:00 UTC.
const MORNING_S: i64 = 1_795_420_800;
const SECONDS_A_DAY: i64 = 86_400;
/// A drawn schedule is due in one of the next minutes.
const SOON_MIN: u32 = 3;

/// A schedule that is due soon, with a name that no other has.
fn schedule(random: &mut Pcg, now_us: u64) -> RequestBody {
    let seconds = (MORNING_S + (now_us / 1_000_000) as i64) % SECONDS_A_DAY;
    let minute = seconds / 60 + 1 + i64::from(random.below(SOON_MIN));
    RequestBody::AddSchedule(ScheduleEntry {
        name: format!("Number {now_us}"),
        enabled: true,
        job: ScheduledJob::Start {
            strategy: Some("bounce".to_owned()),
        },
        when: ScheduleTime::Weekly {
            days: Weekday::ALL.to_vec(),
            at: format!("{:02}:{:02}", minute / 60 % 24, minute % 60),
        },
        late_min: 0,
        in_quiet: InQuiet::Refuse,
        floor: None,
    })
}

fn drawn(random: &mut Pcg, now_us: u64) -> RequestBody {
    let start = |strategy: &str| RequestBody::Start {
        strategy: Some(strategy.to_owned()),
    };
    match random.below(18) {
        0 | 1 => start("systematic"),
        2 => start("bounce"),
        3 | 4 => RequestBody::Spot,
        5 => RequestBody::Dock,
        6 | 7 => RequestBody::Pause,
        8 => RequestBody::Resume,
        9 | 16 | 17 => RequestBody::Stop,
        10 => {
            let [x_m, y_m] = [0, 1].map(|_| 2.0 * random.symmetric());
            let corners = [(0.0, 0.0), (0.5, 0.0), (0.5, 0.4), (0.0, 0.4)];
            RequestBody::AddNoGo {
                shape: NoGoShape::Zone(corners.map(|(x, y)| [x_m + x, y_m + y]).to_vec()),
                name: None,
            }
        }
        11 => RequestBody::RemoveNoGo {
            number: 1 + random.below(12) as u16,
        },
        12 => RequestBody::RemoveSchedule {
            number: 1 + random.below(12),
        },
        13 => RequestBody::SkipNext {
            number: 1 + random.below(12),
            skip: random.below(2) == 0,
        },
        _ => schedule(random, now_us),
    }
}

/// Square metres that the world has seen swept.
fn swept_m2(household: &Household) -> f64 {
    let world = household.robot().world();
    world.truth().swept_share * world.home().reachable_area_m2()
}

fn told(host: &Host) -> Jobs {
    let count = |is: fn(&RunJob) -> bool| host.runs().iter().filter(|record| is(&record.run.job)).count();
    Jobs {
        clean: count(|job| matches!(job, RunJob::Clean { .. })),
        spot: count(|job| matches!(job, RunJob::Spot)),
    }
}

/// Schedules that say they began a job, by name. The host keeps the newest decisions only.
fn note_fired(host: &Host, fired: &mut BTreeSet<String>) {
    let decisions = host.schedules().decisions.into_iter();
    let begun = decisions.filter(|decision| decision.outcome == "fired");
    fired.extend(begun.map(|decision| decision.name));
}

/// What a robot in a known home has accepted.
#[derive(Debug)]
struct Life {
    /// All jobs, those of schedules included.
    jobs: Jobs,
    /// Jobs that schedules began.
    fired: usize,
}

/// Asks so many things of a robot in a known home, and gives the jobs that it accepted.
fn live(seed: u64, requests: u32) -> Life {
    let mut household = household(&scene(HOME, "nominal"), &settings(seed, 0)).with_known_map();
    household.pass_ms(5_000);
    let now_us = household.now_us();
    household.host_mut().expect("lives").set_wall(now_us, MORNING_S);
    let mut random = Pcg::new(seed, STREAM);
    let mut accepted = Jobs::default();
    let mut fired = BTreeSet::new();
    for _ in 0..requests {
        let now_us = household.now_us();
        let body = drawn(&mut random, now_us);
        let host = household.host_mut().expect("lives");
        if host.ask_as(now_us, PERSON, body.clone()).is_none() {
            match body {
                RequestBody::Start { .. } => accepted.clean += 1,
                RequestBody::Spot => accepted.spot += 1,
                _ => {}
            }
        }
        let waits_ms = match random.below(LONG_WAITS) {
            0 => LONG_WAIT_MS,
            _ => 500 + u64::from(random.below(3_500)),
        };
        household.pass_ms(waits_ms);
        note_fired(household.host().expect("lives"), &mut fired);
    }
    accepted.clean += fired.len();
    let now_us = household.now_us();
    let host = household.host_mut().expect("lives");
    host.ask_as(now_us, PERSON, RequestBody::Stop);
    household.pass_ms(END_MS);
    let host = household.host().expect("lives");
    assert_eq!(told(host), accepted, "seed {seed}: what the history tells");
    let world_m2 = swept_m2(&household);
    let mut all_m2 = 0.0;
    for record in host.runs() {
        let run = &record.run;
        assert!(!run.reason.is_empty() && run.duration_s >= 0.0, "{run:?}");
        assert!(
            run.swept_m2 <= world_m2 * (1.0 + OFF_SHARE) + OFF_M2,
            "seed {seed}: more than the world's {world_m2} m2: {run:?}"
        );
        all_m2 += run.swept_m2;
    }
    assert!(
        all_m2 >= world_m2 * (1.0 - OFF_SHARE) - OFF_M2,
        "seed {seed}: {all_m2} m2 in all runs, {world_m2} m2 in the world"
    );
    assert_eq!(household.report().monitor_violations, 0, "seed {seed}");
    Life {
        jobs: accepted,
        fired: fired.len(),
    }
}

#[test]
fn each_accepted_job_is_in_the_history_and_its_floor_was_swept() {
    let life = live(1, 240);
    assert!(
        life.jobs.clean > 2 && life.jobs.spot > 1 && life.fired > 0,
        "{life:?}"
    );
}

#[test]
#[ignore = "campaign: 10,000 requests; cargo xtask test --long"]
fn ten_thousand_requests_leave_a_true_history() {
    (2..=41_u64).into_par_iter().for_each(|seed| {
        live(seed, 250);
    });
}
