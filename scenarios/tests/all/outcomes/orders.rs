//! Jobs of parts of a home, with places that are forbidden; jobs that people interrupt, and a daemon that dies.

use brain::Point2;
use brain::command::StrategyName;
use brain::mapping::Room;
use rvac_api::{CleaningPattern, JobOrder, JobPart, NoGoShape, RequestBody, RoomNaming, RoomSplitting};
use rvac_sim::Host;
use scenarios::{JOB_S, Table, Watched, generated_with, scene, usual};
use vthal_core::{Checkpoints, CoreConfig};

/// Half the side of a square that is drawn on the map, metres.
const HALF_M: f64 = 0.6;

fn square(middle: Point2, half_m: f64) -> Vec<[f64; 2]> {
    let (x, y) = (middle.x_m, middle.y_m);
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(ahead, left)| [x + ahead * half_m, y + left * half_m])
        .to_vec()
}

/// A robot in a home that it knows, and the rooms of it, largest first.
fn in_rooms(seed: u64) -> (Watched, Vec<Room>) {
    let mut watched = Watched::new(&scene("two-room-flat", "nominal"), seed).knowing_home();
    watched.pass_s(3);
    let mut rooms = watched.brain().map().rooms().rooms().to_vec();
    rooms.sort_by(|one, other| other.area_m2.total_cmp(&one.area_m2));
    (watched, rooms)
}

fn ask(watched: &mut Watched, request: RequestBody) {
    watched.household_mut().ask(request);
    watched.pass_s(1);
}

#[test]
fn parts_of_a_home_with_forbidden_places() {
    let mut table = Table::of_outcomes(
        "orders",
        "parts of two-room-flat nominal with a perfect map, seed 7",
    );

    let (mut watched, rooms) = in_rooms(7);
    let far = rooms[1];
    ask(
        &mut watched,
        RequestBody::AddNoGo {
            shape: NoGoShape::Zone(square(far.middle, 0.5 * HALF_M)),
            name: Some("Bowl".to_owned()),
        },
    );
    watched.start(RequestBody::Clean(JobOrder {
        parts: vec![JobPart::Room(far.id)],
        ..JobOrder::default()
    }));
    watched.finish(JOB_S);
    table.row("a room with a no-go zone", &watched);

    let (mut watched, rooms) = in_rooms(7);
    watched.start(RequestBody::Clean(JobOrder {
        parts: vec![
            JobPart::Zone(square(rooms[1].middle, 1.5 * HALF_M)),
            JobPart::Spot([rooms[0].middle.x_m, rooms[0].middle.y_m]),
            JobPart::Zone(square(rooms[0].middle, HALF_M)),
        ],
        passes: 2,
        avoid: vec![NoGoShape::Zone(square(rooms[0].middle, 0.2))],
        ..JobOrder::default()
    }));
    watched.finish(JOB_S);
    table.row("two zones and a spot, twice, one place avoided", &watched);

    let (mut watched, rooms) = in_rooms(7);
    edit_rooms(&mut watched, rooms[0]);
    let part = watched.brain().map().rooms().rooms().last().map(|room| room.id);
    watched.start(RequestBody::Clean(JobOrder {
        parts: vec![JobPart::Room(part.expect("rooms"))],
        pattern: Some(CleaningPattern::Contour),
        ..JobOrder::default()
    }));
    watched.finish(JOB_S);
    table.row("half of a split room along its walls", &watched);
    table.compare();
}

fn edit_rooms(watched: &mut Watched, room: Room) {
    let Point2 { x_m, y_m } = room.middle;
    ask(
        watched,
        RequestBody::SplitRoom(RoomSplitting {
            room: Some(room.id),
            line: [[x_m, y_m - 6.0], [x_m, y_m + 6.0]],
        }),
    );
    ask(
        watched,
        RequestBody::NameRoom(RoomNaming {
            room: room.id,
            name: Some("Kitchen".to_owned()),
        }),
    );
    ask(
        watched,
        RequestBody::AddNoGo {
            shape: NoGoShape::Wall([[x_m - 0.3, y_m - 0.8], [x_m + 0.3, y_m - 0.8]]),
            name: None,
        },
    );
}

#[test]
fn jobs_that_are_interrupted() {
    let mut table = Table::of_outcomes("interruptions", "jobs that are interrupted, systematic, seed 8");

    let mut watched = Watched::new(&scene("furnished-room", "nominal"), 8);
    watched.clean(Some(StrategyName::Systematic));
    watched.pass_s(100);
    ask(&mut watched, RequestBody::Pause);
    watched.pass_s(20);
    ask(&mut watched, RequestBody::Resume);
    watched.pass_s(100);
    ask(&mut watched, RequestBody::Stop);
    watched.pass_s(10);
    ask(&mut watched, RequestBody::Dock);
    watched.come_home(600);
    table.row("first run paused, resumed, stopped, sent home", &watched);
    watched.clean(Some(StrategyName::Systematic));
    watched.come_home(JOB_S);
    table.row("and sent out again", &watched);

    let mut watched = Watched::new(&generated_with(14, "nominal"), 8).knowing_home();
    watched.clean(Some(StrategyName::Systematic));
    watched.pass_s(120);
    ask(&mut watched, RequestBody::Pause);
    watched.pass_s(30);
    ask(&mut watched, RequestBody::Resume);
    watched.pass_s(60);
    ask(&mut watched, RequestBody::Spot);
    watched.pass_s(60);
    table.row("known home paused, resumed, a spot instead", &watched);
    table.compare();
}

/// What a daemon goes on with after one that died.
fn goes_on(host: &Host, before: CoreConfig) -> CoreConfig {
    CoreConfig {
        resume: host.checkpoint().cloned(),
        checkpoints: Checkpoints::On,
        ..before
    }
}

#[test]
fn a_daemon_that_dies() {
    let mut table = Table::of_outcomes(
        "restarts",
        "the daemon dies twice and goes on from its checkpoint, seed 9",
    );
    for (what, is_known) in [("first run", false), ("known home", true)] {
        let scene = scene("two-room-flat", "nominal");
        let config = CoreConfig {
            checkpoints: Checkpoints::On,
            ..usual(&scene, 9)
        };
        let mut watched = Watched::with_config(&scene, 9, config.clone());
        if is_known {
            watched = watched.knowing_home();
        }
        watched.clean(Some(StrategyName::Systematic));
        for _ in 0..2 {
            watched.pass_s(150);
            watched.restart(3, |host| goes_on(host, config.clone()));
        }
        watched.finish(JOB_S);
        table.row(what, &watched);
    }
    table.compare();
}
