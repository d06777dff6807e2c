//! The safety monitor finds a machine that does not obey its firmware.

use monitor::{Bridges, Rule};
use rvac_sim::Firmware;
use rvac_sim::faults::{FaultCampaign, TrialSettings};

#[test]
fn bridges_that_do_not_brake_are_found_out() {
    let model = home::RobotModel::by_name("sr8730").unwrap();
    let campaign = FaultCampaign::load(model, Firmware::HostBuilt).unwrap();
    let outcome = |bridges| {
        campaign.trial(TrialSettings {
            seed: 3,
            duration_ms: 60_000,
            bridges,
        })
    };
    assert_eq!(outcome(Bridges::Sound).violations, Vec::<String>::new());
    let broken = outcome(Bridges::DeafToBrake);
    assert!(
        broken
            .violations
            .iter()
            .any(|text| text.starts_with(Rule::WheelsWithoutLease.name())),
        "{:?}",
        broken.violations
    );
}
