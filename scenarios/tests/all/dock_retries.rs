//! A good dock that the robot does not get onto at the first try: contacts that somebody wipes meanwhile, a shut door on the way, and the dock
//! of another robot in another room.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use brain::{BehaviorState, Brain};
use home::{DockContacts, Home, Noise, Pose, RobotModel};
use rvac_api::RequestBody;
use rvac_sim::{Host, Household, Scene};
use scenarios::{HOMES, household, off_the_dock, scene, settings};

/// Longest way home, seconds.
const HOME_S: u64 = 6 * 60;
/// Decisions that end a try.
const FAILED: [&str; 2] = ["dock-retry (", "dock-search (dock-missed)"];

fn told(household: &Household) -> (BehaviorState, &'static str) {
    let brain = household.host().and_then(Host::brain);
    let status = brain.map(Brain::status).expect("a brain");
    (status.state, status.reason.name())
}

fn failed_tries(household: &Household) -> usize {
    let log = household.host().map_or(&[][..], Host::log);
    let fails = |text: &str| FAILED.iter().any(|failed| text.starts_with(failed));
    log.iter().filter(|entry| fails(&entry.text)).count()
}

/// Sends the robot home from where it was put down; gives what it says once it rests. `happens` is told of every tenth of a second.
fn sent_home(
    household: &mut Household,
    mut happens: impl FnMut(&mut Household),
) -> (BehaviorState, &'static str) {
    household.host_mut().expect("lives").keep_log();
    household.ask(RequestBody::Dock);
    household.pass_ms(5_000);
    let mut rests_ms = 0;
    for _ in 0..HOME_S * 10 {
        happens(household);
        household.pass_ms(100);
        let is_under_way = matches!(
            told(household).0,
            BehaviorState::Docking | BehaviorState::Starting
        );
        // A robot that slips off its contacts at once tries again.
        rests_ms = if is_under_way { 0 } else { rests_ms + 100 };
        if rests_ms >= 3_000 {
            break;
        }
    }
    assert_eq!(household.robot().monitor().violations().len(), 0);
    told(household)
}

/// Sends the robot home to contacts that are dead for so many tries, and then somebody wipes them.
fn wiped_after(tries: usize, home: &str, seed: u64) -> (BehaviorState, &'static str) {
    let scene = scene(home, "nominal");
    let mut household = household(&scene, &settings(seed, 0)).with_known_map();
    let world = household.robot_mut().world_mut();
    world.put_down_at(off_the_dock(&scene));
    world.set_dock_contacts(DockContacts::Dead);
    household.pass_ms(4_000);
    sent_home(&mut household, |household| {
        if failed_tries(household) >= tries {
            household
                .robot_mut()
                .world_mut()
                .set_dock_contacts(DockContacts::Clean);
        }
    })
}

#[test]
fn contacts_that_are_wiped_after_the_first_try_or_before_the_last_carry_current() {
    for home in HOMES {
        for seed in 1..=4 {
            for tries in [1, 4] {
                let told = wiped_after(tries, home, seed);
                assert_eq!(
                    told,
                    (BehaviorState::Docked, "docked"),
                    "{home}, seed {seed}, wiped after {tries}"
                );
            }
        }
    }
}

/// A household of the two-room flat with the map of a day on which its door stood open. The robot is in the bedroom.
fn in_bedroom(door: &str, seed: u64) -> (Scene, Household) {
    let model = RobotModel::by_name("sr8730").expect("the project's robot");
    let text = include_str!("../../../homes/two-room-flat.toml");
    let flat = |text: &str| Home::from_floorplan("two-room-flat", text, &model).expect("a home");
    let open = flat(text);
    let today = flat(&text.replace("state = \"open\"", &format!("state = \"{door}\"")));
    let scene = Scene::new(Arc::new(today), model.clone(), Noise::nominal());
    let mut household = household(&scene, &settings(seed, 0)).with_map_of(&open);
    household.robot_mut().world_mut().put_down_at(BEDROOM);
    household.pass_ms(4_000);
    (scene, household)
}

/// Before the bed, looking at the wardrobe.
const BEDROOM: Pose = Pose::new(6.3, 1.4, 0.5);

#[test]
fn a_shut_door_on_the_way_is_named_within_minutes() {
    for seed in 1..=6 {
        let (_, mut household) = in_bedroom("closed", seed);
        let told = sent_home(&mut household, |_| {});
        assert_eq!(told, (BehaviorState::Idle, "way-blocked"), "seed {seed}");
    }
}

/// Where the dock of another robot stands: at the wall of the bedroom that is opposite the bed.
const OTHER_DOCK: Pose = Pose::new(6.46, 0.06, FRAC_PI_2);

/// The home has one dock, which stands in the room that the robot is in: neither is seen from the other room.
fn show_dock_of_the_room(household: &mut Household, own: Pose, is_shown: &mut Option<bool>) {
    let is_in_bedroom = household.robot().world().truth().pose.x_m > 4.65;
    if *is_shown == Some(is_in_bedroom) {
        return;
    }
    *is_shown = Some(is_in_bedroom);
    let world = household.robot_mut().world_mut();
    if is_in_bedroom {
        world.put_dock(OTHER_DOCK);
        world.set_dock_contacts(DockContacts::Dead);
    } else {
        world.put_dock(own);
        world.set_dock_contacts(DockContacts::Clean);
    }
}

#[test]
fn the_dock_of_another_robot_in_another_room_does_not_keep_it_from_its_own() {
    for seed in 1..=4 {
        for is_carried in [false, true] {
            let (scene, mut household) = in_bedroom("open", seed);
            if is_carried {
                household.robot_mut().world_mut().lift();
                household.pass_ms(4_000);
                household.robot_mut().world_mut().put_down_at(BEDROOM);
                household.pass_ms(3_000);
            }
            let own = scene.home().dock().expect("a dock");
            let mut is_shown = None;
            show_dock_of_the_room(&mut household, own, &mut is_shown);
            let told = sent_home(&mut household, |household| {
                show_dock_of_the_room(household, own, &mut is_shown);
            });
            assert_eq!(
                told,
                (BehaviorState::Docked, "docked"),
                "seed {seed}, carried: {is_carried}"
            );
        }
    }
}
