//! Whoever drives by hand falls silent in the middle of a turn or on the way ahead: the wheels of the simulated robot rest within
//! the time of S23, to the millisecond of a virtual clock.

use home::{Pcg, Pose};
use rvac_api::RequestBody;
use rvac_sim::Household;
use scenarios::{cleaning, scene};

/// S23, and A17 of the attack table: from the last word of the driver to wheels at rest.
const RESTS_WITHIN_MS: u64 = 400;
/// The lease of the panel and of `rvac drive` (`clients/mixer/src/pilot.rs`), and how often they renew it.
const LEASE_MS: u16 = 250;
const RENEW_MS: u64 = 80;
/// By then friction has ended all motion.
const LOOK_MS: u64 = 1_500;
/// Rims slower than this stand, as in the test of hosts that die.
const STANDING_M_PER_S: f64 = 0.001;
/// The middle of a room, looking along it.
const IN_THE_OPEN: Pose = Pose::new(-3.4, 0.0, core::f64::consts::PI);
const LOSSES: usize = 100;
/// S24: a warning and a pause come before the first motion.
const START_MS: u64 = 4_000;
/// Ahead and on the spot, m/s and rad/s: what the panel asks for with a stick at its end.
const HOLDS: [(f64, f64); 3] = [(0.3, 0.0), (0.0, 1.5), (0.2, -1.0)];

fn drive(household: &mut Household, (v, w): (f64, f64)) {
    household.ask(RequestBody::Drive {
        v,
        w,
        ttl: LEASE_MS,
        clean: false,
        power: None,
    });
}

fn moves(household: &Household) -> bool {
    let truth = household.robot().world().truth();
    let rims = [truth.rim_left_m_per_s, truth.rim_right_m_per_s];
    rims.iter().any(|rim| rim.abs() > STANDING_M_PER_S)
}

/// Drives for so long from rest on, and gives the milliseconds from the last word until the wheels were at rest; none when
/// something else had stopped them before.
fn lose(household: &mut Household, hold: (f64, f64), renewals: u32) -> Option<u64> {
    drive(household, (0.0, 0.0));
    for _ in 0..renewals {
        household.pass_ms(RENEW_MS);
        drive(household, hold);
    }
    let moved = moves(household);
    let mut rested_ms = 0;
    for ms in 1..=LOOK_MS {
        household.tick();
        if moves(household) {
            rested_ms = ms;
        }
    }
    moved.then_some(rested_ms)
}

#[test]
fn the_wheels_rest_within_400_ms_of_the_last_word_of_a_driver() {
    let mut household = cleaning(&scene("two-room-flat", "nominal"), 1);
    household.pass_ms(START_MS + 20_000);
    household.ask(RequestBody::Stop);
    household.pass_ms(2_000);
    let place = household.robot().world().home().start().then(IN_THE_OPEN);
    let mut random = Pcg::new(1, 2);
    let mut rested_ms = Vec::new();
    for loss in 0..LOSSES {
        // At any phase of the robot's reports and of its main loop.
        household.pass_ms(u64::from(random.below(100)));
        household.robot_mut().world_mut().put_down_at(place);
        household.pass_ms(2_000);
        let renewals = 4 + random.below(6);
        rested_ms.extend(lose(&mut household, HOLDS[loss % HOLDS.len()], renewals));
    }
    rested_ms.sort_unstable();
    println!(
        "{} losses: rest after {:?} ms in the middle, {:?} ms at most",
        rested_ms.len(),
        rested_ms.get(rested_ms.len() / 2),
        rested_ms.last()
    );
    assert!(
        rested_ms.len() > LOSSES / 2,
        "the robot drove at only {} of {LOSSES} losses",
        rested_ms.len()
    );
    assert!(
        rested_ms.first() >= Some(&u64::from(LEASE_MS)),
        "a lease that ends before its time is none: {rested_ms:?}"
    );
    assert!(
        rested_ms.last() <= Some(&RESTS_WITHIN_MS),
        "the wheels go on: {rested_ms:?}"
    );
    assert_eq!(household.robot().monitor().violations(), []);
}
