//! What is latched in the real firmware: it stays while its cause stands, it outlives resets, and nothing behind cordlib's
//! back switches the charger on meanwhile.

use std::sync::Arc;

use home::{Home, Noise, Pack, PackMake, Pcg, RobotModel, World};
use pic32::board::{Blueprint, CalibrationChoice, EmulatedRobot, EmulatedSettings};
use pic32::image::Image;
use rvac_protocol::PacketBuffer;
use rvac_protocol::message::{
    BinaryKinds, Command, Inhibit, Inhibits, LogText, Refusal, Report, ResetCause, Sequence,
};
use rvac_protocol::session::{HostEvent, HostSession};
use rvac_units::Tick;

use super::{HIGH_FOR_GOOD, OC4CON, image, pin, unsaid_text};

const ROOM: &str = r#"
format = "librervac-home"
version = 1

[[room]]
polygon = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]

[dock]
position = [0.0, 0.8]
heading-deg = 0.0
"#;
/// ENABLE of the charger.
const GATE: &str = "RD2";
/// A charge begins within this time on the dock.
const BEGINS_MS: u32 = 30_000;
/// Current that tells of a charge, ampere.
const CHARGING_A: f64 = 0.1;
/// The check of the image goes once around in less.
const FOUND_MS: u32 = 15_000;
/// From a reset to a session and its first report.
const CONNECTED_MS: u32 = 8_000;

/// A robot on its dock, with a pack that needs a charge, and its host.
struct Docked {
    robot: EmulatedRobot,
    session: HostSession,
    inhibits: Option<Inhibits>,
    log: Vec<LogText>,
    answers: Vec<Option<Refusal>>,
    now: u32,
    /// Where in flash the text is that [`Self::flip_image`] damages.
    text: Option<u32>,
}

impl Docked {
    fn switched_on(image: Image) -> Self {
        let blueprint =
            Blueprint::sr8730(image, &CalibrationChoice::Complete).expect("the project's board is sound");
        let model = RobotModel::by_name("sr8730").expect("it comes with the project");
        let home = Arc::new(Home::from_floorplan("room", ROOM, &model).expect("a valid home"));
        let mut world = World::new(home, &model, &Noise::nominal(), 1, None);
        let dock = world.home().start();
        world.put_down_at(dock);
        world.set_pack(Pack::new(PackMake::sound(&mut Pcg::new(1, 0)), 0.3, 22.0));
        Self {
            robot: EmulatedRobot::new(&blueprint, world, &EmulatedSettings::default()),
            session: HostSession::new(BinaryKinds::NONE, Tick(0)),
            inhibits: None,
            log: Vec::new(),
            answers: Vec::new(),
            now: 0,
            text: None,
        }
    }

    fn pass_ms(&mut self) {
        self.now += 1;
        let now = Tick(self.now);
        let (mut packet, mut heard) = (PacketBuffer::new(), Vec::new());
        while self.session.next_packet(&mut packet) {
            self.robot.send(packet.as_bytes());
        }
        self.robot.tick(&mut heard);
        let mut events: Vec<_> = heard
            .iter()
            .filter_map(|byte| self.session.receive(*byte, now))
            .collect();
        events.extend(std::iter::from_fn(|| self.session.poll(now)));
        for event in events {
            match event {
                HostEvent::Report(Report::State(state)) => self.inhibits = Some(state.inhibits),
                HostEvent::Report(Report::Log { text, .. }) => self.log.push(text),
                HostEvent::Answered { refusal, .. } => self.answers.push(refusal),
                _ => {}
            }
        }
    }

    fn pass(&mut self, milliseconds: u32) {
        for _ in 0..milliseconds {
            self.pass_ms();
        }
    }

    fn pass_until(&mut self, limit_ms: u32, condition: impl Fn(&Self) -> bool) {
        for _ in 0..limit_ms {
            if condition(self) {
                return;
            }
            self.pass_ms();
        }
        panic!(
            "not within {limit_ms} ms: {:?} {:?}",
            self.names(),
            self.log.iter().map(LogText::as_str).collect::<Vec<_>>()
        );
    }

    fn names(&self) -> Vec<&'static str> {
        let inhibits = self.inhibits.unwrap_or_default();
        inhibits.iter().map(Inhibit::name).collect()
    }

    /// Forgets what was reported, and waits for a session and a report of now.
    fn connect(&mut self) {
        self.inhibits = None;
        self.pass_until(CONNECTED_MS, |docked| {
            docked.inhibits.is_some() && docked.session.is_open()
        });
    }

    fn has(&self, inhibit: Inhibit) -> bool {
        self.inhibits.is_some_and(|inhibits| inhibits.contains(inhibit))
    }

    fn charges(&self) -> bool {
        self.robot.world().truth().battery_a > CHARGING_A
    }

    fn clear(&mut self, inhibit: Inhibit) -> Option<Refusal> {
        let (mut packet, answered) = (PacketBuffer::new(), self.answers.len());
        let sequence = Sequence(0);
        let sent = self
            .session
            .send(Command::Clear { sequence, inhibit }, Tick(self.now), &mut packet);
        sent.expect("the session is open");
        self.robot.send(packet.as_bytes());
        self.pass_until(1_000, |docked| docked.answers.len() > answered);
        self.answers[answered]
    }

    /// The host tries for so long to get the charger on; its pin stays low all that time.
    fn insist(&mut self, inhibit: Inhibit, seconds: u32) {
        let gate = pin(GATE);
        self.robot.machine_mut().take_edges(gate);
        for _ in 0..seconds {
            assert_eq!(self.clear(inhibit), Some(Refusal::CauseRemains));
            self.pass(1_000);
            assert!(self.has(inhibit), "{:?}", self.names());
        }
        assert_eq!(self.robot.machine_mut().take_edges(gate), []);
        assert!(!self.charges());
    }

    /// Flips the same bit each time.
    fn flip_image(&mut self) {
        let place = *self.text.get_or_insert_with(|| unsaid_text(&self.robot));
        let flipped = self.robot.machine_mut().flip_flash_bit(place, 3);
        flipped.expect("the image is in flash");
    }
}

#[test]
fn a_damaged_image_is_never_cleared_and_never_charges() {
    let Some(image) = image() else { return };
    let mut docked = Docked::switched_on(image);
    docked.pass_until(BEGINS_MS, Docked::charges);
    docked.robot.machine_mut().watch(pin(GATE));
    docked.flip_image();
    docked.pass_until(FOUND_MS, |docked| docked.robot.machine().reset_count() > 0);
    docked.connect();
    assert!(docked.has(Inhibit::Memory), "{:?}", docked.names());
    docked.insist(Inhibit::Memory, 8);
    docked.robot.reset(ResetCause::External);
    docked.connect();
    docked.insist(Inhibit::Memory, 2);

    // The image is written again: what is latched stays until a person has seen it.
    docked.flip_image();
    docked.robot.reset(ResetCause::External);
    docked.connect();
    docked.pass(6_000);
    assert!(docked.has(Inhibit::Memory) && !docked.charges());
    assert_eq!(docked.clear(Inhibit::Memory), None);
    docked.pass_until(BEGINS_MS, Docked::charges);
}

#[test]
fn a_changed_register_is_latched_by_the_reset_that_mends_it() {
    let Some(image) = image() else { return };
    let mut docked = Docked::switched_on(image);
    docked.connect();
    docked.robot.machine_mut().write_register(OC4CON, HIGH_FOR_GOOD);
    docked.pass_until(100, |docked| docked.robot.machine().reset_count() > 0);
    for cause in [ResetCause::Watchdog, ResetCause::External, ResetCause::BrownOut] {
        docked.connect();
        assert!(docked.has(Inhibit::InternalFault), "{:?}", docked.names());
        docked.robot.reset(cause);
    }
    docked.connect();
    docked.pass(500);
    let kept = docked
        .log
        .iter()
        .any(|line| line.starts_with("kept over the reset:"));
    assert!(kept, "{:?}", docked.log);
    assert_eq!(docked.clear(Inhibit::InternalFault), None);
    docked.pass(200);
    docked.robot.reset(ResetCause::External);
    docked.connect();
    assert!(!docked.has(Inhibit::InternalFault), "{:?}", docked.names());
}
