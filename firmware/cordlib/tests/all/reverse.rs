//! S8 beside an edge: whoever asks for a reverse, and however, it is slow and short.

use crate::rig;
use crate::rig::{Phases, Rig, drive, motor, movement};
use cordlib::board::{Board, Received};
use rvac_protocol::message::{Capabilities, Cliffs, Command, Inhibit, Motor};

const MIDDLE: Cliffs = Cliffs {
    left: false,
    middle: true,
    right: false,
};
/// Speed of a rim that is driven backward, for longer than [`SETTLE_MS`]: 0.1 m/s and what a controller overshoots.
const RIM_MAX_M_PER_S: f64 = 0.125;
const SETTLE_MS: u32 = 60;
/// Distance of the centre: 0.15 m, and what it takes to come to rest.
const DISTANCE_MAX_M: f64 = 0.16;

/// A way to ask for a reverse that is too fast.
enum Asking {
    Repeated(Vec<Command>),
    Once(Command),
    /// Typed packets without a CRC, in hand mode.
    Typed(&'static [&'static str]),
}

fn ways() -> Vec<(&'static str, Asking)> {
    let both = |left, right| vec![motor(Motor::WheelLeft, left), motor(Motor::WheelRight, right)];
    let wheels = &[
        r#"{"c":"motor","motor":"wheel left","throttle":-1,"ttl":500}"#,
        r#"{"c":"motor","motor":"wheel right","throttle":-1,"ttl":500}"#,
    ];
    vec![
        ("motor", Asking::Repeated(both(-1.0, -1.0))),
        ("motor, one wheel", Asking::Repeated(both(0.0, -1.0))),
        ("motor, a curve", Asking::Repeated(both(-1.0, -0.4))),
        ("drive", Asking::Repeated(vec![drive(-0.35, 0.0)])),
        ("drive, a curve", Asking::Repeated(vec![drive(-0.3, 0.8)])),
        ("move", Asking::Once(movement(-1.0, None))),
        ("move, a curve", Asking::Once(movement(-1.0, Some(0.3)))),
        ("typed motor", Asking::Typed(wheels)),
        (
            "typed drive",
            Asking::Typed(&[r#"{"c":"drive","v":-0.35,"w":0,"ttl":500}"#]),
        ),
        ("typed move", Asking::Typed(&[r#"{"c":"move","length":-0.5}"#])),
    ]
}

fn type_in(rig: &mut Rig, text: &str) {
    let received = text.bytes().chain([0x1F]).map(Received::Byte);
    rig.cord.board_mut().link.to_robot.extend(received);
}

impl Asking {
    fn armed(&self, start: u32) -> Rig {
        if !matches!(self, Self::Typed(_)) {
            return Rig::armed(start);
        }
        let mut rig = Rig::switched_on(start);
        rig.host_dead = true;
        type_in(&mut rig, r#"{"c":"arm"}"#);
        rig.run(20);
        assert!(rig.cord.is_armed());
        rig
    }

    fn begin(&self, rig: &mut Rig) {
        match self {
            Self::Repeated(commands) => rig.repeated.clone_from(commands),
            Self::Once(command) => {
                rig.try_motion(*command).ok();
            }
            Self::Typed(_) => {}
        }
    }

    /// Types again what a person would.
    fn go_on(&self, rig: &mut Rig) {
        if let Self::Typed(texts) = self
            && rig.host_now().0.is_multiple_of(400)
        {
            for text in *texts {
                type_in(rig, text);
            }
        }
    }
}

/// The worst that was seen beside the edge.
#[derive(Clone, Copy, Debug, Default)]
struct Reverse {
    /// Longest time for which a wheel was driven backward while it turned too fast.
    too_fast_ms: u32,
    distance_m: f64,
    /// Highest speed backward after the first 300 ms.
    fastest_m_per_s: f64,
}

impl Reverse {
    fn worse(self, other: Self) -> Self {
        Self {
            too_fast_ms: self.too_fast_ms.max(other.too_fast_ms),
            distance_m: self.distance_m.max(other.distance_m),
            fastest_m_per_s: self.fastest_m_per_s.max(other.fastest_m_per_s),
        }
    }
}

/// Six seconds with an edge in sight.
fn beside_an_edge(rig: &mut Rig, asking: &Asking) -> Reverse {
    rig.cord.board_mut().cliffs.missing = MIDDLE;
    let centre = |rig: &Rig| f64::midpoint(rig.distances[0], rig.distances[1]);
    let start_m = centre(rig);
    let mut worst = Reverse::default();
    let mut too_fast_ms = [0; 2];
    for passed in 0..6_000 {
        asking.go_on(rig);
        rig.run(1);
        let duties = rig.duties();
        for (side, duty) in [duties.0, duties.1].into_iter().enumerate() {
            let is_too_fast = duty < 0 && rig.rims[side] < -RIM_MAX_M_PER_S;
            too_fast_ms[side] = if is_too_fast { too_fast_ms[side] + 1 } else { 0 };
            worst.too_fast_ms = worst.too_fast_ms.max(too_fast_ms[side]);
            if passed > 300 {
                worst.fastest_m_per_s = worst.fastest_m_per_s.max(-rig.rims[side]);
            }
        }
        worst.distance_m = worst.distance_m.max(start_m - centre(rig));
    }
    assert!(rig.wheels_off(), "{:?}", rig.names());
    worst
}

/// Over phases of the loop and of the leases, some of them around the wrap of the clock.
fn worst_of(asking: &Asking, prepare: impl Fn(&mut Rig)) -> Reverse {
    let mut phases = Phases(0xED6E);
    let mut worst = Reverse::default();
    for run in 0..40 {
        let start = if run % 2 == 0 {
            u32::MAX - phases.below(3_000)
        } else {
            phases.below(u32::MAX)
        };
        let mut rig = asking.armed(start);
        prepare(&mut rig);
        rig.run(phases.below(200));
        worst = worst.worse(beside_an_edge(&mut rig, asking));
    }
    worst
}

#[test]
fn s8_no_way_to_drive_leads_back_fast_or_far() {
    for (name, asking) in ways() {
        let worst = worst_of(&asking, |rig| {
            // The edge is in sight before anybody asks.
            rig.cord.board_mut().cliffs.missing = MIDDLE;
            rig.run(50);
            asking.begin(rig);
        });
        println!("{name}: {worst:?}");
        assert!(worst.too_fast_ms <= SETTLE_MS, "{name}: {worst:?}");
        assert!(worst.distance_m <= DISTANCE_MAX_M, "{name}: {worst:?}");
        assert!(worst.fastest_m_per_s <= RIM_MAX_M_PER_S, "{name}: {worst:?}");
    }
}

#[test]
fn s8_a_reverse_that_is_fast_already_becomes_slow_at_an_edge() {
    for (name, asking) in ways() {
        let worst = worst_of(&asking, |rig| {
            asking.begin(rig);
            for _ in 0..800 {
                asking.go_on(rig);
                rig.run(1);
            }
        });
        println!("{name}: {worst:?}");
        assert!(worst.too_fast_ms <= SETTLE_MS, "{name}: {worst:?}");
        assert!(worst.distance_m <= DISTANCE_MAX_M, "{name}: {worst:?}");
        assert!(worst.fastest_m_per_s <= RIM_MAX_M_PER_S, "{name}: {worst:?}");
    }
}

#[test]
fn s8_a_wheel_that_comes_free_does_not_catch_up_beside_an_edge() {
    for (name, asking) in ways() {
        let worst = worst_of(&asking, |rig| {
            rig.cord.board_mut().cliffs.missing = MIDDLE;
            rig.run(50);
            rig.mechanics.blocked = [true; 2];
            asking.begin(rig);
            for _ in 0..200 {
                asking.go_on(rig);
                rig.run(1);
            }
            rig.mechanics.blocked = [false; 2];
        });
        println!("{name}: {worst:?}");
        assert!(worst.too_fast_ms <= SETTLE_MS, "{name}: {worst:?}");
    }
}

#[test]
fn s8_without_encoders_the_duty_is_bounded_and_a_cliff_ends_all_motion() {
    let fitted = Capabilities {
        encoders: false,
        ..Board::<rig::parts::Memory>::capabilities()
    };
    let mut rig = Rig::switched_on_as(0, |parameters| parameters.fitted = Some(fitted));
    rig.connect();
    rig.arm();
    rig.cord.board_mut().cliffs.missing = MIDDLE;
    rig.run(50);
    rig.repeated = vec![motor(Motor::WheelLeft, -1.0), motor(Motor::WheelRight, -1.0)];
    let mut most = 0;
    for _ in 0..1_000 {
        rig.run(1);
        most = most.max(-rig.duties().0).max(-rig.duties().1);
    }
    // 12 % of dead band, and 0.1 of the 0.48 m/s that the rest of the duty makes.
    assert!((1..=303_400).contains(&most), "{most} millionths");
    assert!(rig.has(Inhibit::CliffTrapped) && rig.wheels_off());
    assert!(-rig.distances[0] < 0.01, "{:?}", rig.distances);
}
