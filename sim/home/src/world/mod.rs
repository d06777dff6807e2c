//! A robot in a home, advanced millisecond by millisecond.

mod actuation;
mod battery;
mod body;
mod dirt;
mod dock;
mod fault;
mod floor;
mod gyro;
mod lidar;
mod proximity;
mod sensors;
mod slip;
mod step;
mod truth;
mod walkers;
mod wheel;

use std::sync::Arc;

pub use actuation::{Actuation, Bridge};
pub use battery::{OddCell, Pack, PackMake, Supply};
pub use dock::{BeamStrengths, DockContacts};
pub use fault::{SensorFault, SensorId};
pub use sensors::{DOCK_LEFT, DOCK_NEAR, DOCK_RIGHT, GyroReading, LidarScan, Sensors};
pub use truth::Truth;

pub(crate) use gyro::{DRIFT_STEPS, SimulatedGyro, WALK_STEPS};

use crate::{Home, Noise, Pcg, Pose, RobotModel};
use body::Body;
use dirt::Dirt;
use dock::Dock;
use fault::Faults;
use floor::Underneath;

use lidar::Lidar;
use proximity::Proximity;
use slip::Slip;
use walkers::Walkers;
use wheel::Wheel;

/// A robot in a home. The same seed and the same sequence of calls give the same bits.
#[derive(Clone, Debug)]
pub struct World {
    home: Arc<Home>,
    model: RobotModel,
    noise: Noise,
    body: Body,
    left: Wheel,
    right: Wheel,
    slip: Slip,
    underneath: Underneath,
    proximity: Option<Proximity>,
    gyro: Option<SimulatedGyro>,
    dock: Option<Dock>,
    battery: Pack,
    charging_speed: f64,
    /// Current of the main brush relative to a clean one.
    brush_drag: f64,
    dirt: Dirt,
    lidar: Option<Lidar>,
    faults: Faults,
    /// State of each door at the start.
    doors: Vec<bool>,
    walkers: Walkers,
    /// The body touches somebody's foot, and has pushed against it for so long.
    on_foot: bool,
    foot_pushed_ms: u32,
    random: Pcg,
    thermistor_random: Pcg,
    actuation: Actuation,
    sensors: Sensors,
    truth: Truth,
}

/// Temperature of the room, degrees Celsius.
const ROOM_C: f64 = 22.0;

/// Streams of random numbers, so that one part's draws do not shift another's.
#[derive(Clone, Copy)]
enum Stream {
    Build = 1,
    Run = 2,
    Dirt = 3,
    Faults = 4,
    Dock = 5,
    Thermistor = 6,
    SwitchOn = 7,
}

/// What a robot and its run are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorldSeeds {
    /// The robot as it was built (wheels, scale of its gyro) and how bright its home is.
    pub build: u64,
    /// What differs from run to run: slip, noise, the gyro's bias at switch-on, dirt.
    pub run: u64,
}

impl From<u64> for WorldSeeds {
    /// A robot of its own for each run.
    fn from(seed: u64) -> Self {
        Self {
            build: seed,
            run: seed,
        }
    }
}

impl World {
    /// Puts a robot into a home: at `start` (plan frame), or where the home says. Whatever differs from robot to robot and
    /// from run to run (wheel errors, gyro bias, albedo, dirt) comes from `noise` and `seeds`; a number is both seeds. The
    /// battery is full.
    #[must_use]
    #[expect(
        clippy::too_many_arguments,
        reason = "home, robot, noise, seed and start are five different things"
    )]
    pub fn new(
        home: Arc<Home>,
        model: &RobotModel,
        noise: &Noise,
        seeds: impl Into<WorldSeeds>,
        start: Option<Pose>,
    ) -> Self {
        let WorldSeeds { build, run } = seeds.into();
        let mut build_random = Pcg::new(build, Stream::Build as u64);
        let random = &mut build_random;
        let pose = start.unwrap_or(home.start());
        let (slip, errors) = Slip::new(model, noise, random);
        let mut world = Self {
            body: Body::new(model, pose),
            left: Wheel::new(model, errors.left),
            right: Wheel::new(model, errors.right),
            slip,
            underneath: Underneath::new(model, noise, random),
            proximity: model
                .proximity
                .as_ref()
                .map(|part| Proximity::new(part, model.body.radius_m, noise, random)),
            gyro: model
                .gyro
                .as_ref()
                .map(|part| SimulatedGyro::new(part, noise, random)),
            dock: Dock::of(&home, model, Pcg::new(run, Stream::Dock as u64)),
            battery: Pack::new(PackMake::of(&model.battery), 1.0, ROOM_C),
            charging_speed: 1.0,
            brush_drag: 1.0,
            dirt: Dirt::new(&home, model.body.swath_m, &mut Pcg::new(run, Stream::Dirt as u64)),
            lidar: model.lidar.map(Lidar::new),
            faults: Faults::new(Pcg::new(run, Stream::Faults as u64)),
            doors: home.doors.iter().map(|door| door.open).collect(),
            walkers: Walkers::new(&home.walkers),
            on_foot: false,
            foot_pushed_ms: 0,
            random: Pcg::new(run, Stream::Run as u64),
            thermistor_random: Pcg::new(run, Stream::Thermistor as u64),
            actuation: Actuation::default(),
            sensors: Sensors {
                dust_box: true,
                gyro: model.gyro.map(|_| GyroReading::default()),
                ..Sensors::default()
            },
            truth: Truth::at(pose),
            model: model.clone(),
            noise: *noise,
            home,
        };
        if run != build
            && let Some(gyro) = &mut world.gyro
        {
            gyro.switch_on(noise, &mut Pcg::new(run, Stream::SwitchOn as u64));
        }
        world.settle();
        world
    }

    /// What the firmware can read now.
    #[must_use]
    pub fn sensors(&self) -> &Sensors {
        self.faults.shown().unwrap_or(&self.sensors)
    }

    /// What the firmware put on its pins in the last step: a copy of this world that is stepped with the same goes the
    /// same way.
    #[must_use]
    pub const fn actuation(&self) -> &Actuation {
        &self.actuation
    }

    /// The last complete turn of the lidar, if the robot has one.
    #[must_use]
    pub fn lidar(&self) -> Option<&LidarScan> {
        self.lidar.as_ref().map(|lidar| &lidar.scan)
    }

    /// What is really so.
    #[must_use]
    pub const fn truth(&self) -> &Truth {
        &self.truth
    }

    /// Positions of the left and right wheel in encoder counts and fractions of them: what the encoders would show if
    /// they were perfect.
    #[must_use]
    pub fn encoder_positions(&self) -> [f64; 2] {
        [self.left.exact_count(), self.right.exact_count()]
    }

    /// What the motors of left and right wheel really draw, ampere.
    #[must_use]
    pub const fn wheel_currents_a(&self) -> [f64; 2] {
        [self.left.current_a, self.right.current_a]
    }

    /// What the gyro's turns must be multiplied by, less 1, to be true; `None` without a gyro.
    #[must_use]
    pub fn gyro_scale_error(&self) -> Option<f64> {
        self.gyro.as_ref().map(SimulatedGyro::scale_error)
    }

    /// The home as it is now, doors included.
    #[must_use]
    pub const fn home(&self) -> &Arc<Home> {
        &self.home
    }

    /// Pose of a robot on the dock's contacts, if there is a dock.
    #[must_use]
    pub fn docked_pose(&self) -> Option<Pose> {
        self.dock.as_ref().map(Dock::docked)
    }

    /// Shifts the dock along its wall (left positive, as seen from the dock) and turns it.
    pub fn push_dock(&mut self, aside_m: f64, turn_rad: f64) {
        if let Some(dock) = &mut self.dock {
            dock.push(aside_m, turn_rad, &self.model);
        }
    }

    /// Moves the dock elsewhere: `pose` is the middle of its back, facing the room (plan frame). A
    /// home without one stays without.
    pub fn put_dock(&mut self, pose: Pose) {
        if let Some(dock) = &mut self.dock {
            dock.stand_at(pose, &self.model);
        }
    }

    /// Attenuation and reflections of the dock's beams.
    pub fn set_dock_beams(&mut self, beams: BeamStrengths) {
        if let Some(dock) = &mut self.dock {
            dock.set_beams(beams);
        }
    }

    /// What the dock's contacts do.
    pub fn set_dock_contacts(&mut self, contacts: DockContacts) {
        if let Some(dock) = &mut self.dock {
            dock.set_contacts(contacts);
        }
    }

    /// Whether the dock has mains.
    pub fn set_dock_power(&mut self, is_powered: bool) {
        if let Some(dock) = &mut self.dock {
            dock.set_power(is_powered);
        }
    }

    /// Whether current flows from the dock into a robot that lets it in.
    #[must_use]
    pub fn dock_gives_current(&self) -> bool {
        self.dock.as_ref().is_some_and(Dock::gives_current)
    }

    /// The robot.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }

    /// The cells of the reachable floor that the swath has passed, in the order of the grid's cells.
    #[must_use]
    pub fn swept(&self) -> &[bool] {
        &self.dirt.swept
    }

    /// Begins a part of a job: after a charge, for instance. See [`Self::cleaned_again_share`].
    pub fn begin_stretch(&mut self) {
        self.dirt.begin_stretch();
    }

    /// Share of the reachable floor that was cleaned (brush and suction running) in one part and again in a later
    /// one.
    #[must_use]
    pub fn cleaned_again_share(&self) -> f64 {
        f64::from(self.dirt.again_cells()) / f64::from(self.home.reachable_cells().max(1))
    }

    /// Somebody lifts the robot: both wheels hang, it does not move any more.
    pub fn lift(&mut self) {
        self.truth.lifted = true;
        self.body.leave_contact();
        self.settle();
    }

    /// Puts the robot down where it was lifted. A robot that fell down the stairs is put back to the place where it
    /// started.
    pub fn put_down(&mut self) {
        let pose = if self.truth.fallen {
            self.home.start()
        } else {
            self.body.pose()
        };
        self.put_down_at(pose);
    }

    /// Puts the robot down somewhere else (plan frame).
    pub fn put_down_at(&mut self, pose: Pose) {
        self.truth.lifted = false;
        self.truth.fallen = false;
        self.body.place(pose);
        self.underneath.forget();
        self.settle();
    }

    /// Somebody presses a button until it is released. A number that the robot has not is ignored.
    pub fn press_button(&mut self, button: u8) {
        if button < self.model.buttons {
            self.sensors.buttons |= 1u8.checked_shl(button.into()).unwrap_or(0);
        }
    }

    /// Somebody lets go of a button.
    pub fn release_button(&mut self, button: u8) {
        self.sensors.buttons &= !1u8.checked_shl(button.into()).unwrap_or(0);
    }

    /// Turns the left and right wheel by hand at these speeds of their rims, m/s, regardless of the motors:
    /// pushes or turns the robot on the floor, or turns the wheels of a lifted one. 0 holds a wheel fast; `None` lets
    /// go of both.
    pub const fn turn_wheels(&mut self, rims_m_per_s: Option<[f64; 2]>) {
        let (left, right) = match rims_m_per_s {
            Some([left, right]) => (Some(left), Some(right)),
            None => (None, None),
        };
        self.left.hold(left);
        self.right.hold(right);
    }

    /// Takes the dust box out.
    pub const fn remove_dust_box(&mut self) {
        self.sensors.dust_box = false;
    }

    /// Puts the dust box in.
    pub const fn insert_dust_box(&mut self) {
        self.sensors.dust_box = true;
    }

    /// Sets the charge of the battery, clamped to 0..1.
    pub fn set_battery_charge(&mut self, charge: f64) {
        self.set_pack(Pack::new(
            PackMake::of(&self.model.battery),
            charge.clamp(0.0, 1.0),
            ROOM_C,
        ));
    }

    /// Lets the pack fill so many times as fast as its current would, up to 95 %: what the charger measures of temperature
    /// and time stays as it is. For simulations that cannot wait for a charge.
    pub fn set_charging_speed(&mut self, times: f64) {
        self.charging_speed = times.max(1.0);
    }

    /// Winds hair around the main brush: its motor draws so many times the current of a clean one.
    pub fn wind_brush(&mut self, times: f64) {
        self.brush_drag = times.clamp(0.0, 10.0);
    }

    /// The bias of the robot's own gyro, if it has one, changes by so much: a part that warms up.
    pub fn shift_gyro_bias(&mut self, rad_per_s: f64) {
        if let Some(gyro) = &mut self.gyro {
            gyro.shift_bias(rad_per_s);
        }
    }

    /// Puts another pack in.
    pub fn set_pack(&mut self, pack: Pack) {
        self.truth.battery_charge = pack.charge();
        self.battery = pack;
    }

    /// Makes a sensor faulty, or (`None`) repairs it. A sensor that the robot lacks is ignored.
    pub fn set_fault(&mut self, sensor: SensorId, fault: Option<SensorFault>) {
        self.faults.set(sensor, fault, &self.sensors);
    }
}
