//! One program for all scenarios: each is a part of its own, and all are linked once.

mod beacons;
mod carpets;
mod determinism;
mod edges;
mod floors;
mod forbidden;
mod health;
mod held_stick;
mod history;
mod homecoming;
mod host_death;
mod learnt;
mod leftovers;
mod line_faults;
mod lost_driver;
mod mapping;
mod monitor;
mod outcomes;
mod patterns;
mod recharge;
mod rooms;
mod schedules;
mod second_job;
mod standoff;
mod told_share;
mod visitor;
