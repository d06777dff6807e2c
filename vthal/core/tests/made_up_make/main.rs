//! A robot of another make joins by one folder: this one. It has no reflexes and no dead man, speaks lines of text, and its
//! odometry counts millimetres without a sign. What it lacks the host supplies.

mod make;
mod robot;
mod uncalibrated;

use make::MAKE;
use robot::{RADIUS_M, Robot};
use rvac_api::{Request, RequestBody, Topic, Update};
use vthal_core::device::{CommandError, DeviceCommand, DeviceIo, Supervisor};
use vthal_core::{ClientId, Core, CoreConfig, Input, LinkLoss, Outputs};

const ANNA: ClientId = ClientId(1);

/// The daemon's core and the robot, joined in memory on a virtual clock.
struct Pair {
    core: Core,
    robot: Robot,
    now_ms: u64,
    to_robot: Vec<u8>,
    updates: Vec<Update>,
}

impl Pair {
    /// Connected, described and idle.
    fn new(robot: Robot) -> Self {
        Self::with(robot, CoreConfig::default())
    }

    fn with(robot: Robot, config: CoreConfig) -> Self {
        let mut pair = Self {
            core: Core::new(CoreConfig { make: MAKE, ..config }),
            robot,
            now_ms: 0,
            to_robot: Vec::new(),
            updates: Vec::new(),
        };
        pair.handle(Input::ClientConnected(ANNA));
        let topics = vec![Topic::Status, Topic::Packets];
        pair.ask(RequestBody::Watch { topics });
        pair.handle(Input::LinkOpened);
        pair.run_ms(1000);
        assert_eq!(pair.core.status().state, "idle");
        pair
    }

    fn handle(&mut self, input: Input<'_>) {
        let mut outputs = Outputs::default();
        self.core.handle(self.now_ms * 1000, input, &mut outputs);
        self.to_robot.extend_from_slice(&outputs.link);
        let updates = outputs.deliveries.into_iter().map(|delivery| delivery.update);
        self.updates.extend(updates);
    }

    /// Asks and gives the reason of a refusal.
    fn ask(&mut self, body: RequestBody) -> Option<String> {
        let before = self.updates.len();
        self.handle(Input::Client {
            client: ANNA,
            request: Request { id: Some(1), body },
        });
        self.updates[before..].iter().find_map(|update| match update {
            Update::Failed(failure) => Some(failure.reason.clone()),
            _ => None,
        })
    }

    fn drive(&mut self, v: f64) -> Option<String> {
        self.ask(RequestBody::Drive {
            v,
            w: 0.0,
            ttl: 400,
            clean: false,
            power: None,
        })
    }

    /// Pushes the stick from its centre, and holds it until something happens, for fifteen seconds at most.
    fn drive_until(&mut self, v: f64, end: impl Fn(&Self) -> bool) {
        assert_eq!(self.drive(0.0), None);
        for _ in 0..300 {
            assert_eq!(self.drive(v), None);
            for _ in 0..50 {
                self.run_ms(1);
                if end(self) {
                    return;
                }
            }
        }
        panic!("nothing happened at x = {} m", self.robot.x_m);
    }

    fn run_ms(&mut self, duration_ms: u64) {
        for _ in 0..duration_ms {
            self.now_ms += 1;
            self.robot.pass_ms();
            let said = std::mem::take(&mut self.to_robot);
            let answer = self.robot.hear(&said);
            if !answer.is_empty() {
                self.handle(Input::LinkBytes(&answer));
            }
            let wake_us = self.core.next_wake_us();
            if wake_us.is_some_and(|wake_us| wake_us <= self.now_ms * 1000) {
                self.handle(Input::Wake);
            }
        }
    }

    /// Milliseconds until the wheels stand.
    fn stops_within_ms(&mut self, limit_ms: u64) -> bool {
        (0..limit_ms).any(|_| {
            self.run_ms(1);
            self.robot.stands()
        })
    }
}

#[test]
fn a_crashed_host_leaves_it_driving_and_the_next_one_lets_go_of_it_first() {
    let mut robot = Robot::new();
    (robot.is_driven, robot.wheels_mm_per_s) = (true, [50.0, 50.0]);
    let pair = Pair::new(robot);
    assert!(pair.robot.stands() && !pair.robot.is_driven);
}

#[test]
fn the_line_of_a_robot_without_a_dock_is_lent_where_it_stands() {
    let mut pair = Pair::new(Robot::new());
    let borrow = RequestBody::BorrowLink { silent: false };
    assert_eq!(pair.ask(borrow), None, "no dock can be waited for");
}

#[test]
fn a_driver_drives_no_faster_than_the_host_reacts_and_stops_with_the_lease() {
    let mut pair = Pair::new(Robot::new());
    assert_eq!(pair.drive(0.3).as_deref(), Some("range"), "30 mm in 120 ms");
    pair.drive_until(0.2, |pair| pair.robot.x_m > 1.3);
    assert_eq!(pair.robot.wheels_mm_per_s, [200.0; 2]);
    assert_eq!(pair.drive(0.2), None);
    assert!(pair.stops_within_ms(405), "the lease is 400 ms");
    let (x_m, pose) = (pair.robot.x_m, pair.core.pose());
    assert!((pose.x - (x_m - 1.0)).abs() < 0.02, "{pose:?} at {x_m} m");
    pair.run_ms(200);
    assert_eq!(pair.drive(0.0), None);
    pair.run_ms(200);
    pair.drive_until(-0.2, |pair| pair.robot.x_m < 1.1);
    pair.run_ms(1000);
    let (x_m, pose) = (pair.robot.x_m, pair.core.pose());
    assert!(
        (pose.x - (x_m - 1.0)).abs() < 0.03,
        "backwards has its sign by the command: {pose:?} at {x_m} m"
    );
}

#[test]
fn the_host_stops_it_at_a_wall_and_at_a_hole_while_the_stick_is_held() {
    let mut pair = Pair::new(Robot::new());
    pair.drive_until(0.2, |pair| pair.robot.bumps());
    assert!(pair.stops_within_ms(120), "the latency of the description");
    pair.run_ms(150);
    assert_eq!(pair.core.status().inhibits, ["bumper"]);
    let mut pair = Pair::new(Robot::before_hole(2.0));
    pair.drive_until(0.2, |pair| pair.robot.sees_hole());
    assert!(pair.stops_within_ms(120), "the latency of the description");
    assert!(pair.robot.x_m < 1.9, "its wheels are on the floor");
}

#[test]
fn a_bumper_that_stays_pressed_is_latched_until_a_person_has_freed_and_cleared_it() {
    let clear = || RequestBody::Clear {
        reason: "bumper-stuck".to_owned(),
    };
    let holds = |pair: &Pair, name: &str| pair.core.status().inhibits.iter().any(|held| held == name);
    let mut pair = Pair::new(Robot::new());
    pair.drive_until(0.2, |pair| pair.robot.bumps());
    // At rest it may stand against the wall for as long as it likes.
    pair.run_ms(20_000);
    assert!(holds(&pair, "bumper") && !holds(&pair, "bumper-stuck"));
    let pressed_ms = pair.now_ms;
    pair.drive_until(0.2, |pair| holds(pair, "bumper-stuck"));
    assert!(
        pair.now_ms - pressed_ms >= 10_000,
        "{} ms",
        pair.now_ms - pressed_ms
    );
    pair.ask(clear());
    pair.run_ms(200);
    assert!(holds(&pair, "bumper-stuck"), "its cause is there");
    pair.robot.free_bumper();
    pair.run_ms(200);
    assert!(!holds(&pair, "bumper") && holds(&pair, "bumper-stuck"));
    assert!(pair.drive(-0.2).is_some());
    assert!(pair.robot.stands());
    assert_eq!(pair.ask(clear()), None);
    pair.run_ms(200);
    assert!(!holds(&pair, "bumper-stuck"));
    assert_eq!(pair.drive(0.0), None);
    pair.run_ms(200);
    pair.drive_until(-0.2, |pair| pair.robot.x_m < 2.7);
}

#[test]
fn a_lifted_one_stands_and_one_that_was_put_down_waits_a_second() {
    let mut pair = Pair::new(Robot::new());
    pair.drive_until(0.1, |pair| pair.robot.x_m > 1.1);
    pair.robot.is_lifted = true;
    assert!(pair.stops_within_ms(120));
    pair.run_ms(100);
    assert_eq!(pair.core.status().inhibits, ["wheel-drop"]);
    pair.robot.is_lifted = false;
    pair.run_ms(900);
    assert_eq!(pair.core.status().inhibits, ["wheel-drop"]);
    pair.run_ms(300);
    assert!(pair.core.status().inhibits.is_empty());
}

#[test]
fn it_is_let_go_when_it_rests_and_when_the_daemon_ends() {
    let mut pair = Pair::new(Robot::new());
    pair.drive_until(0.1, |pair| pair.robot.x_m > 1.1);
    assert!(pair.robot.is_driven);
    assert_eq!(pair.ask(RequestBody::Release), None);
    pair.run_ms(6000);
    assert!(!pair.robot.is_driven, "it may sleep and charge");
    pair.drive_until(0.1, |pair| pair.robot.x_m > 1.2);
    pair.handle(Input::Shutdown);
    pair.run_ms(300);
    assert!(pair.robot.stands() && !pair.robot.is_driven && pair.core.stands_still());
}

#[test]
fn a_stop_holds_until_the_stick_is_used_again_and_a_lost_line_forgets_nothing() {
    let mut pair = Pair::new(Robot::new());
    pair.drive_until(0.1, |pair| pair.robot.x_m > 1.1);
    assert_eq!(pair.ask(RequestBody::Stop), None);
    pair.run_ms(200);
    assert!(pair.robot.stands());
    assert_eq!(pair.core.status().inhibits, ["stopped"]);
    pair.handle(Input::LinkClosed {
        reason: LinkLoss::HungUp,
    });
    pair.run_ms(500);
    pair.handle(Input::LinkOpened);
    pair.run_ms(1000);
    assert_eq!(pair.drive(0.0), None);
    pair.run_ms(100);
    pair.drive_until(0.1, |pair| pair.robot.x_m > 1.2);
}

#[test]
fn it_cleans_a_room_with_a_hole() {
    let mut pair = Pair::new(Robot::before_hole(2.6));
    let strategy = Some("bounce".to_owned());
    assert_eq!(pair.ask(RequestBody::Start { strategy }), None);
    let mut pushed_ms = 0;
    for _ in 0..120_000 {
        pair.run_ms(1);
        let [left, right] = pair.robot.wheels_mm_per_s;
        let pushes = pair.robot.bumps() && left + right > 0.0;
        pushed_ms = if pushes { pushed_ms + 1 } else { 0 };
        assert!(pushed_ms <= 120, "the host stops it");
        assert!(pair.robot.x_m < 2.6, "it fell");
    }
    let status = pair.core.status();
    assert_eq!(status.state, "cleaning");
    assert!(status.bumps >= 10 && status.path_m > 5.0, "{status:?}");
    assert!(status.swept_m2 > 2.0, "{status:?}");
    let [width_m, depth_m] = pair.robot.size_m;
    assert!(pair.robot.x_m <= width_m - RADIUS_M && pair.robot.y_m <= depth_m - RADIUS_M);
}

#[test]
fn experts_speak_its_own_words_and_everybody_reads_them() {
    let mut pair = Pair::new(Robot::new());
    let told = |pair: &Pair, wanted: &str| {
        pair.updates
            .iter()
            .any(|update| matches!(update, Update::Packet { text, .. } if text == wanted))
    };
    assert!(told(&pair, "sense") && told(&pair, "sense 0 0 0 0 0"));
    let raw = RequestBody::Raw {
        packet: "mode drive".to_owned(),
    };
    assert_eq!(pair.ask(raw).as_deref(), Some("expert-off"));
}

#[test]
fn a_line_on_which_nobody_answers_is_opened_at_another_rate() {
    let mut core = Core::new(CoreConfig {
        make: MAKE,
        ..CoreConfig::default()
    });
    let mut outputs = Outputs::default();
    core.handle(0, Input::LinkOpened, &mut outputs);
    core.handle(499_000, Input::Wake, &mut outputs);
    assert!(!outputs.next_rate);
    core.handle(500_000, Input::Wake, &mut outputs);
    assert!(outputs.next_rate);
    outputs.clear();
    core.handle(600_000, Input::Wake, &mut outputs);
    assert!(!outputs.next_rate, "it is told once");
}

/// The supervisor without the daemon around it.
struct Alone {
    supervisor: Supervisor,
    robot: Robot,
    now_us: u64,
    to_robot: Vec<u8>,
}

impl Alone {
    fn new() -> Self {
        let mut alone = Self {
            supervisor: Supervisor::new(&MAKE),
            robot: Robot::new(),
            now_us: 0,
            to_robot: Vec::new(),
        };
        alone.with(|supervisor, io| supervisor.open(io));
        alone.run_ms(500);
        alone
    }

    fn with<T>(&mut self, act: impl FnOnce(&mut Supervisor, &mut DeviceIo<'_>) -> T) -> T {
        let mut io = DeviceIo {
            now_us: self.now_us,
            link: &mut self.to_robot,
            events: &mut Vec::new(),
        };
        act(&mut self.supervisor, &mut io)
    }

    fn run_ms(&mut self, duration_ms: u64) {
        for _ in 0..duration_ms {
            self.now_us += 1000;
            self.robot.pass_ms();
            let said = std::mem::take(&mut self.to_robot);
            let answer = self.robot.hear(&said);
            self.with(|supervisor, io| supervisor.receive(&answer, io));
            if self.supervisor.next_wake_us() <= self.now_us {
                self.with(|supervisor, io| supervisor.poll(io));
            }
        }
    }

    fn drive(&mut self) -> Result<(), CommandError> {
        let forward = DeviceCommand::Drive {
            speed_m_per_s: 0.1,
            turn_rad_per_s: 0.0,
            valid_for_us: 250_000,
        };
        self.with(|supervisor, io| supervisor.command(forward, io))
    }
}

#[test]
fn the_dead_man_of_the_host_stops_it_when_commands_stop_even_if_the_word_is_lost() {
    let mut alone = Alone::new();
    assert_eq!(alone.drive(), Err(CommandError::Busy), "its mode changes");
    alone.run_ms(2);
    assert_eq!(alone.drive(), Ok(()));
    alone.run_ms(249);
    assert!(!alone.robot.stands());
    alone.run_ms(3);
    assert!(alone.robot.stands(), "250 ms");
    assert_eq!(alone.drive(), Ok(()));
    alone.run_ms(248);
    alone.robot.hears = false;
    alone.run_ms(10);
    alone.robot.hears = true;
    assert!(!alone.robot.stands(), "it would drive for ever");
    alone.run_ms(450);
    assert!(alone.robot.stands(), "it was told again");
}
