//! A Relax, which nothing but its wheels tells its heading, with and without sensors on its Linux board.

use brain::StrategyName;
use rvac_sim::{Household, Scene};
use scenarios::{Table, Watched, relax};

const SEED: u64 = 4;
/// How long each cleans, seconds.
const CLEAN_S: u64 = 12 * 60;
const BEACONS: usize = 4;
/// After so long enough beacons were heard for a job in lanes, seconds.
const HEARD_S: u64 = 5;

fn row(table: &mut Table, what: &str, (scene, fit): (&Scene, impl FnOnce(Household) -> Household)) {
    let mut watched = Watched::new(scene, SEED).changed(fit);
    watched.clean(None);
    watched.finish(CLEAN_S);
    table.row(what, &watched);
}

#[test]
fn a_relax_and_what_sits_on_its_board() {
    let mut table = Table::of_outcomes("relax", "a Relax cleans as suits it, nominal, seed 4");
    for home in ["two-room-flat", "furnished-room"] {
        let scene = relax(home);
        let what = |text: &str| format!("{home} {text}");
        let beacons = || scene.beacons(SEED, BEACONS);
        row(&mut table, &what("as sold"), (&scene, |household| household));
        row(
            &mut table,
            &what("ranges of beacons"),
            (&scene, |household: Household| household.with_beacons(beacons())),
        );
        row(
            &mut table,
            &what("strengths of beacons"),
            (&scene, |household: Household| {
                household.with_beacons(beacons().by_strength())
            }),
        );
        row(
            &mut table,
            &what("gyro"),
            (&scene, |household: Household| {
                household.with_board_gyro(scene.board_gyro(SEED))
            }),
        );
    }
    let scene = relax("two-room-flat");
    row(
        &mut table,
        "two-room-flat gyro, strengths of beacons, known home",
        (&scene, |household: Household| {
            household
                .with_board_gyro(scene.board_gyro(SEED))
                .with_beacons(scene.beacons(SEED, BEACONS).by_strength())
                .with_known_map()
        }),
    );
    for (what, beacons) in [("four", BEACONS), ("three", 3)] {
        let mut watched = Watched::new(&scene, SEED)
            .changed(|household| household.with_beacons(scene.beacons(SEED, beacons)));
        watched.pass_s(HEARD_S);
        watched.clean(Some(StrategyName::Systematic));
        watched.finish(CLEAN_S);
        table.row(
            &format!("two-room-flat ranges of {what} beacons, in lanes"),
            &watched,
        );
    }
    table.compare();
}
