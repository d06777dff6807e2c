//! The host dies at random moments of a run; the robot stands within 300 ms each time, and cleaning goes on with the next
//! host.

use brain::command::StrategyName;
use home::Pcg;
use rvac_sim::{Host, TICK_US};
use scenarios::{cleaning, scene};
use vthal_core::Recording;

/// S1: the lease of the last command and the reaction time.
const STANDS_MS: u64 = 300;
const DEATHS: usize = 200;
/// Slower than this is standing.
const STANDING_M_PER_S: f64 = 0.001;

#[test]
fn the_robot_stands_within_300_ms_whenever_the_host_dies() {
    let scene = scene("two-room-flat", "nominal");
    let mut random = Pcg::new(1, 2);
    let mut household = cleaning(&scene, 1);
    let mut slowest_ms = 0;
    let mut moving = 0;
    for death in 0..DEATHS {
        household.pass_ms(2_000 + u64::from(random.below(4_000)));
        moving += usize::from(household.robot().wheels_driven());
        household.kill_host();
        let mut stands_ms = 0;
        while household.robot().wheels_driven() {
            stands_ms += 1;
            assert!(
                stands_ms <= STANDS_MS,
                "death {death}: driven after {stands_ms} ms"
            );
            household.tick();
        }
        slowest_ms = slowest_ms.max(stands_ms);
        household.pass_ms(STANDS_MS);
        assert!(
            !household.robot().wheels_driven(),
            "death {death}: driven again without a host"
        );
        let speed = household.robot().world().truth().speed_m_per_s.abs();
        assert!(
            speed < STANDING_M_PER_S,
            "death {death}: still rolls with {speed} m/s"
        );
        let config = Host::config(death as u64, StrategyName::Bounce, Recording::Off);
        household.revive_host(Host::start(household.now_us(), config));
        household.pass_ms(1_000);
        household.ask(rvac_api::RequestBody::Start { strategy: None });
    }
    assert!(
        moving > DEATHS / 3,
        "the robot drove at only {moving} of {DEATHS} deaths"
    );
    assert!(
        slowest_ms > 50,
        "a lease that ends at once is no lease: {slowest_ms} ms"
    );
    assert_eq!(household.robot().monitor().violations(), []);
    assert!(household.now_us() > TICK_US);
}
