//! Whole sessions: the Rust cord and the C cord under sanitizers do the same at the same times.

use crate::bench::{SessionBench, SimulatedCord};
use crate::compiled::place;
use crate::random::Random;
use crate::reference::RustCord;
use cord_c::host::HostedCord;
use rvac_protocol::message::{Command, Sequence};
use rvac_units::{AngularSpeed, Speed};

/// Sessions of a usual run, and with `RVAC_LONG=1`.
const SESSIONS: u64 = 3;
const SESSIONS_LONG: u64 = 300;
/// What each does one after the other.
const LEGS: usize = 6;
/// Both hosts know their robots by then.
const START_MS: u32 = 2_500;
/// A control period, and what the line's different bytes make of it.
const TOLERANCE_MS: u32 = 14;
/// With counts of 5 mm both controllers pause now and then for some periods, each when its own counts come: no stop.
const PAUSE_MS: u32 = 120;
/// Motion ahead, back, on the spot and in a bend; no wheel is near rest in them.
const MOTIONS: [(i32, i32); 5] = [
    (150_000, 0),
    (-120_000, 0),
    (0, 900_000),
    (0, -900_000),
    (150_000, 400_000),
];

/// What ends a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Lease,
    Stop,
    Silence,
    Bumper,
    Cliff,
    Lift,
}

impl End {
    const ALL: [Self; 6] = [
        Self::Lease,
        Self::Stop,
        Self::Silence,
        Self::Bumper,
        Self::Cliff,
        Self::Lift,
    ];
}

/// One leg: armed, it drives and perhaps cleans, until something ends it.
#[derive(Clone, Copy, Debug)]
struct Leg {
    motion: (i32, i32),
    cleans: bool,
    drive_ms: u32,
    end: End,
    rest_ms: u32,
}

fn legs(random: &mut Random) -> Vec<Leg> {
    let leg = |_| {
        let end = End::ALL[random.below(End::ALL.len())];
        Leg {
            // A bumper and an edge stop what goes ahead.
            motion: match end {
                End::Bumper | End::Cliff => MOTIONS[0],
                _ => MOTIONS[random.below(MOTIONS.len())],
            },
            cleans: random.below(2) == 0,
            drive_ms: 600 + random.below(900) as u32,
            end,
            // A session that fell silent is over after two seconds, and opens again within one more.
            rest_ms: 4_500 + random.below(500) as u32,
        }
    };
    (0..LEGS).map(leg).collect()
}

/// A motor that runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stretch {
    motor: usize,
    sign: i8,
    from_ms: u32,
    until_ms: u32,
}

/// What a cord did in a session.
#[derive(Debug, Default)]
struct Account {
    stretches: Vec<Stretch>,
    /// Inhibits at the end of each leg and after its rest.
    inhibits: Vec<String>,
    refusals: Vec<&'static str>,
}

impl Account {
    /// A motor turned so in this millisecond.
    fn turned(&mut self, motor: usize, sign: i8, ms: u32) {
        let mut stretches = self.stretches.iter_mut().rev();
        match stretches.find(|stretch| stretch.motor == motor) {
            Some(last) if last.sign == sign && ms - last.until_ms <= PAUSE_MS => last.until_ms = ms,
            _ => self.stretches.push(Stretch {
                motor,
                sign,
                from_ms: ms,
                until_ms: ms,
            }),
        }
    }
}

/// A bench with what it did.
struct Recorder<C> {
    bench: SessionBench<C>,
    account: Account,
    ms: u32,
}

impl<C: SimulatedCord> Recorder<C> {
    fn new(cord: C) -> Self {
        Self {
            bench: SessionBench::new(cord),
            account: Account::default(),
            ms: 0,
        }
    }

    fn run(&mut self, ms: u32) {
        for _ in 0..ms {
            self.ms += 1;
            self.bench.tick();
            for (motor, sign) in self.bench.actuation.signs().into_iter().enumerate() {
                if sign != 0 {
                    self.account.turned(motor, sign, self.ms);
                }
            }
        }
    }

    fn note(&mut self) {
        let names: Vec<&str> = self
            .bench
            .inhibits
            .iter()
            .map(rvac_protocol::message::Inhibit::name)
            .collect();
        self.account.inhibits.push(names.join(" "));
    }

    fn leg(&mut self, leg: &Leg) {
        self.bench.say(Command::Arm {
            sequence: Sequence(0),
            undock: false,
        });
        self.run(100);
        let (speed, turn) = leg.motion;
        self.bench.drive = Some((Speed(speed), AngularSpeed(turn)));
        self.bench.cleans = leg.cleans;
        self.run(leg.drive_ms);
        match leg.end {
            End::Lease => {}
            End::Stop => self.bench.say(Command::Stop),
            End::Silence => self.bench.is_silent = true,
            End::Bumper => self.bench.senses.bumpers[0] = true,
            End::Cliff => self.bench.senses.cliff = true,
            End::Lift => self.bench.senses.hangs = true,
        }
        let goes_on = matches!(leg.end, End::Bumper | End::Cliff | End::Lift);
        self.bench.drive = self.bench.drive.filter(|_| goes_on);
        self.bench.cleans &= goes_on;
        self.run(400);
        self.note();
        self.bench.drive = None;
        self.bench.cleans = false;
        self.bench.senses.bumpers[0] = false;
        self.bench.senses.cliff = false;
        self.bench.senses.hangs = false;
        self.run(leg.rest_ms / 2);
        self.bench.is_silent = false;
        self.run(leg.rest_ms / 2);
        self.note();
    }
}

fn account(cord: impl SimulatedCord, legs: &[Leg]) -> Account {
    let mut recorder = Recorder::new(cord);
    recorder.run(START_MS);
    assert!(recorder.bench.is_described, "no session");
    for leg in legs {
        recorder.leg(leg);
    }
    let refusals = recorder.bench.refusals.iter().map(|refusal| refusal.name());
    recorder.account.refusals = refusals.collect();
    recorder.account.refusals.dedup();
    recorder.account
}

/// The largest difference in time.
fn compare(in_rust: &Account, in_c: &Account, what: &str) -> u32 {
    let both = || format!("{what}\n{in_rust:?}\n{in_c:?}");
    assert_eq!(in_c.inhibits, in_rust.inhibits, "{}", both());
    assert_eq!(in_c.refusals, in_rust.refusals, "{}", both());
    let mut worst_ms = 0;
    for motor in 0..4 {
        let of = |account: &Account| -> Vec<Stretch> {
            let stretches = account.stretches.iter();
            stretches
                .filter(|stretch| stretch.motor == motor)
                .copied()
                .collect()
        };
        let (rust, c) = (of(in_rust), of(in_c));
        let signs =
            |stretches: &[Stretch]| -> Vec<i8> { stretches.iter().map(|stretch| stretch.sign).collect() };
        assert_eq!(signs(&c), signs(&rust), "motor {motor}, {}", both());
        for (rust, c) in rust.iter().zip(&c) {
            let apart_ms = rust
                .from_ms
                .abs_diff(c.from_ms)
                .max(rust.until_ms.abs_diff(c.until_ms));
            assert!(
                apart_ms <= TOLERANCE_MS,
                "{apart_ms} ms, {rust:?}, {c:?}, {}",
                both()
            );
            worst_ms = worst_ms.max(apart_ms);
        }
    }
    worst_ms
}

#[test]
fn sessions_move_the_same_motors_at_the_same_times() {
    let sessions = match std::env::var_os("RVAC_LONG") {
        Some(_) => SESSIONS_LONG,
        None => SESSIONS,
    };
    let (mut worst_ms, mut stretches) = (0, 0);
    for seed in 0..sessions {
        let legs = legs(&mut Random::new(seed));
        let in_rust = account(RustCord::new(), &legs);
        let in_c = account(
            HostedCord::start(&place("robot")).expect("the cord starts"),
            &legs,
        );
        worst_ms = worst_ms.max(compare(&in_rust, &in_c, &format!("seed {seed}: {legs:?}")));
        stretches += in_rust.stretches.len();
    }
    println!("{sessions} sessions, {stretches} stretches of motors, at most {worst_ms} ms apart");
    assert!(stretches > LEGS * sessions as usize);
}

/// It may stand against a wall at rest; armed, a bumper that stays pressed for ten seconds is stuck.
#[test]
fn a_bumper_that_is_pressed_at_rest_is_not_stuck() {
    fn leaned(cord: impl SimulatedCord) -> Account {
        let mut recorder = Recorder::new(cord);
        recorder.run(START_MS);
        recorder.bench.senses.bumpers[0] = true;
        recorder.run(30_000);
        recorder.note();
        recorder.bench.say(Command::Arm {
            sequence: Sequence(0),
            undock: false,
        });
        recorder.run(9_800);
        recorder.note();
        recorder.run(400);
        recorder.note();
        recorder.account
    }
    let in_rust = leaned(RustCord::new());
    let in_c = leaned(HostedCord::start(&place("robot")).expect("the cord starts"));
    compare(&in_rust, &in_c, "leaned");
    let is_stuck = |names: &String| names.split(' ').any(|name| name == "bumper-stuck");
    let stuck: Vec<bool> = in_c.inhibits.iter().map(is_stuck).collect();
    assert_eq!(stuck, [false, false, true], "{:?}", in_c.inhibits);
}

/// A person without a host: hand mode.
#[test]
fn what_is_typed_moves_the_same_motors_at_the_same_times() {
    fn typed(cord: impl SimulatedCord) -> Account {
        let mut recorder = Recorder::new(cord);
        recorder.bench.is_silent = true;
        recorder.run(200);
        for text in [
            r#"{"c":"drive","v":0.05,"w":0}"#,
            r#"{"c":"arm"}"#,
            r#"{"c":"drive","v":0.09,"w":0,"ttl":1000}"#,
            r#"{"c":"stop"}"#,
            r#"{"c":"arm"}"#,
            r#"{"c":"motor","motor":"brush-main","throttle":1,"ttl":400}"#,
            r#"{"c":"motor","motor":"wheel-left","throttle":0.2}"#,
            r#"{"c":"drive","v":-0.09,"w":0,"ttl":300}"#,
        ] {
            recorder.bench.type_in(text);
            recorder.run(900);
        }
        // Nobody types: not armed any more.
        recorder.run(11_000);
        recorder.bench.type_in(r#"{"c":"drive","v":0.09,"w":0}"#);
        recorder.run(500);
        recorder.account
    }
    let in_rust = typed(RustCord::new());
    let in_c = typed(HostedCord::start(&place("robot")).expect("the cord starts"));
    compare(&in_rust, &in_c, "typed");
    assert!(in_rust.stretches.len() >= 4, "{in_rust:?}");
}
