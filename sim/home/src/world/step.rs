//! One millisecond of the world: what happens in which order, and how often each sensor is sampled.

use std::sync::Arc;

use rvac_units::{Current, Temperature, Voltage};

use super::body::RIGID;
use super::gyro::{DRIFT_STEPS, WALK_STEPS};
use super::proximity::Surroundings;
use super::slip::DRAW_STEPS;
use super::walkers::{RobotDisc, WALK_MS};
use super::wheel::STEP_S;
use super::{Actuation, World};
use crate::plan::Solid;

/// Milliseconds between two samples of one proximity sensor after the other: 7 sensors at 48 Hz.
const PROXIMITY_MS: u64 = 3;
/// Milliseconds between two samples of the cliff sensors.
const CLIFF_MS: u64 = 4;
/// Milliseconds between two samples of the floor's surface.
const SURFACE_MS: u64 = 8;
/// Milliseconds between two steps of battery and currents.
const BATTERY_MS: u64 = 10;
/// Milliseconds between two samples of the dock's beams.
const DOCK_MS: u64 = 40;
/// Less than this into the pack is a trickle, which is not hastened, ampere.
const HASTE_FROM_A: f64 = 0.1;
/// Noise of the thermistor's reading, degrees: about half a count of a ten-bit converter at room temperature, as any
/// converter has. A reading without any looks like a dead sensor to a firmware that checks for one. Not measured.
const THERMISTOR_C: f64 = 0.1;
/// Milliseconds between two checks of the doors.
const DOOR_MS: u64 = 256;
/// Milliseconds between two computations of the direction of a lasting contact.
const CONTACT_MS: u64 = 10;
/// Slower wheels do not push.
const PUSH_M_PER_S: f64 = 0.01;
/// A door waits until the robot is this far from its leaf, metres beyond the body.
const DOOR_GAP_M: f64 = 0.02;

/// What is solid now. A macro, because a method would borrow all of the world.
macro_rules! solid {
    ($world:expr) => {
        Solid {
            plan: &$world.home.solid,
            feet: &$world.walkers.feet,
        }
    };
}

impl World {
    /// Advances exactly one millisecond with these outputs of the firmware.
    pub fn step(&mut self, actuation: &Actuation) {
        self.truth.time_ms += 1;
        self.actuation = *actuation;
        let turn_rad = self.move_body(actuation);
        self.judge_foot();
        if let Some(gyro) = &mut self.gyro {
            gyro.step(turn_rad);
        }
        self.sample(actuation);
        self.publish(actuation);
        self.faults.apply(&self.sensors);
    }

    /// Brings all sensors up to date after the robot was put somewhere.
    pub(super) fn settle(&mut self) {
        let actuation = Actuation {
            cliff_emitter: true,
            ..Actuation::default()
        };
        let now_ms = self.truth.time_ms;
        if !self.is_in_air() {
            self.body.collide(solid!(self), now_ms);
        }
        self.underneath.move_on(&self.home, &self.body, 0.0);
        self.underneath.sample_surface(&self.home, &self.body);
        self.sample_cliffs();
        self.step_battery(&actuation, 0.0);
        if let Some(dock) = &mut self.dock {
            dock.sample_contacts(&self.body);
            dock.sample_beams(&self.model, solid!(self), &self.body);
        }
        self.publish(&actuation);
        self.faults.apply(&self.sensors);
    }

    fn is_in_air(&self) -> bool {
        self.truth.lifted || self.truth.fallen
    }

    /// Turns the wheels and moves the body; gives the true turn in radians.
    fn move_body(&mut self, actuation: &Actuation) -> f64 {
        let (left, right) = (actuation.wheel_left, actuation.wheel_right);
        let driven = left.pwm != 0.0 || right.pwm != 0.0;
        if !driven && self.left.is_standing() && self.right.is_standing() {
            (self.left.current_a, self.right.current_a) = (0.0, 0.0);
            self.truth.speed_m_per_s = 0.0;
            self.truth.turn_rad_per_s = 0.0;
            self.body.rest(self.truth.time_ms);
            return 0.0;
        }
        let supply = self.battery.supply();
        let (load_left, load_right) = (self.load_n(left.pwm), self.load_n(right.pwm));
        let mut left_m = self.left.step(left, supply, load_left);
        let mut right_m = self.right.step(right, supply, load_right);
        if self.is_in_air() {
            self.truth.speed_m_per_s = 0.0;
            self.truth.turn_rad_per_s = 0.0;
            return 0.0;
        }
        if self.underneath.left_over_cliff {
            left_m = 0.0;
        }
        if self.underneath.right_over_cliff {
            right_m = 0.0;
        }
        self.roll(left_m, right_m)
    }

    /// Force against a wheel: rugs and thresholds, and everything that the body pushes against.
    fn load_n(&self, pwm: f64) -> f64 {
        if self.is_in_air() {
            return 0.0;
        }
        let push_n = self.body.push_n(1f64.copysign(pwm), &self.model.wheel_motor);
        self.underneath.surface.drag_n + push_n
    }

    fn roll(&mut self, left_m: f64, right_m: f64) -> f64 {
        let (distance_m, mut turn_rad) = self.slip.motion(left_m, right_m, &self.underneath.surface);
        turn_rad *= 1.0 - self.body.wall_friction();
        let (x_m, y_m) = (self.body.x_m, self.body.y_m);
        self.body.advance(distance_m, turn_rad);
        self.body.collide(solid!(self), self.truth.time_ms);
        self.underneath.move_on(&self.home, &self.body, distance_m);
        let (dx, dy) = (self.body.x_m - x_m, self.body.y_m - y_m);
        let along_m = dx * self.body.cos + dy * self.body.sin;
        self.truth.path_m += libm::sqrt(dx * dx + dy * dy);
        self.truth.speed_m_per_s = along_m / STEP_S;
        self.truth.turn_rad_per_s = turn_rad / STEP_S;
        if self.underneath.centre_over_cliff {
            self.truth.fallen = true;
        }
        turn_rad
    }

    /// Samples what is due in this millisecond. Phases differ, so that the work is spread.
    fn sample(&mut self, actuation: &Actuation) {
        let now_ms = self.truth.time_ms;
        if now_ms.is_multiple_of(PROXIMITY_MS)
            && let Some(proximity) = &mut self.proximity
        {
            let around = Surroundings {
                home: &self.home,
                solid: solid!(self),
            };
            proximity.sample_next(around, &self.body, &mut self.random);
        }
        if now_ms % CLIFF_MS == 1 {
            self.sample_cliffs();
        }
        if now_ms % SURFACE_MS == 2 {
            self.underneath.sample_surface(&self.home, &self.body);
        }
        if now_ms % BATTERY_MS == 3 {
            self.step_battery(actuation, BATTERY_MS as f64 * STEP_S);
            self.sweep(actuation);
        }
        if now_ms % DRAW_STEPS == 4 {
            self.slip.draw(&mut self.random);
        }
        if now_ms % WALK_STEPS == 5
            && let Some(gyro) = &mut self.gyro
        {
            gyro.walk(&mut self.random);
        }
        if let Some(lidar) = &mut self.lidar {
            lidar.step(solid!(self), &self.body, &mut self.random);
        }
        self.sample_seldom(now_ms);
    }

    fn sample_seldom(&mut self, now_ms: u64) {
        if now_ms % DOCK_MS == 7
            && let Some(dock) = &mut self.dock
        {
            dock.sample_contacts(&self.body);
            dock.sample_beams(&self.model, solid!(self), &self.body);
        }
        if now_ms % DOOR_MS == 9 && !self.doors.is_empty() {
            self.move_doors();
        }
        if now_ms % WALK_MS == 13 && !self.walkers.is_empty() {
            self.walk(now_ms);
        }
        if now_ms % DRIFT_STEPS == 11 {
            self.underneath.flicker(&mut self.random);
            if let Some(gyro) = &mut self.gyro {
                gyro.drift(&mut self.random);
            }
        }
    }

    fn sample_cliffs(&mut self) {
        let in_air = self.is_in_air();
        self.underneath
            .sample_cliffs(&self.model, (&self.home, &self.body), in_air);
    }

    fn sweep(&mut self, actuation: &Actuation) {
        if !self.truth.hanging() {
            let cleaning = actuation.brush_main.abs() > 0.05 && actuation.vacuum;
            let now_ms = self.truth.time_ms;
            self.dirt.pass(&self.home, self.body.pose(), (now_ms, cleaning));
        }
    }

    /// Lets people and pets walk.
    fn walk(&mut self, now_ms: u64) {
        let robot = RobotDisc {
            x_m: self.body.x_m,
            y_m: self.body.y_m,
            radius_m: self.model.body.radius_m,
        };
        if self.walkers.walk(now_ms, robot, &self.home.solid) {
            self.body.free_m = 0.0;
        }
    }

    /// Whether the robot pushes against a foot: the contact is rigid, and the wheels keep driving towards it.
    fn judge_foot(&mut self) {
        let Some(contact) = self.body.contact.filter(|contact| contact.is_foot) else {
            self.foot_pushed_ms = 0;
            self.on_foot = false;
            return;
        };
        if !self.on_foot {
            self.on_foot = true;
            self.truth.foot_contacts += 1;
        }
        let rims_m_per_s = 0.5 * (self.left.rim_m_per_s + self.right.rim_m_per_s);
        let pushes = contact.compression >= RIGID && rims_m_per_s * contact.forward > PUSH_M_PER_S;
        self.foot_pushed_ms = if pushes { self.foot_pushed_ms + 1 } else { 0 };
        self.truth.foot_pushed_max_ms = self.truth.foot_pushed_max_ms.max(self.foot_pushed_ms);
    }

    /// Opens and closes doors; a leaf waits for the robot to leave.
    fn move_doors(&mut self) {
        let now_ms = self.truth.time_ms;
        for (number, initially) in self.doors.iter().enumerate() {
            let Some(door) = self.home.doors.get(number) else {
                continue;
            };
            let open = door.wanted_open(now_ms, *initially);
            if open == door.open {
                continue;
            }
            let near_m = self.model.body.radius_m + DOOR_GAP_M;
            let in_the_way = door.cells.iter().any(|(index, _)| {
                let (x_m, y_m) = self.home.grid().centre(*index);
                libm::hypot(x_m - self.body.x_m, y_m - self.body.y_m) < near_m
            });
            if open || !in_the_way {
                self.home = Arc::new(self.home.with_door(number, open));
                self.body.free_m = 0.0;
                return;
            }
        }
    }

    fn step_battery(&mut self, actuation: &Actuation, dt_s: f64) {
        let cleaners = &self.model.cleaners;
        let on_floor = if self.is_in_air() {
            1.0
        } else {
            1.0 + self.underneath.brush_load
        };
        let brush_a = self.brush_drag * on_floor * cleaners.main_a * actuation.brush_main.abs().min(1.0);
        let sides_a = if actuation.brush_sides {
            cleaners.sides_a
        } else {
            0.0
        };
        let vacuum_a = if actuation.vacuum { cleaners.vacuum_a } else { 0.0 };
        let motors_a = self.left.current_a + self.right.current_a + brush_a + sides_a + vacuum_a;
        let dock_a = match &self.dock {
            Some(dock) if dock.gives_current() && !self.is_in_air() => {
                let battery = &self.model.battery;
                let offered_a = if actuation.dock_signal {
                    battery.charge_a
                } else {
                    battery.trickle_a
                };
                actuation.charge_a.unwrap_or(offered_a)
            }
            _ => 0.0,
        };
        self.battery
            .step(dock_a - (self.model.battery.electronics_a + motors_a), dt_s);
        if self.charging_speed > 1.0 && dock_a > HASTE_FROM_A {
            self.battery.hasten((self.charging_speed - 1.0) * dock_a * dt_s);
        }
        self.publish_battery(brush_a);
    }

    fn publish_battery(&mut self, brush_a: f64) {
        let deviation = self.noise.analog;
        let mut noisy = |value: f64| value * (1.0 + 0.2 * deviation * self.random.normal());
        self.sensors.battery_voltage = Voltage::from_v(noisy(self.battery.voltage_v()));
        self.sensors.battery_current = Current::from_a(noisy(self.battery.current_a()));
        self.sensors.battery_temperature = Temperature::from_celsius(
            self.battery.sensor_c() + THERMISTOR_C * self.thermistor_random.normal(),
        );
        self.sensors.wheel_left_current = Current::from_a(noisy(self.left.current_a));
        self.sensors.wheel_right_current = Current::from_a(noisy(self.right.current_a));
        self.sensors.brush_main_current = Current::from_a(noisy(brush_a));
        self.truth.battery_charge = self.battery.charge().min(1.0);
        self.truth.battery_hottest_c = self.battery.hottest_c();
        self.truth.battery_c = self.battery.temperature_c();
        self.truth.battery_v = self.battery.voltage_v();
        self.truth.battery_a = self.battery.current_a();
        self.truth.dirt_share = self.dirt.share();
        self.truth.swept_m2 = f64::from(self.dirt.swept_cells) * self.home.grid().cell_area_m2();
        self.truth.swept_twice_m2 = f64::from(self.dirt.twice_cells) * self.home.grid().cell_area_m2();
        self.truth.swept_share =
            f64::from(self.dirt.swept_cells) / f64::from(self.home.reachable_cells().max(1));
    }

    /// Copies the state of this millisecond to where firmware and judges read it.
    fn publish(&mut self, actuation: &Actuation) {
        let now_ms = self.truth.time_ms;
        let in_air = self.is_in_air();
        self.sensors.count_left = self.left.count;
        self.sensors.count_right = self.right.count;
        self.sensors.gyro = self.gyro.as_ref().map(super::SimulatedGyro::reading);
        (self.sensors.bumper_left, self.sensors.bumper_right) = self.body.pressed(now_ms);
        self.sensors.cliff_levels = self.underneath.levels(actuation.cliff_emitter);
        self.sensors.cliff_dark = self.underneath.levels(false);
        self.sensors.wheel_drop_left = in_air || self.underneath.left_over_cliff;
        self.sensors.wheel_drop_right = in_air || self.underneath.right_over_cliff;
        if self.model.wheel_drops < 2 {
            let any = self.sensors.wheel_drop_left || self.sensors.wheel_drop_right;
            let any = any && self.model.wheel_drops > 0;
            (self.sensors.wheel_drop_left, self.sensors.wheel_drop_right) = (any, any);
        }
        if let Some(proximity) = &self.proximity {
            self.sensors.proximity = proximity.levels;
        }
        if let Some(dock) = &self.dock {
            self.sensors.dock_receivers = dock.symbols;
            self.sensors.dock_contacts = dock.gives_voltage() && !in_air;
            self.truth.docked = dock.docked_now && !in_air;
        }
        self.truth.pose = self.body.pose();
        self.truth.rim_left_m_per_s = self.left.rim_m_per_s;
        self.truth.rim_right_m_per_s = self.right.rim_m_per_s;
        self.truth.left_over_cliff = self.underneath.left_over_cliff;
        self.truth.right_over_cliff = self.underneath.right_over_cliff;
        if self.body.contact.is_none() {
            self.truth.contact_rad = None;
        } else if self.truth.contact_rad.is_none() || now_ms.is_multiple_of(CONTACT_MS) {
            self.truth.contact_rad = self.body.contact_rad();
        }
        self.truth.contacts = self.body.contacts;
    }
}
