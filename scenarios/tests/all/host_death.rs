//! The host dies at random moments of a run: the motors are off within 300 ms each time, the robot rolls out within 10 cm,
//! and cleaning goes on with the next host.

use brain::command::StrategyName;
use home::Pcg;
use rvac_sim::{Host, Household};
use scenarios::{cleaning, scene};

/// S1: the lease of the last command and the reaction time.
const OFF_MS: u64 = 300;
/// S1: the way after the last command.
const DISTANCE_M: f64 = 0.10;
/// By then friction and the shorted motors have ended all motion.
const REST_MS: u64 = 1_000;
const STANDING_M_PER_S: f64 = 0.001;
const DEATHS: usize = 200;
/// S24: a warning and a pause come before the first motion.
const START_MS: u64 = 4_000;

/// Kills the host and gives the milliseconds until the motors were off.
fn kill(household: &mut Household) -> u64 {
    household.kill_host();
    let before_m = household.robot().world().truth().path_m;
    let mut driven_ms = 0;
    for ms in 1..=REST_MS {
        household.tick();
        if household.robot().wheels_driven() {
            driven_ms = ms;
        }
    }
    let truth = household.robot().world().truth();
    let distance_m = truth.path_m - before_m;
    assert!(distance_m <= DISTANCE_M, "rolled {distance_m} m");
    assert!(
        truth.speed_m_per_s.abs() < STANDING_M_PER_S,
        "still moves after {REST_MS} ms"
    );
    driven_ms
}

#[test]
fn the_motors_are_off_within_300_ms_whenever_the_host_dies() {
    let scene = scene("two-room-flat", "nominal");
    let mut random = Pcg::new(1, 2);
    let mut household = cleaning(&scene, 1);
    let mut driven_ms = Vec::new();
    for death in 0..DEATHS {
        household.pass_ms(START_MS + u64::from(random.below(4_000)));
        driven_ms.push(kill(&mut household));
        let config = Host::config(death as u64, StrategyName::Bounce);
        household.revive_host(Host::start(household.now_us(), config));
        household.pass_ms(1_000);
        household.ask(rvac_api::RequestBody::Start { strategy: None });
    }
    let moving = driven_ms.iter().filter(|ms| **ms > 0).count();
    assert!(
        moving > DEATHS / 2,
        "the robot drove at only {moving} of {DEATHS} deaths"
    );
    let slowest = driven_ms.into_iter().max();
    assert!(
        slowest > Some(100),
        "a lease that ends at once is no lease: {slowest:?} ms"
    );
    assert!(
        slowest <= Some(OFF_MS),
        "driven for {slowest:?} ms without a host"
    );
    assert_eq!(household.robot().monitor().violations(), []);
}
