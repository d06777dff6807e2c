//! The core and the robot's end of the wire joined in memory, on a virtual clock.

use brain::{Cell, CellKnowledge, JobCommand, NextNumbers, Pose2, Raster, StoredMap};
use rvac_api::{
    CleaningPattern, CleaningPower, Gesture, JobOrder, JobPart, LogLevel, NoGoShape, PlaceShape, Request,
    RequestBody, RoomBefore, RoomNaming, RoomSettings, RoomSplitting, Topic, Update,
};
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Bumpers, Capabilities, Command, Description, Event, Gyro, Inhibit, Inhibits, Limits, Motor,
    MotorGaps, Name, Refusal, Report, ResetCause, State, WheelDrops,
};
use rvac_protocol::session::{RobotEvent, RobotIdentity, RobotSession};
use rvac_units::{Angle, AngularSpeed, Length, Speed, Tick};
use vthal_core::health::{Consumable, Health};
use vthal_core::{
    ClientId, Core, CoreConfig, EditedMap, FloorHome, FloorOrder, FloorTask, HealthOrder, Input, KeptFloor,
    Lights, MapOrder, Outputs, Record, Recording,
};

const ANNA: ClientId = ClientId(1);
const BERT: ClientId = ClientId(2);
/// Telemetry of the SR8730, in ms.
const PERIOD_MS: u64 = 20;

/// A core, a robot without wheels, and what passed between them.
struct Pair {
    core: Core,
    robot: RobotSession,
    state: State,
    now_ms: u64,
    /// What the robot was told, with the time in ms.
    commands: Vec<(u64, Command)>,
    /// What clients were told, in order.
    updates: Vec<Update>,
    records: Vec<Record>,
    /// Maps that the shell should keep.
    homes: Vec<FloorHome>,
    /// What it should do with the floors.
    floor_orders: Vec<FloorOrder>,
    /// What the shell should do with the kept ones.
    orders: Vec<MapOrder>,
    /// Maps that clients have changed.
    edits: Vec<EditedMap>,
    /// Loads of motors that it should keep.
    healths: Vec<HealthOrder>,
    to_robot: Vec<u8>,
    /// Whether `stop` reaches the robot's inhibits.
    hears_stop: bool,
    /// What it answers to drive commands, in place of driving.
    refuses_to_drive: Option<Refusal>,
}

impl Pair {
    /// Connected, described and idle, with two clients.
    fn new() -> Self {
        Self::in_home(None)
    }

    /// As [`Self::new`], with a map that was kept.
    fn in_home(home: Option<StoredMap>) -> Self {
        let floor = home.map(|home| KeptFloor {
            home: Some(home),
            ..KeptFloor::new(1)
        });
        Self::with_floors(floor.into_iter().collect())
    }

    /// As [`Self::new`], with these floors that were kept.
    fn with_floors(floors: Vec<KeptFloor>) -> Self {
        let mut pair = Self {
            core: Core::new(CoreConfig {
                recording: Recording::On,
                floors,
                ..CoreConfig::default()
            }),
            robot: RobotSession::new(identity(), Tick(0)),
            state: State::default(),
            now_ms: 0,
            commands: Vec::new(),
            updates: Vec::new(),
            records: Vec::new(),
            homes: Vec::new(),
            floor_orders: Vec::new(),
            orders: Vec::new(),
            edits: Vec::new(),
            healths: Vec::new(),
            to_robot: Vec::new(),
            hears_stop: true,
            refuses_to_drive: None,
        };
        pair.handle(Input::ClientConnected(ANNA));
        pair.handle(Input::ClientConnected(BERT));
        pair.ask(
            ANNA,
            RequestBody::Watch {
                topics: vec![Topic::Status, Topic::Log],
            },
        );
        pair.handle(Input::LinkOpened);
        pair.run_ms(1000);
        assert_eq!(pair.core.status().state, "idle");
        pair
    }

    fn handle(&mut self, input: Input<'_>) {
        let mut outputs = Outputs::default();
        self.core.handle(self.now_ms * 1000, input, &mut outputs);
        self.to_robot.extend_from_slice(&outputs.link);
        self.updates
            .extend(outputs.deliveries.into_iter().map(|delivery| delivery.update));
        self.records.extend(outputs.records);
        self.homes.extend(outputs.home);
        self.floor_orders.extend(outputs.floor_orders);
        self.orders.extend(outputs.map_orders);
        self.edits.extend(outputs.map_edits);
        self.healths.extend(outputs.health);
    }

    /// Asks and gives the reason of a refusal.
    fn ask(&mut self, client: ClientId, body: RequestBody) -> Option<String> {
        let before = self.updates.len();
        self.handle(Input::Client {
            client,
            request: Request { id: Some(1), body },
        });
        self.updates[before..].iter().find_map(|update| match update {
            Update::Failed(failure) => Some(failure.reason.clone()),
            _ => None,
        })
    }

    fn drive(&mut self, client: ClientId, v: f64) -> Option<String> {
        self.ask(
            client,
            RequestBody::Drive {
                v,
                w: 0.0,
                ttl: 400,
                clean: false,
                power: None,
            },
        )
    }

    /// A person pushes a stick from its centre: gives the reason of a refusal.
    fn push(&mut self, client: ClientId, v: f64) -> Option<String> {
        self.drive(client, 0.0).or_else(|| self.drive(client, v))
    }

    fn log_lines(&self) -> Vec<&str> {
        let lines = self.updates.iter().filter_map(|update| match update {
            Update::Log(entry) => Some(entry.text.as_str()),
            _ => None,
        });
        lines.collect()
    }

    /// The headings that the brain perceived, in order.
    fn headings(&self) -> Vec<Option<f64>> {
        let heading = |record: &Record| match record {
            Record::Observation(seen) => Some(seen.gyro_heading_rad),
            _ => None,
        };
        self.records.iter().filter_map(heading).collect()
    }

    fn run_ms(&mut self, duration_ms: u64) {
        for _ in 0..duration_ms {
            self.now_ms += 1;
            self.robot_ms();
            if self
                .core
                .next_wake_us()
                .is_some_and(|wake_us| wake_us <= self.now_ms * 1000)
            {
                self.handle(Input::Wake);
            }
        }
    }

    fn robot_ms(&mut self) {
        // Truncation is the wrap of the millisecond clock.
        let now = Tick(self.now_ms as u32);
        let mut events: Vec<RobotEvent> = std::mem::take(&mut self.to_robot)
            .into_iter()
            .filter_map(|byte| self.robot.receive(byte, now))
            .collect();
        events.extend(self.robot.poll(now));
        for event in events {
            let RobotEvent::Command(command) = event else {
                continue;
            };
            if let Some(sequence) = command.sequence().filter(|_| command.must_arrive()) {
                self.robot.answer(sequence, None);
            }
            match command {
                Command::Stop if self.hears_stop => self.state.inhibits.insert(Inhibit::Stopped),
                Command::Arm { .. } => self.state.inhibits.remove(Inhibit::Stopped),
                Command::Drive(_) => {
                    if let (Some(sequence), Some(_)) = (command.sequence(), self.refuses_to_drive) {
                        self.robot.answer(sequence, self.refuses_to_drive);
                    }
                }
                _ => {}
            }
            self.commands.push((self.now_ms, command));
        }
        let mut buffer = PacketBuffer::new();
        let mut bytes = Vec::new();
        while self.robot.next_packet(&mut buffer) {
            bytes.extend_from_slice(buffer.as_bytes());
        }
        if self.now_ms.is_multiple_of(PERIOD_MS) {
            self.state.tick = now;
            self.robot
                .encode(&Report::State(self.state), &mut buffer)
                .expect("fits");
            bytes.extend_from_slice(buffer.as_bytes());
        }
        if !bytes.is_empty() {
            self.handle(Input::LinkBytes(&bytes));
        }
    }

    /// Speed of the newest drive command, and when it came.
    fn last_drive(&self) -> (u64, f64) {
        let found = self
            .commands
            .iter()
            .rev()
            .find_map(|(at_ms, command)| match command {
                Command::Drive(drive) => Some((*at_ms, drive.speed.as_m_per_s())),
                _ => None,
            });
        found.expect("a drive command")
    }
}

fn identity() -> RobotIdentity {
    RobotIdentity {
        device: Name::try_from("paper").expect("short"),
        firmware: Name::try_from("1").expect("short"),
        boot_count: 1,
        reset_cause: ResetCause::PowerOn,
        session_seed: 99,
        binary: BinaryKinds::ALL,
        description: Description {
            capabilities: Capabilities {
                encoders: true,
                bumpers: 2,
                wheel_drops: 2,
                buttons: 1,
                beeper: true,
                brush_main: true,
                vacuum: true,
                ..Capabilities::default()
            },
            limits: Limits {
                speed_max: Speed::from_m_per_s(0.35),
                turn_max: AngularSpeed::from_rad_per_s(1.5),
                track: Length::from_m(0.23),
                count_nm: 1_000_000,
                radius: Length::from_m(0.175),
                swath: Length::from_m(0.3),
            },
            motors: MotorGaps::default(),
        },
    }
}

#[test]
fn a_driver_who_falls_silent_stops_within_the_lease_and_must_centre() {
    let mut pair = Pair::new();
    assert_eq!(pair.push(ANNA, 0.2), None);
    pair.run_ms(300);
    assert_eq!(pair.last_drive().1, 0.2);
    let silent_from_ms = pair.now_ms - 300;
    pair.run_ms(400);
    let stop = |(_, command): &&(u64, Command)| matches!(command, Command::Stop);
    let (stopped_ms, _) = *pair
        .commands
        .iter()
        .find(stop)
        .expect("the wheels were told to brake, not to roll out");
    assert_eq!(pair.core.status().reason, "lease-ended");
    assert!(
        stopped_ms - silent_from_ms <= 402,
        "after {} ms",
        stopped_ms - silent_from_ms
    );
    assert_eq!(pair.drive(ANNA, 0.2).as_deref(), Some("centre-first"));
    assert_eq!(pair.drive(ANNA, 0.0), None);
    pair.run_ms(50);
    assert_eq!(pair.drive(ANNA, 0.2), None);
}

/// A bump shorter than the pause between two reports is in no report: the event tells it.
#[test]
fn a_bump_between_two_reports_is_felt_once() {
    let mut pair = Pair::new();
    assert_eq!(pair.push(ANNA, 0.2), None);
    pair.run_ms(PERIOD_MS - pair.now_ms % PERIOD_MS);
    let left = Bumpers {
        left: true,
        right: false,
    };
    for bumpers in [left, Bumpers::default()] {
        pair.run_ms(4);
        pair.robot
            .queue_event(Event::Bump(bumpers), Tick(pair.now_ms as u32));
    }
    pair.run_ms(100);
    let felt = pair.records.iter().filter(
        |record| matches!(record, Record::Observation(seen) if seen.contacts.left && !seen.contacts.right),
    );
    assert_eq!(felt.count(), 1);
}

#[test]
fn a_driver_whose_connection_breaks_is_braked_and_one_who_lets_go_is_not() {
    let stops = |pair: &Pair| {
        let stop = |(_, command): &&(u64, Command)| matches!(command, Command::Stop);
        pair.commands.iter().filter(stop).count()
    };
    for (end, expected) in [(None, 0), (Some(Input::ClientGone(ANNA)), 1)] {
        let mut pair = Pair::new();
        assert_eq!(pair.push(ANNA, 0.2), None);
        pair.run_ms(300);
        match end {
            Some(end) => pair.handle(end),
            None => assert_eq!(pair.ask(ANNA, RequestBody::Release), None),
        }
        pair.run_ms(50);
        assert_eq!(stops(&pair), expected);
        assert_eq!(pair.drive(BERT, 0.0), None, "the seat is free");
        pair.run_ms(100);
        assert_eq!(pair.drive(BERT, 0.1), None);
        pair.run_ms(100);
        assert_eq!(pair.last_drive().1, 0.1, "and the next one drives");
    }
}

/// Telemetry of a robot at rest comes less often than a page speaks.
#[test]
fn a_stick_that_leaves_the_centre_before_the_next_telemetry_drives() {
    let mut pair = Pair::new();
    for _ in 0..20 {
        assert_eq!(pair.drive(ANNA, 0.0), None);
        assert_eq!(pair.drive(ANNA, 0.2), None);
        assert_eq!(pair.drive(ANNA, 0.2), None);
        pair.run_ms(200);
        assert_eq!(pair.last_drive().1, 0.2);
        pair.run_ms(903);
        assert!(is_braked(&pair), "the lease is over");
        assert_eq!(pair.drive(ANNA, 0.2).as_deref(), Some("centre-first"));
    }
    assert_eq!(pair.drive(ANNA, 0.0), None);
    assert_eq!(pair.ask(BERT, RequestBody::Stop), None);
    assert_eq!(
        pair.drive(ANNA, 0.2).as_deref(),
        Some("centre-first"),
        "a stop comes between"
    );
}

/// How hard a motor was told to run last.
fn power(pair: &Pair, wanted: Motor) -> Option<f64> {
    pair.commands.iter().rev().find_map(|(_, command)| match command {
        Command::Motor(order) if order.motor == wanted => Some(order.throttle.as_f64()),
        _ => None,
    })
}

#[test]
fn a_job_cleans_a_room_as_hard_as_its_settings_say() {
    let mut pair = on_the_dock();
    let set = |suction: f64, settings_passes: u8| RequestBody::SetRoom {
        room: 1,
        settings: Some(RoomSettings {
            passes: settings_passes,
            power: CleaningPower {
                suction,
                ..CleaningPower::FULL
            },
            pattern: CleaningPattern::Lines,
        }),
        was: None,
    };
    assert_eq!(pair.ask(ANNA, set(0.25, 2)), None);
    pair.run_ms(200);
    let kept = pair.edits[0].home.home.annotations().settings(1).copied();
    assert_eq!(
        kept.map(|settings| (settings.passes(), settings.power().suction)),
        Some((2, 25))
    );
    for (suction, passes) in [(1.5, 1), (f64::NAN, 1), (0.5, 0), (0.5, 4)] {
        assert_eq!(
            pair.ask(ANNA, set(suction, passes)).as_deref(),
            Some("bad-settings")
        );
    }
    let elsewhere = RequestBody::SetRoom {
        room: 9,
        settings: None,
        was: None,
    };
    assert_eq!(pair.ask(ANNA, elsewhere).as_deref(), Some("no-such-room"));
    let estimate = |pair: &mut Pair, part| {
        assert_eq!(pair.ask(ANNA, RequestBody::Estimate(clean(vec![part], 1))), None);
        pair.run_ms(500);
        let told = pair.updates.iter().rev().find_map(|update| match update {
            Update::JobEstimate(found) => Some(found.time_s),
            _ => None,
        });
        told.expect("an estimate")
    };
    let twice_s = estimate(&mut pair, JobPart::Room(1));
    let whole = JobPart::Zone(vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    let once_s = estimate(&mut pair, whole);
    assert!(twice_s > 1.8 * once_s, "{twice_s} s and {once_s} s");

    assert_eq!(pair.ask(ANNA, RequestBody::Start { strategy: None }), None);
    drive_off(&mut pair);
    assert_eq!(
        (power(&pair, Motor::Vacuum), power(&pair, Motor::BrushMain)),
        (Some(0.25), Some(1.0))
    );
    let usual = RequestBody::SetRoom {
        room: 1,
        settings: None,
        was: None,
    };
    assert_eq!(pair.ask(BERT, usual), None);
    pair.run_ms(200);
    assert_eq!(
        power(&pair, Motor::Vacuum),
        Some(1.0),
        "also in the middle of a job"
    );
}

/// S1: the robot ends the lease of the suction to the millisecond, so a job must renew it in time, two losses included.
#[test]
fn brushes_and_suction_are_renewed_three_times_in_their_lease() {
    let mut pair = on_the_dock();
    assert_eq!(pair.ask(ANNA, RequestBody::Start { strategy: None }), None);
    drive_off(&mut pair);
    let from_ms = pair.now_ms;
    pair.run_ms(5_000);
    let told: Vec<(u64, u16)> = pair
        .commands
        .iter()
        .filter_map(|(at_ms, command)| match command {
            Command::Motor(motor) if motor.motor == Motor::Vacuum && *at_ms >= from_ms => {
                Some((*at_ms, motor.lease_ms))
            }
            _ => None,
        })
        .collect();
    assert!(told.len() >= 15, "{told:?}");
    for pair in told.windows(2) {
        let pause_ms = pair[1].0 - pair[0].0;
        assert!(
            3 * pause_ms <= u64::from(pair[0].1) + 30,
            "{pause_ms} ms of {}",
            pair[0].1
        );
    }
}

#[test]
fn what_a_job_says_of_itself_wins_over_the_settings_of_a_room() {
    let mut pair = on_the_dock();
    let settings = RoomSettings {
        power: CleaningPower {
            suction: 0.25,
            ..CleaningPower::FULL
        },
        pattern: CleaningPattern::Contour,
        ..RoomSettings::default()
    };
    let set = RequestBody::SetRoom {
        room: 1,
        settings: Some(settings),
        was: None,
    };
    assert_eq!(pair.ask(ANNA, set), None);
    pair.run_ms(200);
    let kept = pair.edits[0].home.home.annotations().settings(1).copied();
    let pattern = kept.map(|settings| settings.pattern());
    assert_eq!(pattern, Some(brain::Pattern::Contour));
    let job = |suction| {
        RequestBody::Clean(JobOrder {
            power: Some(CleaningPower {
                suction,
                ..CleaningPower::QUIET
            }),
            pattern: Some(CleaningPattern::Lines),
            ..clean(vec![JobPart::Room(1)], 1)
        })
    };
    for bad in [1.5, f64::NAN, -0.1] {
        assert_eq!(pair.ask(ANNA, job(bad)).as_deref(), Some("bad-settings"));
    }
    assert_eq!(pair.ask(ANNA, job(0.4)), None);
    drive_off(&mut pair);
    assert_eq!(
        (power(&pair, Motor::Vacuum), power(&pair, Motor::BrushMain)),
        (Some(0.4), Some(0.6))
    );
}

#[test]
fn a_driver_chooses_how_hard_each_part_cleans_and_a_job_cleans_at_full_power() {
    let mut pair = Pair::new();
    let drive = |suction: f64, main_brush: f64| RequestBody::Drive {
        v: 0.0,
        w: 0.0,
        ttl: 400,
        clean: false,
        power: Some(CleaningPower {
            suction,
            main_brush,
            side_brushes: 1.0,
        }),
    };
    assert_eq!(pair.ask(ANNA, drive(0.5, 0.0)), None);
    pair.run_ms(200);
    assert_eq!(
        (power(&pair, Motor::Vacuum), power(&pair, Motor::BrushMain)),
        (Some(0.5), Some(0.0))
    );
    assert_eq!(power(&pair, Motor::BrushSides), None, "it has none");
    assert_eq!(pair.ask(ANNA, drive(0.0, 0.25)), None);
    pair.run_ms(200);
    assert_eq!(
        (power(&pair, Motor::Vacuum), power(&pair, Motor::BrushMain)),
        (Some(0.0), Some(0.25))
    );
    for wrong in [-0.1, 1.1, f64::NAN] {
        assert_eq!(pair.ask(ANNA, drive(wrong, 0.0)).as_deref(), Some("range"));
    }
    pair.ask(ANNA, RequestBody::Release);
    pair.run_ms(200);
    assert_eq!(power(&pair, Motor::BrushMain), Some(0.0));
    pair.ask(ANNA, RequestBody::Start { strategy: None });
    pair.run_ms(4000);
    assert_eq!(
        (power(&pair, Motor::Vacuum), power(&pair, Motor::BrushMain)),
        (Some(1.0), Some(1.0))
    );
}

#[test]
fn nobody_takes_the_seat_over_and_whoever_leaves_stops() {
    let mut pair = Pair::new();
    assert_eq!(pair.push(ANNA, 0.2), None);
    pair.run_ms(100);
    assert_eq!(pair.drive(BERT, 0.1).as_deref(), Some("driver-busy"));
    assert_eq!(
        pair.ask(BERT, RequestBody::Start { strategy: None }).as_deref(),
        Some("driver-busy")
    );
    assert_eq!(pair.core.status().driver.as_deref(), Some("client-1"));
    pair.handle(Input::ClientGone(ANNA));
    pair.run_ms(5);
    assert!(is_braked(&pair));
    assert_eq!(pair.core.status().driver, None);
}

/// Whether the wheels were told to brake since they were told to drive.
fn is_braked(pair: &Pair) -> bool {
    let of_wheels = |(_, command): &&(u64, Command)| matches!(command, Command::Drive(_) | Command::Stop);
    let last = pair.commands.iter().rev().find(of_wheels);
    matches!(last, Some((_, Command::Stop)))
}

#[test]
fn anybody_may_stop_and_the_wheels_do_not_wait_for_the_brain() {
    let mut pair = Pair::new();
    pair.push(ANNA, 0.2);
    pair.run_ms(100);
    assert_eq!(pair.ask(BERT, RequestBody::Stop), None);
    let stopped_ms = pair.now_ms;
    pair.run_ms(2);
    let stop = pair
        .commands
        .iter()
        .find(|(_, command)| *command == Command::Stop)
        .expect("stop");
    assert!(stop.0 <= stopped_ms + 1);
    pair.run_ms(500);
    let after = pair
        .commands
        .iter()
        .skip_while(|(_, command)| *command != Command::Stop);
    let moves = after.filter(|(_, command)| matches!(command, Command::Drive(drive) if drive.speed.0 != 0));
    assert_eq!(moves.count(), 0, "nothing moves after it");
    assert_eq!(pair.drive(ANNA, 0.2).as_deref(), Some("centre-first"));
}

#[test]
fn a_stop_that_got_lost_is_repeated_until_the_robot_knows_of_it() {
    let mut pair = Pair::new();
    pair.push(ANNA, 0.2);
    pair.run_ms(100);
    pair.hears_stop = false;
    pair.ask(BERT, RequestBody::Stop);
    pair.run_ms(500);
    pair.hears_stop = true;
    pair.run_ms(500);
    let stops = |pair: &Pair| {
        pair.commands
            .iter()
            .filter(|(_, command)| *command == Command::Stop)
            .count()
    };
    let heard = stops(&pair);
    assert!(
        (3..=4).contains(&heard),
        "{heard} in half a second and one that is heard"
    );
    pair.run_ms(1000);
    assert_eq!(stops(&pair), heard, "then it is enough");
    pair.drive(ANNA, 0.0);
    pair.run_ms(50);
    for _ in 0..10 {
        assert_eq!(pair.drive(ANNA, 0.2), None);
        pair.run_ms(100);
    }
    assert_eq!(pair.last_drive().1, 0.2, "driving arms the robot again");
}

#[test]
fn stops_without_end_do_not_fill_the_line_and_one_after_a_command_goes_out_at_once() {
    let mut pair = Pair::new();
    let stops = |pair: &Pair| {
        let all = pair.commands.iter();
        all.filter(|(_, command)| *command == Command::Stop).count()
    };
    for press in 1..=3 {
        pair.drive(ANNA, 0.0);
        pair.run_ms(50);
        pair.push(ANNA, 0.2);
        pair.run_ms(100);
        assert_eq!(pair.last_drive().1, 0.2);
        let before = stops(&pair);
        for _ in 0..1000 {
            assert_eq!(pair.ask(BERT, RequestBody::Stop), None, "each is answered");
        }
        pair.run_ms(5);
        let sent = stops(&pair) - before;
        assert!((1..=3).contains(&sent), "time {press}: {sent} were sent");
    }
}

/// Commands wait for the next step of the brain, or until the home of the next run is ready: what Stop makes void does not wait.
#[test]
fn starts_and_stops_without_end_are_not_all_carried_out_in_one_step() {
    let mut pair = on_the_dock();
    for _ in 0..200 {
        assert_eq!(pair.ask(ANNA, RequestBody::Stop), None);
        assert_eq!(pair.ask(ANNA, RequestBody::Start { strategy: None }), None);
    }
    assert_eq!(pair.ask(ANNA, RequestBody::Stop), None);
    pair.run_ms(2_000);
    assert_eq!(pair.core.status().state, "docked");
    let beeps = pair.commands.iter();
    let beeps = beeps.filter(|(_, command)| matches!(command, Command::Beep(_)));
    let beeps = beeps.count();
    assert!(beeps < 20, "{beeps} beeps");
}

#[test]
fn a_start_is_announced_before_anything_moves() {
    let mut pair = Pair::new();
    assert_eq!(
        pair.ask(
            ANNA,
            RequestBody::Start {
                strategy: Some("bounce".to_owned())
            }
        ),
        None
    );
    let asked_ms = pair.now_ms;
    pair.run_ms(6000);
    let first_move_ms = pair
        .commands
        .iter()
        .find_map(|(at_ms, command)| {
            matches!(command, Command::Drive(drive) if drive.speed.0 != 0).then_some(*at_ms)
        })
        .expect("it drives");
    let beeps = pair.commands.iter().filter(|(at_ms, command)| {
        *at_ms < first_move_ms && matches!(command, Command::Beep(beep) if beep.pitch.0 > 0)
    });
    assert_eq!(beeps.count(), 3, "S24: three beeps");
    assert!(first_move_ms >= asked_ms + 2000, "S24: two seconds");
    assert_eq!(pair.core.status().state, "cleaning");
}

/// Answers to requests of this component, in order: the reason of a refusal, or nothing.
fn answers(pair: &Pair) -> Vec<Option<&str>> {
    let mut answers = Vec::new();
    for update in &pair.updates {
        match update {
            Update::Done { .. } => answers.push(None),
            Update::Failed(failure) => answers.push(Some(failure.reason.as_str())),
            _ => {}
        }
    }
    answers
}

/// The disk is handed one change after the other, and what it refuses is all that was asked for meanwhile.
#[test]
fn what_is_answered_of_changes_is_what_the_disk_has() {
    let mut pair = Pair::new();
    let reset = || RequestBody::ResetHealth {
        component: "wheel-left".to_owned(),
    };
    pair.updates.clear();
    for _ in 0..24 {
        assert_eq!(pair.ask(ANNA, reset()), None);
    }
    assert_eq!((pair.healths.len(), answers(&pair).len()), (1, 0));
    let kept = |pair: &mut Pair, result| {
        let number = pair.healths.last().expect("was handed over").number;
        pair.handle(Input::HealthKept { number, result });
    };
    kept(&mut pair, Ok(()));
    assert_eq!((pair.healths.len(), answers(&pair).len()), (2, 1));
    kept(&mut pair, Ok(()));
    assert_eq!(answers(&pair), [None; 24]);
    assert_eq!(pair.healths.len(), 2, "nothing is left to hand over");

    pair.updates.clear();
    for _ in 0..3 {
        assert_eq!(pair.ask(ANNA, reset()), None);
    }
    kept(&mut pair, Err("the disk is full".to_owned()));
    assert_eq!(answers(&pair), [Some("health-unwritable"); 3]);
    assert_eq!(pair.healths.len(), 3, "what rests on it is not handed over");
    assert_eq!(pair.ask(ANNA, reset()), None);
    kept(&mut pair, Ok(()));
    assert_eq!(answers(&pair).last(), Some(&None));
}

/// Hours are counted while brushes turn, survive the disk, and what was pressed by mistake is taken back.
#[test]
fn hours_of_parts_are_counted_renewed_and_taken_back() {
    let mut pair = Pair::new();
    let worked_h = |pair: &Pair, name: &str| {
        let parts = pair.core.component_health();
        let part = parts.iter().find(|part| part.component == name);
        part.and_then(|part| part.hours).map(|hours| hours.worked_h)
    };
    // Its main brush turns, and it does not suck.
    pair.state.cleaners = 1;
    pair.run_ms(30_000);
    pair.state.cleaners = 0;
    pair.run_ms(1_000);
    let sensors_h = worked_h(&pair, "sensors").expect("every robot has sensors");
    assert!((sensors_h * 3_600.0 - 30.0).abs() < 0.5, "{sensors_h}");
    assert_eq!(worked_h(&pair, "brush-main"), Some(sensors_h));
    assert_eq!(worked_h(&pair, "filter"), Some(0.0));
    assert_eq!(worked_h(&pair, "brush-sides"), None, "it has none");

    let kept = |pair: &mut Pair| {
        let number = pair.healths.last().expect("was handed over").number;
        pair.handle(Input::HealthKept {
            number,
            result: Ok(()),
        });
    };
    let component = || "sensors".to_owned();
    let undo = || RequestBody::UndoRenewPart {
        component: component(),
    };
    assert_eq!(pair.ask(ANNA, undo()).as_deref(), Some("not-renewed"));
    pair.ask(
        ANNA,
        RequestBody::RenewPart {
            component: component(),
        },
    );
    kept(&mut pair);
    assert_eq!(worked_h(&pair, "sensors"), Some(0.0));
    let stored = pair.healths.last().expect("was handed over").health.clone();
    let next = Health::try_from(stored).expect("can be read");
    let before = next.consumables().work(Consumable::Sensors).before;
    assert!(before.is_some_and(|before| (before.worked_s / 3_600.0 - sensors_h).abs() < 1e-3));
    pair.ask(ANNA, undo());
    kept(&mut pair);
    let back_h = worked_h(&pair, "sensors").expect("is counted");
    assert!((back_h - sensors_h).abs() < 2.0 / 3_600.0, "{back_h}");
    let unknown = RequestBody::RenewPart {
        component: "mop".to_owned(),
    };
    assert_eq!(pair.ask(ANNA, unknown).as_deref(), Some("unknown-component"));
}

/// A shell script sends both in one write, so no telemetry comes between them.
#[test]
fn each_request_sees_what_the_one_before_it_did() {
    let mut pair = Pair::new();
    let start = || RequestBody::Start {
        strategy: Some("bounce".to_owned()),
    };
    assert_eq!(pair.ask(ANNA, start()), None);
    assert_eq!(pair.ask(ANNA, start()).as_deref(), Some("already-running"));
    pair.run_ms(6000);
    for _ in 0..20 {
        assert_eq!(pair.ask(ANNA, RequestBody::Stop), None);
        assert_eq!(pair.ask(ANNA, RequestBody::Pause).as_deref(), Some("no-job"));
        assert_eq!(pair.ask(ANNA, RequestBody::Resume).as_deref(), Some("no-job"));
        assert_eq!(pair.ask(ANNA, start()), None);
        assert_eq!(pair.ask(ANNA, RequestBody::Pause), None);
        assert_eq!(pair.ask(ANNA, RequestBody::Resume), None);
        assert_eq!(pair.ask(ANNA, start()).as_deref(), Some("already-running"));
        pair.run_ms(37);
        assert_ne!(pair.core.status().state, "idle");
    }
    pair.run_ms(6000);
    assert_eq!(pair.core.status().state, "cleaning");
}

#[test]
fn a_lifted_robot_is_not_started() {
    let mut pair = Pair::new();
    pair.state.wheel_drops = WheelDrops {
        left: true,
        right: false,
    };
    pair.state.inhibits.insert(Inhibit::WheelDrop);
    pair.run_ms(100);
    assert_eq!(
        pair.ask(ANNA, RequestBody::Start { strategy: None }).as_deref(),
        Some("wheel-drop")
    );
}

/// A button goes down or up, as events and reports tell it.
fn turn(pair: &mut Pair, button: u8, pressed: bool) {
    let tick = Tick(pair.now_ms as u32);
    pair.robot.queue_event(Event::Button { button, pressed }, tick);
    pair.state.buttons ^= 1 << button;
}

fn hold(pair: &mut Pair, button: u8, for_ms: u64) {
    turn(pair, button, true);
    pair.run_ms(for_ms);
    turn(pair, button, false);
    pair.run_ms(100);
}

/// What followers of the buttons were told since the last question.
fn gestures(pair: &mut Pair) -> Vec<Gesture> {
    let gesture = |update: Update| match update {
        Update::Button { gesture, .. } => Some(gesture),
        _ => None,
    };
    std::mem::take(&mut pair.updates)
        .into_iter()
        .filter_map(gesture)
        .collect()
}

#[test]
fn the_robots_button_starts_and_stops() {
    let mut pair = Pair::new();
    hold(&mut pair, 0, 100);
    assert_eq!(pair.core.status().state, "starting");
    pair.run_ms(5000);
    assert_eq!(pair.core.status().state, "cleaning");
    turn(&mut pair, 0, true);
    pair.run_ms(100);
    assert_eq!(pair.core.status().state, "paused", "while it is down still");
    turn(&mut pair, 0, false);
    pair.run_ms(1000);
    assert_eq!(pair.core.status().state, "paused");
    hold(&mut pair, 0, 100);
    assert_eq!(pair.core.status().state, "starting", "it goes on");
}

/// The maps of its floor cannot be read any more: rooms, zones and places of the new one get numbers that nothing has had.
#[test]
fn a_floor_whose_maps_are_lost_goes_on_with_its_numbers() {
    let next_numbers = NextNumbers {
        room: 9,
        no_go: 5,
        place: 7,
        room_change: 3,
    };
    let mut pair = Pair::with_floors(vec![KeptFloor {
        next_numbers,
        ..KeptFloor::new(1)
    }]);
    assert_eq!(pair.ask(ANNA, RequestBody::Start { strategy: None }), None);
    pair.run_ms(5_000);
    let begun = pair.records.iter().find_map(|record| match record {
        Record::RunStarted(start) => start.checkpoint.home.as_ref(),
        _ => None,
    });
    assert_eq!(begun.expect("a home without cells").next_numbers(), next_numbers);
}

/// A person who sends it home means it: the job waits for nothing.
#[test]
fn the_robots_dock_button_ends_its_job_and_sends_it_home() {
    let mut pair = Pair::new();
    hold(&mut pair, 0, 100);
    pair.run_ms(5000);
    assert_eq!(pair.core.status().state, "cleaning");
    hold(&mut pair, 2, 100);
    pair.run_ms(5000);
    assert_eq!(pair.core.status().state, "docking");
    pair.state.docked = true;
    pair.run_ms(30_000);
    let status = pair.core.status();
    assert_eq!(status.state, "docked");
    assert_eq!(status.reason, "docked", "it waits for nothing");
}

/// A bumper stops the wheels before the brain hears of it, and the commands under way are refused: that is no news. What else is
/// refused is told to people.
#[test]
fn a_refusal_is_a_warning_unless_the_robot_had_just_stopped_by_itself() {
    for (refusal, level) in [
        (Refusal::Inhibited, LogLevel::Debug),
        (Refusal::Range, LogLevel::Warn),
        (Refusal::Absent, LogLevel::Warn),
        (Refusal::Stale, LogLevel::Warn),
    ] {
        let mut pair = Pair::new();
        pair.refuses_to_drive = Some(refusal);
        assert_eq!(pair.push(ANNA, 0.2), None);
        pair.run_ms(100);
        let lines = pair.updates.iter().filter_map(|update| match update {
            Update::Log(entry) if entry.text.contains("the robot refused") => Some(entry),
            _ => None,
        });
        let told: Vec<(LogLevel, bool)> = lines
            .map(|entry| (entry.level, entry.text.ends_with(refusal.name())))
            .collect();
        assert_eq!(told, [(level, true)], "{refusal:?}");
    }
}

/// Buttons of the Linux board, on a robot that reports none.
fn press_on_board(pair: &mut Pair, down: u8, for_ms: u64) {
    pair.handle(Input::BoardButtons { down });
    pair.run_ms(for_ms);
    pair.handle(Input::BoardButtons { down: 0 });
    pair.run_ms(100);
}

#[test]
fn a_button_of_the_linux_board_starts_and_stops_and_lights_show_it() {
    let mut pair = Pair::new();
    let lit = |pair: &Pair| {
        let Lights {
            ready,
            working,
            attention,
        } = pair.core.lights();
        [ready, working, attention]
    };
    pair.run_ms(100);
    assert_eq!(lit(&pair), [true, false, false]);
    press_on_board(&mut pair, 1, 100);
    assert_eq!(pair.core.status().state, "starting");
    assert_eq!(lit(&pair), [false, true, false]);
    pair.run_ms(5000);
    pair.handle(Input::BoardButtons { down: 1 });
    pair.run_ms(100);
    assert_eq!(pair.core.status().state, "paused", "while it is down still");
    assert_eq!(lit(&pair), [true, false, false]);
    pair.handle(Input::BoardButtons { down: 0 });
    pair.run_ms(1000);
    press_on_board(&mut pair, 1, 100);
    assert_eq!(pair.core.status().state, "starting", "it goes on");
}

#[test]
fn holds_on_the_linux_board_mean_what_they_mean_on_the_robot() {
    let mut pair = Pair::new();
    let topics = vec![Topic::Buttons];
    pair.ask(BERT, RequestBody::Watch { topics });
    press_on_board(&mut pair, 0b001, 6_000);
    assert_eq!(gestures(&mut pair), [Gesture::PairingHold]);
    press_on_board(&mut pair, 0b101, 16_000);
    assert_eq!(gestures(&mut pair), [Gesture::RecoveryHold]);
    assert_eq!(pair.core.status().state, "idle");
}

#[test]
fn start_held_to_let_a_device_in_starts_nothing() {
    let mut pair = Pair::new();
    let topics = vec![Topic::Buttons];
    pair.ask(BERT, RequestBody::Watch { topics });
    hold(&mut pair, 0, 20_000);
    assert_eq!(gestures(&mut pair), [Gesture::PairingHold], "told once");
    assert_eq!(pair.core.status().state, "idle");
    hold(&mut pair, 0, 3_000);
    assert_eq!(gestures(&mut pair), []);
    assert_eq!(pair.core.status().state, "idle", "a hold that was given up");
}

#[test]
fn presses_that_a_client_counts_start_nothing_and_still_stop() {
    let mut pair = Pair::new();
    let topics = vec![Topic::Buttons];
    pair.ask(BERT, RequestBody::Watch { topics });
    pair.ask(BERT, RequestBody::ClaimButtons { ms: 60_000 });
    hold(&mut pair, 0, 100);
    assert_eq!(gestures(&mut pair), [Gesture::Press]);
    assert_eq!(pair.core.status().state, "idle");
    pair.ask(ANNA, RequestBody::Start { strategy: None });
    pair.run_ms(5000);
    hold(&mut pair, 0, 100);
    assert_eq!(pair.core.status().state, "paused");
    pair.handle(Input::ClientGone(BERT));
    pair.run_ms(1000);
    hold(&mut pair, 0, 100);
    assert_eq!(pair.core.status().state, "starting", "nobody counts any more");
}

fn tell(pair: &mut Pair, client: ClientId, value: f64) -> Option<String> {
    let values = [("steer".to_owned(), value)].into();
    pair.ask(client, RequestBody::SetInputs { values, ttl: 300 })
}

/// What followers of inputs were told since the last question: names, values and what is left of the leases.
fn heard_inputs(pair: &mut Pair) -> Vec<Vec<(String, f64, u16)>> {
    let inputs = |update: Update| match update {
        Update::Inputs { inputs } => Some(inputs),
        _ => None,
    };
    let told = std::mem::take(&mut pair.updates).into_iter().filter_map(inputs);
    let of_one = |input: rvac_api::ClientInput| (input.name, input.value, input.left_ms);
    told.map(|inputs| inputs.into_iter().map(of_one).collect())
        .collect()
}

#[test]
fn what_a_client_tells_of_inputs_is_heard_and_ends_with_its_lease() {
    let mut pair = Pair::new();
    let steer = |value, left_ms| vec![("steer".to_owned(), value, left_ms)];
    assert_eq!(tell(&mut pair, ANNA, 0.5), None);
    let topics = vec![Topic::Inputs];
    pair.ask(BERT, RequestBody::Watch { topics });
    assert_eq!(
        heard_inputs(&mut pair),
        [steer(0.5, 300)],
        "a new follower hears it at once"
    );
    pair.run_ms(200);
    assert_eq!(tell(&mut pair, ANNA, -1.0), None);
    assert_eq!(tell(&mut pair, BERT, 1.0).as_deref(), Some("input-taken"));
    assert_eq!(heard_inputs(&mut pair), [steer(-1.0, 300)]);
    pair.now_ms += 300;
    let wake_us = pair.core.next_wake_us().expect("a lease runs");
    assert!(
        wake_us <= pair.now_ms * 1000,
        "the core asks to be woken at the end of the lease"
    );
    pair.handle(Input::Wake);
    assert_eq!(heard_inputs(&mut pair), [vec![]]);
    assert_eq!(tell(&mut pair, BERT, 1.0), None, "the name is free again");
    assert_eq!(
        pair.core.status().driver,
        None,
        "whoever tells inputs has no seat"
    );
}

#[test]
fn inputs_of_a_client_that_is_gone_or_silent_are_gone_at_once() {
    for end in [Input::ClientGone(ANNA), Input::ClientSilent(ANNA)] {
        let mut pair = Pair::new();
        let topics = vec![Topic::Inputs];
        pair.ask(BERT, RequestBody::Watch { topics });
        tell(&mut pair, ANNA, 1.0);
        assert_eq!(heard_inputs(&mut pair).len(), 2);
        pair.handle(end);
        assert_eq!(heard_inputs(&mut pair), [vec![]]);
    }
}

#[test]
fn devices_are_forgotten_only_soon_after_the_robot_was_switched_on() {
    let mut pair = Pair::new();
    let topics = vec![Topic::Buttons];
    pair.ask(BERT, RequestBody::Watch { topics });
    let both = |pair: &mut Pair| {
        turn(pair, 0, true);
        hold(pair, 2, 15_500);
        turn(pair, 0, false);
        pair.run_ms(100);
    };
    both(&mut pair);
    assert_eq!(gestures(&mut pair), [Gesture::RecoveryHold]);
    assert_eq!(pair.core.status().state, "idle");
    pair.run_ms(600_000);
    both(&mut pair);
    assert_eq!(gestures(&mut pair), []);
}

#[test]
fn silence_of_the_robot_is_noticed_and_named() {
    let mut pair = Pair::new();
    for _ in 0..50 {
        pair.now_ms += 10;
        pair.handle(Input::Wake);
    }
    let status = pair.core.status();
    assert_eq!(
        (status.state.as_str(), status.reason.as_str()),
        ("disconnected", "link-lost")
    );
    assert_eq!(
        pair.ask(ANNA, RequestBody::Start { strategy: None }).as_deref(),
        Some("link-lost")
    );
}

#[test]
fn inhibits_reach_clients_by_name() {
    let mut pair = Pair::new();
    pair.state.inhibits = Inhibits::NONE;
    pair.state.inhibits.insert(Inhibit::Docked);
    pair.run_ms(100);
    assert_eq!(pair.core.status().inhibits, ["docked"]);
    let told = pair
        .updates
        .iter()
        .any(|update| matches!(update, Update::Status(status) if status.inhibits == ["docked"]));
    assert!(told, "followers hear it");
}

#[test]
fn the_same_inputs_give_the_same_outputs() {
    let run = || {
        let mut pair = Pair::new();
        pair.ask(ANNA, RequestBody::Start { strategy: None });
        pair.run_ms(4000);
        pair.state.bumpers.left = true;
        pair.run_ms(300);
        pair.state.bumpers.left = false;
        pair.run_ms(3000);
        (format!("{:?}", pair.commands), format!("{:?}", pair.records))
    };
    assert_eq!(run(), run());
}

#[test]
fn records_hold_all_that_the_brain_needs_to_decide_the_same_again() {
    let mut pair = Pair::new();
    pair.push(ANNA, 0.1);
    pair.run_ms(200);
    pair.ask(ANNA, RequestBody::Release);
    pair.run_ms(300);
    pair.ask(ANNA, RequestBody::Start { strategy: None });
    pair.run_ms(4000);
    pair.state.bumpers.right = true;
    pair.run_ms(2000);
    let mut brain = None;
    let mut commands = Vec::new();
    let mut answer = None;
    let mut runs = 0;
    let mut compared = 0;
    for record in &pair.records {
        match record {
            Record::RunStarted(start) => {
                let mut fresh = brain::Brain::new(start.brain, start.seed);
                fresh.restore(&start.checkpoint);
                brain = Some(fresh);
                runs += 1;
            }
            Record::Command { command, .. } => commands.push(command.clone()),
            Record::Observation(observation) => {
                answer = brain.as_mut().map(|brain| brain.step(observation, &commands));
                commands.clear();
            }
            Record::Actions { actions, .. } => {
                assert_eq!(answer.as_ref(), Some(actions));
                compared += 1;
            }
            _ => {}
        }
    }
    assert_eq!(runs, 2, "one by hand, one job");
    assert!(compared > 300, "{compared} steps");
}

#[test]
fn a_gyro_on_the_board_gives_the_heading_and_is_missed_when_it_falls_silent() {
    let mut pair = Pair::new();
    // The robot's own gyro says something else, and does not count any more.
    pair.state.gyro = Some(Gyro {
        heading: Angle(777_777),
        rate: AngularSpeed(0),
    });
    pair.drive(ANNA, 0.0);
    for step in 0..10 {
        pair.handle(Input::BoardHeading {
            heading_urad: i32::MAX.wrapping_add(step * 1000),
        });
        pair.run_ms(PERIOD_MS);
    }
    let heard = pair.headings();
    let known: Vec<f64> = heard.iter().flatten().copied().collect();
    assert_eq!(known.first(), Some(&0.0), "the first word is the origin");
    let last_rad = heard.last().copied().flatten().expect("still there");
    assert!((last_rad - 0.009).abs() < 1e-9, "across the wrap: {last_rad}");
    pair.records.clear();
    pair.run_ms(400);
    assert_eq!(pair.headings().last(), Some(&None), "silent for 0.2 s and more");
}

fn kept_home() -> StoredMap {
    let floor = Raster::filled(Cell { x: 100, y: 100 }, 40, 40, CellKnowledge::Free);
    let dock = Pose2 {
        x_m: 3.0,
        y_m: 2.75,
        heading_rad: 1.0,
    };
    StoredMap::from_raster(&floor, Some(dock))
}

#[test]
fn a_kept_home_is_taken_up_on_the_dock_and_kept_again() {
    let mut pair = Pair::in_home(Some(kept_home()));
    assert_eq!(
        pair.core.pose().x,
        0.0,
        "off the dock it does not know where it is"
    );
    pair.state.docked = true;
    pair.run_ms(100);
    let pose = pair.core.pose();
    assert!(
        (pose.x - 3.0).abs() < 1e-6 && (pose.heading - 1.0).abs() < 1e-6,
        "{pose:?}"
    );
    let topics = vec![Topic::Home];
    pair.ask(BERT, RequestBody::Watch { topics });
    let view = pair.updates.iter().rev().find_map(|update| match update {
        Update::Home(view) => Some(view),
        _ => None,
    });
    let view = view.expect("a view at once");
    let free = view.cells.chunks(2).filter(|run| run[0] == 1).map(|run| run[1]);
    assert_eq!(free.sum::<u32>(), 1600);
    assert!(view.rooms.len() == 1 && (view.rooms[0].area_m2 - 1.0).abs() < 1e-9);
    assert!(view.dock.is_some());
    pair.handle(Input::Shutdown);
    let kept = pair.homes.pop().expect("a map to keep").home.knowledge();
    let known = kept.values().iter().filter(|kind| **kind == CellKnowledge::Free);
    assert_eq!(known.count(), 1600);
}

#[test]
fn a_robot_that_never_saw_its_dock_does_not_overwrite_the_home() {
    let mut pair = Pair::in_home(Some(kept_home()));
    pair.run_ms(1000);
    pair.handle(Input::Shutdown);
    assert_eq!(pair.homes, []);
    let mut stranger = Pair::new();
    stranger.run_ms(500);
    // Without anything that tells its heading it would draw no map.
    stranger.handle(Input::BoardHeading { heading_urad: 0 });
    stranger.run_ms(500);
    stranger.handle(Input::Shutdown);
    assert_eq!(stranger.homes.len(), 1, "without a home the first map is kept");
}

#[test]
fn a_map_is_restored_at_rest_only_and_taken_up_on_the_dock() {
    let mut pair = Pair::new();
    let restore = || RequestBody::RestoreMap {
        number: 4,
        floor: None,
    };
    assert_eq!(pair.ask(ANNA, RequestBody::Start { strategy: None }), None);
    pair.run_ms(200);
    assert_eq!(pair.ask(ANNA, restore()).as_deref(), Some("job-runs"));
    assert_eq!(pair.orders, []);
    pair.ask(ANNA, RequestBody::Stop);
    pair.run_ms(200);
    assert_eq!(pair.ask(ANNA, restore()), None);
    let order = MapOrder::Restore {
        client: ANNA,
        id: Some(1),
        floor: 1,
        number: 4,
    };
    assert_eq!(pair.orders, [order]);
    pair.homes.clear();
    pair.handle(Input::MapRestored {
        floor: 1,
        number: 4,
        home: kept_home(),
    });
    pair.run_ms(200);
    assert_eq!(
        pair.core.pose().x,
        0.0,
        "off the dock it does not know where in it it is"
    );
    pair.state.docked = true;
    pair.run_ms(200);
    assert!((pair.core.pose().x - 3.0).abs() < 1e-6, "{:?}", pair.core.pose());
    assert_eq!(pair.homes, [], "what was drawn before is not kept over it");
}

#[test]
fn who_watches_the_home_sees_each_map_that_is_restored_on_the_dock() {
    let mut pair = Pair::in_home(Some(kept_home()));
    pair.state.docked = true;
    // What people see of the home is told every five seconds, unless they have changed it.
    pair.run_ms(6000);
    let topics = vec![Topic::Home];
    pair.ask(ANNA, RequestBody::Watch { topics });
    let mut revisions = Vec::new();
    for (number, width) in [(4, 60), (2, 80), (3, 100)] {
        pair.updates.clear();
        let floor = Raster::filled(Cell { x: 0, y: 0 }, width, 50, CellKnowledge::Free);
        let dock = Pose2 {
            x_m: 0.5,
            y_m: 0.5,
            heading_rad: 0.0,
        };
        pair.handle(Input::MapRestored {
            floor: 1,
            number,
            home: StoredMap::from_raster(&floor, Some(dock)),
        });
        pair.run_ms(500);
        let told = pair.updates.iter().rev().find_map(|update| match update {
            Update::Home(view) => Some(view.clone()),
            _ => None,
        });
        let told = told.expect("the map is another one");
        let free = told.cells.chunks(2).filter(|run| run[0] == 1).map(|run| run[1]);
        assert_eq!(free.sum::<u32>() as usize, 50 * width, "map {number}");
        revisions.push(told.revision);
    }
    assert!(revisions.is_sorted_by(|one, next| one < next), "{revisions:?}");
}

/// Two rooms' worth of floor around a dock, and a gyro.
fn on_the_dock() -> Pair {
    let floor = Raster::filled(Cell { x: 0, y: 0 }, 160, 120, CellKnowledge::Free);
    let dock = Pose2 {
        x_m: 2.0,
        y_m: 0.5,
        heading_rad: 1.5,
    };
    let mut pair = Pair::in_home(Some(StoredMap::from_raster(&floor, Some(dock))));
    pair.state.docked = true;
    pair.handle(Input::BoardHeading { heading_urad: 0 });
    pair.run_ms(100);
    pair
}

/// The robot leaves its dock for a job, and cleans for some seconds.
fn drive_off(pair: &mut Pair) {
    pair.state.docked = false;
    for _ in 0..80 {
        pair.handle(Input::BoardHeading { heading_urad: 0 });
        pair.run_ms(50);
    }
}

fn wall(from: [f64; 2], to: [f64; 2]) -> RequestBody {
    RequestBody::AddNoGo {
        shape: NoGoShape::Wall([from, to]),
        name: None,
    }
}

fn clean(parts: Vec<JobPart>, passes: u8) -> JobOrder {
    JobOrder {
        parts,
        passes,
        ..JobOrder::default()
    }
}

#[test]
fn a_change_of_the_map_goes_to_the_disk_before_anybody_hears_that_it_is_done() {
    let mut pair = on_the_dock();
    let name = RequestBody::NameRoom(RoomNaming {
        room: 1,
        name: Some("Kitchen".to_owned()),
    });
    let before = pair.updates.len();
    assert_eq!(pair.ask(ANNA, name), None);
    assert_eq!(pair.ask(BERT, wall([3.0, 1.0], [3.0, 2.0])), None);
    pair.run_ms(200);
    let is_done = |update: &Update| matches!(update, Update::Done { .. });
    assert!(
        !pair.updates[before..].iter().any(is_done),
        "the shell says so, later"
    );
    let askers: Vec<_> = pair.edits.iter().map(|edit| (edit.client, edit.id)).collect();
    assert_eq!(askers, [(ANNA, Some(1)), (BERT, Some(1))]);
    let words = pair.edits[1].home.home.annotations();
    assert_eq!(words.name(1).map(brain::RoomName::as_str), Some("Kitchen"));
    assert_eq!(words.no_go().count(), 1);
    let topics = vec![Topic::Home];
    pair.ask(BERT, RequestBody::Watch { topics });
    let told = pair.updates.iter().rev().find_map(|update| match update {
        Update::Home(view) => Some(view),
        _ => None,
    });
    let told = told.expect("a view at once");
    assert_eq!(told.rooms[0].name.as_deref(), Some("Kitchen"));
    assert_eq!(told.no_go[0].shape, NoGoShape::Wall([[3.0, 1.0], [3.0, 2.0]]));
}

/// Both are admitted before the next step of the brain, and the first one takes the wall away.
#[test]
fn an_edit_that_cannot_be_made_any_more_is_refused_by_its_name() {
    let mut pair = on_the_dock();
    assert_eq!(pair.ask(ANNA, wall([3.0, 1.0], [3.0, 2.0])), None);
    pair.run_ms(200);
    pair.edits.clear();
    let before = pair.updates.len();
    let removal = || RequestBody::RemoveNoGo { number: 1 };
    assert_eq!(pair.ask(ANNA, removal()), None);
    assert_eq!(pair.ask(BERT, removal()), None);
    pair.run_ms(200);
    let askers: Vec<_> = pair.edits.iter().map(|edit| (edit.client, edit.id)).collect();
    assert_eq!(askers, [(ANNA, Some(1))]);
    assert_eq!(failures(&pair.updates[before..]), [(Some(1), "no-such-no-go")]);
    let logged = |line: &&str| line.contains("client-2 is refused (no-such-no-go)");
    assert!(pair.log_lines().iter().any(logged));
}

#[test]
fn an_edit_of_a_map_that_the_robot_has_left_is_refused_and_not_made_in_another_one() {
    let mut pair = Pair::with_floors(vec![floor_with_dock(1, 1.0), floor_with_dock(2, 2.0)]);
    pair.state.docked = true;
    assert_eq!(pair.ask(ANNA, RequestBody::ChooseFloor { floor: 1 }), None);
    pair.run_ms(200);
    let before = pair.updates.len();
    assert_eq!(pair.ask(ANNA, wall([0.5, 1.0], [0.5, 2.0])), None);
    assert_eq!(pair.ask(BERT, RequestBody::ChooseFloor { floor: 2 }), None);
    pair.run_ms(200);
    assert_eq!(pair.core.floors_view().here, Some(2));
    assert!(pair.edits.is_empty());
    assert_eq!(failures(&pair.updates[before..]), [(Some(1), "map-not-taken-up")]);
}

/// Requests that were refused, by their numbers, and why.
fn failures(updates: &[Update]) -> Vec<(Option<u32>, &str)> {
    let failures = updates.iter().filter_map(|update| match update {
        Update::Failed(failure) => Some((failure.id, failure.reason.as_str())),
        _ => None,
    });
    failures.collect()
}

#[test]
fn forbidden_floor_has_a_name_that_no_other_has() {
    let mut pair = on_the_dock();
    let named = |name: &str| match wall([3.0, 1.0], [3.0, 2.0]) {
        RequestBody::AddNoGo { shape, .. } => RequestBody::AddNoGo {
            shape,
            name: Some(name.to_owned()),
        },
        other => other,
    };
    let naming = |number, name: Option<&str>| RequestBody::NameNoGo {
        number,
        name: name.map(str::to_owned),
    };
    assert_eq!(pair.ask(ANNA, named(" Cats ")), None);
    pair.run_ms(200);
    assert_eq!(pair.ask(ANNA, named("cats")).as_deref(), Some("name-taken"));
    assert_eq!(pair.ask(ANNA, named("two\nlines")).as_deref(), Some("bad-name"));
    assert_eq!(
        pair.ask(ANNA, naming(7, Some("Dogs"))).as_deref(),
        Some("no-such-no-go")
    );
    assert_eq!(pair.ask(ANNA, wall([3.5, 1.0], [3.5, 2.0])), None);
    pair.run_ms(200);
    assert_eq!(
        pair.ask(ANNA, naming(2, Some("CATS"))).as_deref(),
        Some("name-taken")
    );
    assert_eq!(pair.ask(ANNA, naming(1, None)), None);
    pair.run_ms(200);
    assert_eq!(pair.ask(ANNA, naming(2, Some("Cats"))), None);
    pair.run_ms(200);
    let words = pair.edits.last().expect("kept").home.home.annotations();
    let names: Vec<_> = words.no_go().map(|(_, no_go)| no_go.name()).collect();
    assert_eq!(names[0], None);
    assert_eq!(names[1].map(brain::RoomName::as_str), Some("Cats"));
}

#[test]
fn forbidden_floor_is_reshaped_under_its_number_and_name() {
    let mut pair = on_the_dock();
    let at = |x: f64| NoGoShape::Wall([[x, 1.0], [x, 2.0]]);
    let added = RequestBody::AddNoGo {
        shape: at(3.0),
        name: Some("Cats".to_owned()),
    };
    assert_eq!(pair.ask(ANNA, added), None);
    pair.run_ms(200);
    let reshaped = |number, shape| RequestBody::ReshapeNoGo {
        number,
        shape,
        was: None,
    };
    let refused = [
        (reshaped(7, at(3.5)), "no-such-no-go"),
        (reshaped(1, at(90.0)), "no-floor-there"),
        (reshaped(1, NoGoShape::Wall([[3.0, 1.0], [3.0, 1.0]])), "bad-zone"),
    ];
    for (body, reason) in refused {
        assert_eq!(pair.ask(ANNA, body.clone()).as_deref(), Some(reason), "{body:?}");
    }
    assert_eq!(pair.edits.len(), 1, "what is refused changes nothing");
    assert_eq!(pair.ask(ANNA, reshaped(1, at(3.5))), None);
    pair.run_ms(200);
    let words = pair.edits.last().expect("kept").home.home.annotations();
    let known: Vec<_> = words.no_go().collect();
    let &[(1, no_go)] = known.as_slice() else {
        panic!("{known:?}");
    };
    assert_eq!(no_go.name().map(brain::RoomName::as_str), Some("Cats"));
    assert_eq!(*no_go, wall_at(3.5).with_name(no_go.name().cloned()));
}

fn wall_at(x_m: f64) -> brain::NoGo {
    let end = |y_m| brain::Point2 { x_m, y_m };
    brain::NoGo::wall(end(1.0), end(2.0)).expect("two places")
}

fn keep(name: &str, middle: [f64; 2]) -> RequestBody {
    RequestBody::KeepPlace {
        name: name.to_owned(),
        shape: PlaceShape::Spot(middle),
        number: None,
    }
}

#[test]
fn a_kept_place_is_cleaned_by_its_number_and_comes_back_under_it() {
    let mut pair = on_the_dock();
    let cleaning = |number| clean(vec![JobPart::Place(number)], 1);
    assert_eq!(
        pair.ask(ANNA, RequestBody::Clean(cleaning(1))).as_deref(),
        Some("no-such-place")
    );
    assert_eq!(pair.ask(ANNA, keep("Bowl", [3.0, 1.5])), None);
    pair.run_ms(200);
    let refused = [
        (keep(" bowl", [3.0, 1.5]), "name-taken"),
        (keep("", [3.0, 1.5]), "bad-name"),
        (keep("Far", [90.0, 1.5]), "no-floor-there"),
        (keep("Far", [900.0, 1.5]), "bad-zone"),
        (RequestBody::ForgetPlace { number: 2 }, "no-such-place"),
    ];
    for (body, reason) in refused {
        assert_eq!(pair.ask(ANNA, body.clone()).as_deref(), Some(reason), "{body:?}");
    }
    assert_eq!(pair.ask(ANNA, RequestBody::ForgetPlace { number: 1 }), None);
    pair.run_ms(200);
    let again = |number| RequestBody::KeepPlace {
        name: "Bowl".to_owned(),
        shape: PlaceShape::Spot([3.0, 1.5]),
        number: Some(number),
    };
    assert_eq!(pair.ask(ANNA, again(7)).as_deref(), Some("no-such-place"));
    assert_eq!(pair.ask(ANNA, again(1)), None);
    pair.run_ms(200);
    let renamed = RequestBody::NamePlace {
        number: 1,
        name: "Dish".to_owned(),
    };
    assert_eq!(pair.ask(ANNA, renamed), None);
    pair.run_ms(200);
    let moved = |number, y| RequestBody::ReshapePlace {
        number,
        shape: PlaceShape::Spot([3.0, y]),
        was: None,
    };
    assert_eq!(pair.ask(ANNA, moved(2, 1.2)).as_deref(), Some("no-such-place"));
    assert_eq!(pair.ask(ANNA, moved(1, 90.0)).as_deref(), Some("no-floor-there"));
    assert_eq!(pair.ask(ANNA, moved(1, 1.2)), None);
    pair.run_ms(200);
    let words = pair.edits.last().expect("kept").home.home.annotations();
    let place = words.place(1).expect("is kept");
    assert_eq!((place.name().as_str(), words.places().count()), ("Dish", 1));
    let spot = brain::Point2 { x_m: 3.0, y_m: 1.2 };
    assert_eq!(*place.shape(), brain::PlaceShape::Spot(spot));
    let estimate = pair.ask(ANNA, RequestBody::Estimate(cleaning(1)));
    assert_eq!(estimate, None);
    assert_eq!(pair.ask(ANNA, RequestBody::Clean(cleaning(1))), None);
}

/// Two people began from the same view; the one who is later must see what the other has done.
#[test]
fn a_change_of_what_somebody_else_has_changed_meanwhile_is_refused() {
    let mut pair = on_the_dock();
    assert_eq!(pair.ask(ANNA, keep("Bowl", [3.0, 1.5])), None);
    pair.run_ms(200);
    let spot = |y| PlaceShape::Spot([3.0, y]);
    let moved = |was: Option<f64>, y| RequestBody::ReshapePlace {
        number: 1,
        shape: spot(y),
        was: was.map(spot),
    };
    assert_eq!(pair.ask(ANNA, moved(Some(1.5), 1.2)), None);
    assert_eq!(
        pair.ask(BERT, moved(Some(1.5), 1.4)).as_deref(),
        Some("changed-meanwhile"),
        "before the next step of the brain"
    );
    pair.run_ms(200);
    assert_eq!(
        pair.ask(BERT, moved(Some(1.5), 1.4)).as_deref(),
        Some("changed-meanwhile")
    );
    assert_eq!(pair.ask(BERT, moved(Some(1.2), 1.4)), None);
    pair.run_ms(200);
    assert_eq!(pair.ask(BERT, moved(None, 1.3)), None, "whatever it is");
    pair.run_ms(200);

    let twice = RoomSettings {
        passes: 2,
        ..RoomSettings::default()
    };
    let set = |was, settings| RequestBody::SetRoom {
        room: 1,
        settings,
        was: Some(RoomBefore { settings: was }),
    };
    assert_eq!(pair.ask(ANNA, set(None, Some(twice))), None);
    pair.run_ms(200);
    assert_eq!(
        pair.ask(BERT, set(None, None)).as_deref(),
        Some("changed-meanwhile")
    );
    assert_eq!(pair.ask(BERT, set(Some(twice), None)), None);
}

/// A client that floods the daemon with estimates delays nobody: it is refused, and others are answered at once.
#[test]
fn estimates_wait_for_their_turn_and_stop_does_not() {
    let mut pair = on_the_dock();
    let whole = JobPart::Zone(vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    let ask = |pair: &mut Pair| pair.ask(ANNA, RequestBody::Estimate(clean(vec![whole.clone()], 1)));
    let answers: Vec<Option<String>> = (0..30).map(|_| ask(&mut pair)).collect();
    let refused = answers
        .iter()
        .filter(|answer| answer.as_deref() == Some("too-many-estimates"));
    assert_eq!(refused.count(), 25, "one is being made, four wait");
    let made = |pair: &Pair| {
        let is_estimate = |update: &&Update| matches!(update, Update::JobEstimate(_));
        pair.updates.iter().filter(is_estimate).count()
    };
    assert_eq!(made(&pair), 0, "each is made in steps");
    assert_eq!(pair.ask(BERT, RequestBody::Stop), None);
    assert_eq!(made(&pair), 0, "Stop does not wait for them");
    pair.run_ms(3_000);
    assert_eq!(made(&pair), 5, "all that were taken are answered");
}

fn dock_at(x: f64, y: f64) -> RequestBody {
    RequestBody::MoveDock { x, y, heading: 0.5 }
}

/// What nobody can mean is refused by its name, and no sentence about it has hundreds of digits.
#[test]
fn numbers_out_of_range_are_refused_in_short_sentences() {
    let mut pair = on_the_dock();
    let dock = |x, y, heading| RequestBody::MoveDock { x, y, heading };
    let runs = |count| RequestBody::Runs {
        before: None,
        count: Some(count),
    };
    let far = vec![[0.0, 0.0], [1e300, 0.0], [0.0, -1e300]];
    let requests = [
        dock(1.0, 1.0, 1e300),
        dock(1.0, 1.0, 7.0),
        dock(1e300, 1.0, 0.0),
        runs(0),
        runs(255),
        RequestBody::Clean(clean(vec![JobPart::Zone(far.clone())], 1)),
        RequestBody::Clean(clean(vec![JobPart::Spot([1e300, 0.0])], 1)),
        RequestBody::AddNoGo {
            shape: NoGoShape::Zone(far),
            name: None,
        },
    ];
    for request in requests {
        let before = pair.updates.len();
        let refused = pair.ask(ANNA, request.clone());
        assert!(refused.is_some(), "{request:?}");
        for update in &pair.updates[before..] {
            if let Update::Failed(failure) = update {
                assert!(failure.text.len() < 200, "{request:?}: {}", failure.text);
            }
        }
        pair.run_ms(100);
        assert_eq!(pair.core.status().state, "docked", "{request:?}");
    }
}

#[test]
fn a_dock_that_was_moved_is_kept_and_a_robot_on_it_was_carried_along() {
    let mut pair = on_the_dock();
    assert_eq!(pair.ask(ANNA, dock_at(3.0, 1.0)), None);
    pair.run_ms(200);
    assert_eq!(pair.edits.len(), 1);
    let kept = pair.edits[0].home.home.dock_location();
    assert_eq!(
        (kept.pose().map(|pose| pose.x_m), kept.is_reported()),
        (Some(3.0), true)
    );
    let pose = pair.core.pose();
    assert!(
        (pose.x - 3.0).abs() < 1e-6 && (pose.heading - 0.5).abs() < 1e-6,
        "{pose:?}"
    );
    // A run begins where the robot stands, and nothing has confirmed that yet.
    assert_eq!(pair.ask(ANNA, RequestBody::Clean(clean(Vec::new(), 1))), None);
    pair.run_ms(500);
    let topics = vec![Topic::Home];
    pair.ask(BERT, RequestBody::Watch { topics });
    let told = pair.updates.iter().rev().find_map(|update| match update {
        Update::Home(view) => Some(view.dock_reported),
        _ => None,
    });
    assert_eq!(told, Some(true));
    assert_eq!(pair.ask(ANNA, RequestBody::Stop), None);
    pair.run_ms(500);
    let taken_back = RequestBody::MoveDock {
        x: 2.0,
        y: 0.5,
        heading: 1.5,
    };
    assert_eq!(pair.ask(ANNA, taken_back), None);
    pair.run_ms(200);
    assert!(!pair.edits[1].home.home.dock_location().is_reported());
    assert!((pair.core.pose().x - 2.0).abs() < 1e-6);
}

#[test]
fn a_dock_stands_on_floor_beside_what_is_forbidden_and_is_not_moved_while_a_job_runs() {
    let mut pair = on_the_dock();
    assert_eq!(
        pair.ask(ANNA, dock_at(9.0, 1.0)).as_deref(),
        Some("no-floor-there")
    );
    assert_eq!(pair.ask(ANNA, wall([3.0, 1.0], [3.0, 2.0])), None);
    pair.run_ms(200);
    assert_eq!(pair.ask(ANNA, dock_at(3.1, 1.5)).as_deref(), Some("dock-inside"));
    assert_eq!(pair.ask(ANNA, RequestBody::Clean(clean(Vec::new(), 1))), None);
    drive_off(&mut pair);
    assert_eq!(pair.ask(ANNA, dock_at(1.0, 1.0)).as_deref(), Some("job-runs"));
    assert_eq!(pair.edits.len(), 1, "only the wall is kept");
}

fn split(room: Option<u16>, line: [[f64; 2]; 2]) -> RequestBody {
    RequestBody::SplitRoom(RoomSplitting { room, line })
}

#[test]
fn rooms_are_split_and_joined_at_rest_and_kept_before_anybody_hears_that_it_is_done() {
    let mut pair = on_the_dock();
    let across = [[2.5, 0.25], [2.5, 2.5]];
    assert_eq!(pair.ask(ANNA, split(None, across)), None);
    pair.run_ms(200);
    assert_eq!(pair.edits.len(), 1);
    assert_eq!(pair.edits[0].home.home.room_count(), 2);
    let topics = vec![Topic::Home];
    pair.ask(BERT, RequestBody::Watch { topics });
    let told = |pair: &Pair| {
        let last = pair.updates.iter().rev().find_map(|update| match update {
            Update::Home(view) => Some(view.clone()),
            _ => None,
        });
        last.expect("a view")
    };
    let view = told(&pair);
    assert_eq!(view.rooms.len(), 2);
    let change = view.room_changes[0];
    assert_eq!(
        (change.number, change.rooms, change.line),
        (1, [1, 2], Some(across))
    );
    assert_eq!(pair.ask(ANNA, RequestBody::JoinRooms { rooms: [1, 2] }), None);
    pair.run_ms(200);
    assert_eq!(pair.edits[1].home.home.room_count(), 1);
    assert_eq!(pair.ask(ANNA, RequestBody::UndoRoomChange { number: 2 }), None);
    pair.run_ms(200);
    assert_eq!(pair.edits[2].home.home.room_count(), 2);
    let half = clean(vec![JobPart::Room(2)], 1);
    assert_eq!(pair.ask(ANNA, RequestBody::Clean(half)), None);
    // Also while the home of the run is still being made ready.
    assert_eq!(
        pair.ask(BERT, RequestBody::UndoRoomChange { number: 1 })
            .as_deref(),
        Some("job-runs")
    );
}

#[test]
fn a_change_of_rooms_that_cannot_be_says_what_is_wrong_with_it() {
    let mut pair = on_the_dock();
    assert_eq!(pair.ask(ANNA, split(None, [[1.0, 0.1], [1.0, 2.9]])), None);
    assert_eq!(pair.ask(ANNA, split(None, [[3.0, 0.1], [3.0, 2.9]])), None);
    pair.run_ms(200);
    let join = |rooms| RequestBody::JoinRooms { rooms };
    let cases = [
        (
            split(None, [[9.0, 0.0], [9.0, 1.0]]),
            "line-misses-room",
            "x 9.00 m, y 0.00 m",
        ),
        (
            split(Some(1), [[0.2, 0.1], [0.2, 2.9]]),
            "line-misses-room",
            "does not cut room 1",
        ),
        (
            split(Some(7), [[2.0, 0.1], [2.0, 2.9]]),
            "no-such-room",
            "has the rooms 1, 2, 3",
        ),
        (
            split(None, [[2.0, 1.0], [2.0, 1.2]]),
            "line-ends-in-room",
            "a way round it",
        ),
        (
            split(None, [[0.1, 0.1], [0.1, 2.9]]),
            "part-too-small",
            "half a square metre",
        ),
        (split(None, [[1e9, 0.0], [0.0, 0.0]]), "bad-line", "within 500 m"),
        (join([2, 3]), "rooms-apart", "beside room 2 lie 1"),
        (join([2, 2]), "rooms-apart", "name two rooms"),
        (join([2, 8]), "no-such-room", "no room 8"),
        (
            RequestBody::UndoRoomChange { number: 1 },
            "room-change-in-use",
            "take 2 back first",
        ),
        (
            RequestBody::UndoRoomChange { number: 9 },
            "no-such-room-change",
            "there are 1, 2",
        ),
    ];
    for (request, reason, words) in cases {
        let what = format!("{request:?}");
        assert_eq!(pair.ask(ANNA, request).as_deref(), Some(reason), "{what}");
        let text = pair.updates.iter().rev().find_map(|update| match update {
            Update::Failed(failure) => Some(failure.text.clone()),
            _ => None,
        });
        let text = text.expect("a sentence");
        assert!(text.contains(words), "{what}: {text}");
    }
}

#[test]
fn an_estimate_is_made_at_rest_and_a_part_is_cleaned() {
    let mut pair = on_the_dock();
    let zone = || JobPart::Zone(vec![[1.0, 1.0], [3.0, 1.0], [3.0, 2.0], [1.0, 2.0]]);
    assert_eq!(
        pair.ask(ANNA, RequestBody::Estimate(clean(vec![zone()], 2))),
        None
    );
    pair.run_ms(200);
    let found = pair.updates.iter().find_map(|update| match update {
        Update::JobEstimate(found) => Some(*found),
        _ => None,
    });
    let found = found.expect("an estimate");
    assert!(
        found.id == Some(1) && (1.7..2.3).contains(&found.floor_m2),
        "{found:?}"
    );
    assert!(
        found.time_s > 10.0 && found.charge > 0.0 && found.share_low > 0.5,
        "{found:?}"
    );
    pair.records.clear();
    assert_eq!(pair.ask(ANNA, RequestBody::Clean(clean(vec![zone()], 2))), None);
    for _ in 0..10 {
        // The gyro on the board goes on to say that nothing turns.
        pair.handle(Input::BoardHeading { heading_urad: 0 });
        pair.run_ms(50);
    }
    assert_eq!(pair.core.status().state, "starting");
    let refused = pair.ask(ANNA, RequestBody::Estimate(clean(vec![], 1)));
    assert_eq!(refused.as_deref(), Some("job-runs"));
    // A change in the middle of a run is in its recording, like every command.
    assert_eq!(pair.ask(ANNA, wall([3.2, 1.0], [3.2, 2.0])), None);
    pair.run_ms(200);
    let commands: Vec<_> = pair
        .records
        .iter()
        .filter_map(|record| match record {
            Record::Command { command, .. } => Some(command),
            _ => None,
        })
        .collect();
    assert!(
        matches!(commands[0], brain::Command::Job(JobCommand::CleanParts { order }) if order.passes() == 2)
    );
    assert!(matches!(
        commands[1],
        brain::Command::Edit(brain::MapEdit::NoGo(brain::NoGoEdit::Add(_)))
    ));
    assert_eq!(pair.edits.len(), 1);
}

#[test]
fn what_is_said_while_the_home_of_a_run_is_made_ready_comes_after_the_order_and_none_is_done_before() {
    let mut pair = on_the_dock();
    assert_eq!(pair.ask(ANNA, RequestBody::Clean(clean(vec![], 1))), None);
    assert_eq!(pair.ask(BERT, wall([3.2, 1.0], [3.2, 2.0])), None);
    pair.run_ms(2);
    let now = pair.core.status().state;
    assert!(
        now == "docked" && pair.edits.is_empty(),
        "{now}, {} edits",
        pair.edits.len()
    );
    assert_eq!(pair.ask(ANNA, RequestBody::Stop), None);
    pair.run_ms(1000);
    assert_eq!(pair.core.status().state, "docked");
    let edit = pair.edits.first().expect("is kept with the map that has it");
    assert_eq!(edit.home.home.annotations().no_go().count(), 1);
    let said: Vec<_> = pair
        .records
        .iter()
        .filter_map(|record| match record {
            Record::RunStarted(_) => Some("run"),
            Record::Command { command, .. } => Some(match command {
                brain::Command::Job(JobCommand::CleanParts { .. } | JobCommand::Clean { .. }) => "clean",
                brain::Command::Edit(brain::MapEdit::NoGo(brain::NoGoEdit::Add(_))) => "wall",
                brain::Command::Job(JobCommand::Stop) => "stop",
                _ => "other",
            }),
            _ => None,
        })
        .collect();
    assert_eq!(said, ["run", "clean", "wall", "stop"]);
}

#[test]
fn in_a_known_home_a_stick_that_was_in_the_centre_after_a_stop_drives_on() {
    let mut pair = on_the_dock();
    pair.state.docked = false;
    pair.run_ms(200);
    assert_eq!(pair.ask(ANNA, RequestBody::Stop), None);
    pair.run_ms(200);
    assert_eq!(pair.drive(ANNA, 0.1).as_deref(), Some("centre-first"));
    assert_eq!(pair.drive(ANNA, 0.0), None);
    assert_eq!(
        pair.drive(ANNA, 0.1),
        None,
        "while the home of the run is made ready"
    );
    assert_eq!(pair.ask(BERT, RequestBody::Stop), None);
    assert_eq!(
        pair.drive(ANNA, 0.1).as_deref(),
        Some("centre-first"),
        "after another stop"
    );
    pair.run_ms(500);
    assert_ne!(pair.core.status().state, "manual");
    assert_eq!(pair.drive(ANNA, 0.0), None);
    pair.run_ms(100);
    assert_eq!(pair.drive(ANNA, 0.1), None);
    pair.run_ms(100);
    assert_eq!(pair.core.status().state, "manual");
}

#[test]
fn an_order_that_cannot_be_says_what_is_wrong_with_it() {
    let mut pair = on_the_dock();
    let name = |name: &str| {
        RequestBody::NameRoom(RoomNaming {
            room: 1,
            name: Some(name.to_owned()),
        })
    };
    let far = || JobPart::Zone(vec![[90.0, 0.0], [91.0, 0.0], [91.0, 1.0]]);
    let spot = || JobPart::Spot([90.0, 0.0]);
    let thin = || JobPart::Zone(vec![[0.0, 0.0], [1.0, 0.0]]);
    let cases = [
        (
            RequestBody::Clean(clean(vec![JobPart::Room(7)], 1)),
            "no-such-room",
            "has the rooms 1",
        ),
        (RequestBody::Clean(clean(vec![], 9)), "bad-order", "9 passes"),
        (
            RequestBody::Clean(clean(vec![far()], 1)),
            "no-floor-there",
            "x 0.0 to 4.0 m",
        ),
        (
            RequestBody::Clean(clean(vec![JobPart::Room(1), spot()], 1)),
            "no-floor-there",
            "zones and spots",
        ),
        (
            RequestBody::Estimate(clean(vec![thin()], 1)),
            "bad-zone",
            "Part 1 is a zone with 2 corners",
        ),
        (wall([1.0, 1.0], [1.0, 1.0]), "bad-zone", "two places"),
        (wall([900.0, 1.0], [1.0, 1.0]), "bad-zone", "within 500 m"),
        (wall([1.5, 0.6], [2.5, 0.6]), "dock-inside", "x 2.00 m, y 0.50 m"),
        (RequestBody::RemoveNoGo { number: 3 }, "no-such-no-go", "has none"),
        (name(&"x".repeat(41)), "bad-name", "41 characters"),
    ];
    for (body, reason, detail) in cases {
        let before = pair.updates.len();
        let refused = pair.ask(ANNA, body.clone());
        assert_eq!(refused.as_deref(), Some(reason), "{body:?}");
        let text = pair.updates[before..].iter().find_map(|update| match update {
            Update::Failed(failure) => Some(failure.text.clone()),
            _ => None,
        });
        let text = text.expect("a sentence");
        assert!(text.contains(detail) && text.ends_with('.'), "{text}");
    }
    pair.run_ms(200);
    assert_eq!(pair.edits, []);
}

#[test]
fn a_map_that_nobody_is_in_yet_is_not_changed() {
    let mut pair = Pair::in_home(Some(kept_home()));
    for body in [
        wall([0.0, 1.0], [1.0, 1.0]),
        RequestBody::Estimate(JobOrder::default()),
        RequestBody::Clean(JobOrder::default()),
    ] {
        assert_eq!(pair.ask(ANNA, body).as_deref(), Some("map-not-taken-up"));
    }
    pair.run_ms(200);
    assert_eq!(pair.edits, []);
}

#[test]
fn decisions_and_estimates_are_told_to_who_follows_them() {
    let mut pair = Pair::new();
    pair.ask(ANNA, RequestBody::Start { strategy: None });
    pair.run_ms(200);
    let topics = vec![Topic::Decisions, Topic::Estimate, Topic::PlannedPath];
    let before = pair.updates.len();
    pair.ask(BERT, RequestBody::Watch { topics });
    let told = &pair.updates[before..];
    let starts = told.iter().filter(|update| match update {
        Update::Decision(decision) => decision.what == "state-starting" && decision.reason == "command",
        _ => false,
    });
    assert_eq!(starts.count(), 1);
    let estimate = told.iter().find_map(|update| match update {
        Update::Estimate(estimate) => Some(estimate),
        _ => None,
    });
    let estimate = estimate.expect("an estimate at once");
    assert!(!estimate.lost && estimate.agreement.is_none(), "{estimate:?}");
    let before = pair.updates.len();
    pair.ask(ANNA, RequestBody::Stop);
    pair.run_ms(100);
    let stopped = pair.updates[before..].iter().any(|update| match update {
        Update::Decision(decision) => decision.text == "Stood still, without a job: it was requested.",
        _ => false,
    });
    assert!(stopped, "{:?}", &pair.updates[before..]);
}

#[test]
fn a_robot_that_stops_by_itself_tells_what_it_felt_and_one_that_was_told_to_does_not() {
    let mut pair = Pair::new();
    let topics = vec![Topic::Standstills, Topic::Log];
    pair.ask(BERT, RequestBody::Watch { topics });
    pair.ask(ANNA, RequestBody::Start { strategy: None });
    pair.run_ms(6_000);
    pair.ask(ANNA, RequestBody::Pause);
    pair.run_ms(200);
    let told = |pair: &Pair| -> Vec<_> {
        let told = pair.updates.iter().filter_map(|update| match update {
            Update::Standstill(told) => Some((**told).clone()),
            _ => None,
        });
        told.collect()
    };
    assert_eq!(told(&pair), [], "somebody told it to");
    pair.ask(ANNA, RequestBody::Resume);
    pair.run_ms(6_000);
    pair.state.wheel_drops = WheelDrops {
        left: true,
        right: false,
    };
    pair.run_ms(500);
    let stops = told(&pair);
    assert_eq!(stops.len(), 1, "{stops:?}");
    let stop = &stops[0];
    assert_eq!(
        (stop.state.as_str(), stop.reason.as_str()),
        ("paused", "wheel-drop")
    );
    assert_eq!(
        (stop.text.as_str(), stop.remedy.as_str()),
        (
            "Paused: a wheel hangs in the air.",
            "Put the robot flat on the floor."
        )
    );
    let line = "state-paused (wheel-drop): A wheel hangs in the air. Put the robot flat on the floor.";
    assert!(pair.log_lines().contains(&line), "{:?}", pair.log_lines());
    let newest = stop.evidence.samples.last().expect("it felt something");
    assert!(newest.signs.iter().any(|sign| sign == "wheel-drop"), "{newest:?}");
    let earlier = &stop.evidence.samples[stop.evidence.samples.len() - 3];
    assert!(
        earlier.signs.iter().all(|sign| sign != "wheel-drop"),
        "{earlier:?}"
    );
    assert!((45..=51).contains(&stop.evidence.samples.len()));
    // Whoever comes later is told, too, and the record of the run has it.
    let before = pair.updates.len();
    let topics = vec![Topic::Standstills];
    pair.ask(ANNA, RequestBody::Watch { topics });
    let again = &pair.updates[before..];
    assert!(matches!(&again[0], Update::Standstill(told) if told.number == 1));
    assert_eq!(pair.ask(ANNA, RequestBody::Evidence), None);
    let Some(Update::Evidence {
        id: Some(1),
        evidence,
    }) = pair.updates.last()
    else {
        panic!("{:?}", pair.updates.last());
    };
    assert!(
        evidence
            .samples
            .iter()
            .any(|felt| felt.signs.contains(&"wheel-drop".to_owned()))
    );
}

#[test]
fn a_refusal_is_in_the_log_in_the_words_of_the_answer_and_not_again_and_again() {
    let mut pair = Pair::new();
    let topics = vec![Topic::Log];
    pair.ask(BERT, RequestBody::Watch { topics });
    pair.run_ms(100);
    assert_eq!(pair.push(ANNA, 0.1), None);
    let before = pair.updates.len();
    for _ in 0..10 {
        assert_eq!(pair.drive(BERT, 0.1).as_deref(), Some("driver-busy"));
    }
    let answer = pair.updates[before..].iter().find_map(|update| match update {
        Update::Failed(failure) => Some(failure.text.clone()),
        _ => None,
    });
    let answer = answer.expect("refused");
    let lines = pair.log_lines();
    let refusals: Vec<&&str> = lines.iter().filter(|line| line.contains("is refused")).collect();
    assert_eq!(refusals.len(), 1, "{refusals:?}");
    assert!(
        refusals[0].ends_with(&format!(" is refused (driver-busy): {answer}")),
        "{refusals:?}"
    );
}

/// A floor with a dock at x.
fn floor_with_dock(number: u16, x_m: f64) -> KeptFloor {
    let floor = Raster::filled(Cell { x: 0, y: 0 }, 160, 120, CellKnowledge::Free);
    let dock = Pose2 {
        x_m,
        y_m: 0.5,
        heading_rad: 1.5,
    };
    KeptFloor {
        home: Some(StoredMap::from_raster(&floor, Some(dock))),
        ..KeptFloor::new(number)
    }
}

#[test]
fn on_a_dock_that_one_floor_has_the_robot_is_on_that_floor() {
    let plain = KeptFloor {
        home: Some(StoredMap::from_raster(
            &Raster::filled(Cell { x: 0, y: 0 }, 40, 40, CellKnowledge::Free),
            None,
        )),
        ..KeptFloor::new(1)
    };
    let mut pair = Pair::with_floors(vec![plain, floor_with_dock(2, 2.0)]);
    let view = pair.core.floors_view();
    assert!(
        view.here.is_none() && view.sought && view.question.is_none(),
        "{view:?}"
    );
    pair.state.docked = true;
    pair.run_ms(100);
    assert_eq!(pair.core.floors_view().here, Some(2));
    assert!((pair.core.pose().x - 2.0).abs() < 1e-6);
    pair.handle(Input::Shutdown);
    assert_eq!(pair.homes.pop().expect("a map").floor, 2);
}

#[test]
fn an_order_that_comes_while_the_map_of_its_floor_is_taken_up_is_carried_out_on_that_floor() {
    let mut pair = Pair::with_floors(vec![floor_with_dock(1, 2.0)]);
    pair.state.docked = true;
    while pair.core.status().state != "docked" {
        pair.run_ms(1);
    }
    assert_eq!(pair.core.floors_view().here, None, "its map is not there yet");
    assert_eq!(pair.ask(ANNA, RequestBody::Start { strategy: None }), None);
    pair.run_ms(1_000);
    assert_eq!(pair.core.floors_view().here, Some(1));
    assert_eq!(pair.core.status().state, "starting");
    let started = pair.records.iter().find_map(|record| match record {
        Record::RunStarted(start) => Some(start),
        _ => None,
    });
    let home = started.expect("a run").checkpoint.home.as_ref();
    assert!(
        home.is_some_and(|home| home.dock().is_some()),
        "with the map of the floor"
    );
}

#[test]
fn on_a_dock_that_several_floors_have_a_person_is_asked_and_the_answer_counts() {
    let mut pair = Pair::with_floors(vec![floor_with_dock(1, 1.0), floor_with_dock(2, 2.0)]);
    let topics = vec![Topic::Floors];
    pair.ask(BERT, RequestBody::Watch { topics });
    pair.state.docked = true;
    pair.run_ms(100);
    let told = pair.updates.iter().rev().find_map(|update| match update {
        Update::Floors(view) => Some(view.clone()),
        _ => None,
    });
    let question = told.expect("is told").question.expect("is asked");
    assert_eq!(question.reason, "which-dock");
    assert_eq!(pair.core.pose().x, 0.0, "neither is believed");
    let choose = |floor| RequestBody::ChooseFloor { floor };
    assert_eq!(pair.ask(ANNA, choose(7)).as_deref(), Some("no-such-floor"));
    assert_eq!(pair.ask(ANNA, choose(2)), None);
    pair.run_ms(100);
    let view = pair.core.floors_view();
    assert_eq!((view.here, view.sought, view.question), (Some(2), false, None));
    assert!((pair.core.pose().x - 2.0).abs() < 1e-6);
    assert_eq!(pair.ask(ANNA, RequestBody::Start { strategy: None }), None);
    pair.run_ms(200);
    assert_eq!(pair.ask(ANNA, choose(1)).as_deref(), Some("job-runs"));
}

#[test]
fn a_robot_that_was_carried_to_a_dock_asks_again_when_several_floors_have_one() {
    let mut pair = Pair::with_floors(vec![floor_with_dock(1, 1.0), floor_with_dock(2, 2.0)]);
    pair.state.docked = true;
    pair.ask(ANNA, RequestBody::ChooseFloor { floor: 1 });
    pair.run_ms(100);
    assert_eq!(pair.core.floors_view().here, Some(1));
    pair.state.docked = false;
    pair.state.wheel_drops = WheelDrops {
        left: true,
        right: true,
    };
    pair.run_ms(2_000);
    pair.state.wheel_drops = WheelDrops::default();
    pair.run_ms(200);
    pair.state.docked = true;
    pair.run_ms(200);
    let view = pair.core.floors_view();
    assert_eq!(view.here, None);
    assert_eq!(view.question.expect("is asked").reason, "which-dock");
}

#[test]
fn a_new_floor_takes_what_was_drawn_and_a_floor_that_is_gone_is_forgotten() {
    let mut pair = Pair::in_home(Some(kept_home()));
    pair.handle(Input::BoardHeading { heading_urad: 0 });
    pair.run_ms(500);
    let name = || Some("Attic".to_owned());
    assert_eq!(pair.ask(ANNA, RequestBody::NewFloor { name: name() }), None);
    let task = pair.floor_orders.pop().expect("an order").task;
    assert!(matches!(&task, FloorTask::New(Some(name)) if name.as_str() == "Attic"));
    assert_eq!(
        pair.core.floors_view().here,
        None,
        "nothing counts before it is kept"
    );
    let first = KeptFloor {
        home: Some(kept_home()),
        ..KeptFloor::new(1)
    };
    let attic = KeptFloor {
        name: Some(brain::RoomName::new("Attic").expect("is a name")),
        ..KeptFloor::new(2)
    };
    pair.handle(Input::FloorsKept {
        task,
        floors: vec![first.clone(), attic.clone()],
        made: Some(2),
    });
    assert_eq!(pair.core.floors_view().here, Some(2));
    let naming = RequestBody::NameFloor {
        floor: 1,
        name: name(),
    };
    assert_eq!(pair.ask(ANNA, naming).as_deref(), Some("name-taken"));
    let removal = RequestBody::RemoveFloor { floor: 2 };
    assert_eq!(pair.ask(ANNA, removal), None);
    let removed = KeptFloor {
        removed: true,
        ..attic
    };
    pair.handle(Input::FloorsKept {
        task: FloorTask::Remove(2),
        floors: vec![first, removed],
        made: None,
    });
    let view = pair.core.floors_view();
    assert!(view.here.is_none() && view.floors[1].removed, "{view:?}");
    let removal = RequestBody::RemoveFloor { floor: 1 };
    assert_eq!(pair.ask(ANNA, removal).as_deref(), Some("last-floor"));
    let back = RequestBody::RestoreFloor { floor: 1 };
    assert_eq!(pair.ask(ANNA, back).as_deref(), Some("not-removed"));
}

#[test]
fn floors_of_an_archive_are_there_and_the_robot_stays_where_it_is() {
    let mut pair = Pair::in_home(Some(kept_home()));
    let here = pair.core.floors_view().here;
    let export = |floor| RequestBody::ExportFloors { floor, from: 0 };
    assert_eq!(pair.ask(ANNA, export(Some(7))).as_deref(), Some("no-such-floor"));
    let cellar = KeptFloor {
        name: Some(brain::RoomName::new("Cellar").expect("is a name")),
        ..KeptFloor::new(2)
    };
    pair.handle(Input::FloorsTakenIn {
        floors: vec![KeptFloor::new(1), cellar],
        taken: vec![2],
    });
    let view = pair.core.floors_view();
    assert_eq!((view.here, view.floors.len()), (here, 2));
    assert_eq!(view.floors[1].name.as_deref(), Some("Cellar"));
    assert_eq!(pair.ask(ANNA, export(Some(2))), None);
}
