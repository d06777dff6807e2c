//! Somebody holds a stick pushed while the driver's seat changes hands, a connection breaks, or a process starts anew: the wheels
//! come to rest and stay there until the stick was in its centre, and then it drives again.
//!
//! Whoever holds the stick here is the worst of clients: it says the same position again and again, whatever it is answered.

use std::collections::BTreeMap;

use brain::command::StrategyName;
use home::{Pcg, Pose};
use rvac_api::RequestBody;
use rvac_sim::{Host, Household, ResetCause};
use scenarios::{cleaning, scene};
use vthal_core::{ClientId, Input, LinkLoss};

const MOMENTS: u32 = 1_000;
const LEASE_MS: u16 = 250;
const RENEW_MS: u64 = 80;
/// Braked wheels rest by then, also after a lease had to end first.
const RESTS_WITHIN_MS: u64 = 800;
/// So long the stick stays pushed after that: a robot that starts anew is back by then.
const HELD_ON_MS: u64 = 2_000;
/// A person looks at what is wrong by then.
const CLEARED_AFTER_MS: u64 = 1_800;
/// Three resets within a minute are a fault of their own.
const BETWEEN_RESETS_MS: u64 = 60_000;
/// Rims slower than this stand, as in the test of drivers that are lost.
const STANDING_M_PER_S: f64 = 0.001;
/// The middle of a room, looking along it.
const IN_THE_OPEN: Pose = Pose::new(-3.4, 0.0, core::f64::consts::PI);
const START_MS: u64 = 4_000;
const HOLDS: [(f64, f64); 4] = [(0.3, 0.0), (0.0, 1.5), (0.0, -0.5), (0.2, -1.0)];

/// What ends a hold, or has kept it from beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    /// The connection is gone, and a new one takes its place.
    Reconnect,
    /// The connection takes no more requests, and a new one takes its place.
    HalfConnection,
    /// The client lets go and pushes on.
    Release,
    /// Nothing is said for longer than the lease.
    Silence,
    /// Somebody else stops the robot.
    Stop,
    /// The daemon is killed, and another one takes over.
    DaemonKilled,
    /// The daemon ends in good order, and another one takes over.
    DaemonEnded,
    /// The robot's controller starts anew.
    RobotReset,
    /// The cable of the robot is pulled and plugged in.
    Replugged,
    /// Nothing gets through between the robot and the daemon.
    LineCut,
}

const ENDS: [End; 10] = [
    End::Reconnect,
    End::HalfConnection,
    End::Release,
    End::Silence,
    End::Stop,
    End::DaemonKilled,
    End::DaemonEnded,
    End::RobotReset,
    End::Replugged,
    End::LineCut,
];

/// A robot on open floor, and whoever holds a stick.
struct Trial {
    household: Household,
    random: Pcg,
    /// Who holds the stick.
    client: ClientId,
    /// The newest connection.
    newest: u64,
    hold: (f64, f64),
    /// Until the next word.
    renew_ms: u64,
    refusal: Option<String>,
}

impl Trial {
    fn new(seed: u64) -> Self {
        let mut household = cleaning(&scene("two-room-flat", "nominal"), seed);
        household.pass_ms(START_MS + 20_000);
        household.ask(RequestBody::Stop);
        household.pass_ms(2_000);
        let mut trial = Self {
            household,
            random: Pcg::new(seed, 3),
            client: ClientId(1),
            newest: 1,
            hold: HOLDS[0],
            renew_ms: 0,
            refusal: None,
        };
        trial.connect();
        trial
    }

    fn host(&mut self) -> &mut Host {
        self.household.host_mut().expect("lives")
    }

    fn input(&mut self, input: Input<'_>) {
        let now_us = self.household.now_us();
        self.host().handle(now_us, input);
    }

    /// Whoever holds the stick does so over a new connection from now on.
    fn connect(&mut self) {
        self.newest += 1;
        self.client = ClientId(self.newest);
        self.input(Input::ClientConnected(self.client));
    }

    fn say(&mut self, (v, w): (f64, f64)) -> Option<String> {
        let (now_us, client) = (self.household.now_us(), self.client);
        let body = RequestBody::Drive {
            v,
            w,
            ttl: LEASE_MS,
            clean: false,
            power: None,
        };
        self.host().ask_as(now_us, client, body)
    }

    fn ask(&mut self, client: ClientId, body: RequestBody) {
        let now_us = self.household.now_us();
        self.host().ask_as(now_us, client, body);
    }

    /// A millisecond with the stick pushed.
    fn hold_ms(&mut self) {
        if self.renew_ms == 0 {
            self.refusal = self.say(self.hold);
            self.renew_ms = RENEW_MS;
        }
        self.renew_ms -= 1;
        self.household.tick();
    }

    fn moves(&self) -> bool {
        let truth = self.household.robot().world().truth();
        let rims = [truth.rim_left_m_per_s, truth.rim_right_m_per_s];
        rims.iter().any(|rim| rim.abs() > STANDING_M_PER_S)
    }

    /// Pushes the stick from its centre on, for some time. Whether the robot moved.
    fn begin(&mut self) -> bool {
        self.say((0.0, 0.0));
        self.household.pass_ms(20);
        self.renew_ms = 0;
        for _ in 0..400 + self.random.below(500) {
            self.hold_ms();
        }
        self.moves()
    }

    /// The stick is in its centre, and the robot stands in the open.
    fn rest(&mut self) {
        self.ask(self.client, RequestBody::Release);
        let place = self.household.robot().world().home().start().then(IN_THE_OPEN);
        self.household.pass_ms(600);
        self.household.robot_mut().world_mut().put_down_at(place);
        self.household.pass_ms(1_500 + u64::from(self.random.below(100)));
        self.hold = HOLDS[self.random.below(HOLDS.len() as u32) as usize];
    }

    /// Ends the hold. Whoever holds the stick then is another one half of the time.
    fn end(&mut self, end: End) {
        match end {
            End::Reconnect => self.input(Input::ClientGone(self.client)),
            End::HalfConnection => self.input(Input::ClientSilent(self.client)),
            End::Release => self.ask(self.client, RequestBody::Release),
            End::Silence => self.household.pass_ms(u64::from(LEASE_MS) + 1),
            End::Stop => self.ask(ClientId(1), RequestBody::Stop),
            End::DaemonKilled | End::DaemonEnded => self.replace_daemon(end),
            End::RobotReset => self.household.robot_mut().reset(ResetCause::Watchdog),
            End::Replugged => {
                let reason = LinkLoss::HungUp;
                self.input(Input::LinkClosed { reason });
                self.household.pass_ms(u64::from(self.random.below(300)));
                self.input(Input::LinkOpened);
            }
            End::LineCut => self.household.robot_mut().cut_line(700),
        }
        let is_gone = matches!(end, End::Reconnect | End::HalfConnection);
        if is_gone {
            let pause_ms = 50 + u64::from(self.random.below(1_950));
            self.household.pass_ms(self.random.below(2).into());
            self.pause(pause_ms);
        }
        if is_gone || self.random.below(2) == 0 {
            self.connect();
        }
    }

    /// Nobody is connected for so long; for as short as that at times.
    fn pause(&mut self, pause_ms: u64) {
        let pause_ms = if self.random.below(2) == 0 { 0 } else { pause_ms };
        self.household.pass_ms(pause_ms);
    }

    fn replace_daemon(&mut self, end: End) {
        let now_us = self.household.now_us();
        if end == End::DaemonEnded {
            self.host().shut_down(now_us);
            self.household.tick();
        }
        self.household.kill_host();
        let pause_ms = u64::from(self.random.below(1_000));
        self.household.pass_ms(pause_ms);
        let config = Host::config(1, StrategyName::Bounce);
        let host = Host::start(self.household.now_us(), config);
        self.household.revive_host(host);
        self.connect();
    }

    /// A controller that starts anew while the wheels still turn calls that a runaway. A person takes it back.
    fn clear_fault(&mut self) {
        let reason = self.refusal.take().filter(|reason| reason == "runaway");
        if let Some(reason) = reason {
            self.ask(ClientId(1), RequestBody::Clear { reason });
        }
    }

    /// Holds on. Whether the wheels came to rest and stayed there.
    fn stands(&mut self) -> bool {
        self.renew_ms = 0;
        let mut moved_ms = 0;
        for ms in 1..=RESTS_WITHIN_MS + HELD_ON_MS {
            self.hold_ms();
            if self.moves() {
                moved_ms = ms;
            }
            if ms == CLEARED_AFTER_MS {
                self.clear_fault();
            }
        }
        moved_ms <= RESTS_WITHIN_MS
    }
}

/// What came of one kind of end.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    moments: u32,
    /// The robot moved until then.
    driven: u32,
    /// It moved again while the stick was held.
    wrong: u32,
    /// The stick came to its centre and drove again.
    driven_again: u32,
}

#[test]
fn a_stick_that_is_held_on_drives_no_more_until_it_was_in_its_centre() {
    let mut trial = Trial::new(1);
    let mut tallies: BTreeMap<End, Tally> = BTreeMap::new();
    trial.rest();
    for _ in 0..MOMENTS {
        let end = ENDS[trial.random.below(ENDS.len() as u32) as usize];
        let tally = tallies.entry(end).or_default();
        tally.moments += 1;
        tally.driven += u32::from(trial.begin());
        trial.end(end);
        tally.wrong += u32::from(!trial.stands());
        assert_eq!(trial.refusal.as_deref(), Some("centre-first"), "{end:?}");
        tally.driven_again += u32::from(trial.begin());
        trial.rest();
        if end == End::RobotReset {
            trial.household.pass_ms(BETWEEN_RESETS_MS);
        }
    }
    for (end, tally) in &tallies {
        println!("{end:?}: {tally:?}");
    }
    let sum = |count: fn(&Tally) -> u32| tallies.values().map(count).sum::<u32>();
    assert_eq!(sum(|tally| tally.wrong), 0, "motions that did not begin at rest");
    assert!(sum(|tally| tally.driven) > MOMENTS * 9 / 10);
    assert!(sum(|tally| tally.driven_again) > MOMENTS * 9 / 10);
    assert_eq!(trial.household.robot().monitor().violations(), []);
}

/// The very first hold over a daemon that has just started is no exception.
#[test]
fn the_first_hold_ever_begins_in_the_centre() {
    let mut trial = Trial::new(2);
    trial.rest();
    trial.replace_daemon(End::DaemonKilled);
    trial.household.pass_ms(2_000);
    assert!(trial.stands());
    assert_eq!(trial.refusal.as_deref(), Some("centre-first"));
    assert!(trial.begin());
}
