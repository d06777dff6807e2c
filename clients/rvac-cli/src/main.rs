//! `rvac`: the robot from the command line. It talks to the daemon over its socket, and to the robot itself as a terminal
//! for people who type packets.
#![forbid(unsafe_code)]

mod arguments;
mod board;
mod calibrate;
mod control;
mod devices;
mod drive;
mod floors;
#[cfg(test)]
#[path = "../../panel-server/tests/folder/mod.rs"]
mod folder;
mod health;
mod history;
mod home;
mod learnt;
mod lines;
mod listen;
mod manual;
mod mixes;
mod orders;
mod packet;
mod plain;
mod probe;
mod qr;
mod remote;
mod replay;
mod robot;
mod schedules;
mod setup;
mod show;
mod socket;
mod statistics;
mod status;
mod term;
mod why;

use std::io::Write as _;
use std::process::ExitCode;

use arguments::{Arguments, Subcommand};
use clap::Parser as _;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.subcommand {
        Subcommand::Term(options) => term::run(&options),
        Subcommand::Packet(job) => packet::run(&job),
        Subcommand::Status(options) => status::print(&options),
        Subcommand::Watch(options) => status::watch(&options),
        Subcommand::Map(job) => home::run(&job),
        Subcommand::Floor(job) => floors::run(&job),
        Subcommand::Clean(order) => orders::clean(&order),
        Subcommand::Estimate(options) => orders::estimate(&options),
        Subcommand::Rooms(job) => orders::rooms(&job),
        Subcommand::Places(job) => orders::places(&job),
        Subcommand::Zone(job) => orders::zones(&job),
        Subcommand::Schedule(job) => schedules::run(&job),
        Subcommand::History(job) => history::run(&job),
        Subcommand::Statistics(options) => statistics::run(&options),
        Subcommand::Health(job) => health::run(&job),
        Subcommand::Learnt(job) => learnt::run(&job),
        Subcommand::Why(options) => why::run(&options),
        Subcommand::Replay(options) => replay::run(&options),
        Subcommand::Calibrate(options) => calibrate::run(&options),
        Subcommand::Probe(job) => probe::run(&job),
        Subcommand::Drive(options) => drive::run(&options),
        Subcommand::Mix(job) => mixes::run(&job),
        Subcommand::Setup(options) => setup::run(&options),
        Subcommand::Doctor(options) => setup::doctor(&options),
        Subcommand::Pair(options) => devices::pair(&options),
        Subcommand::Clients(job) => devices::clients(&job),
        Subcommand::Trust(options) => devices::trust(&options),
        Subcommand::Flash { job, socket } => rvac_flash::run(&job, &rvac_flash::DaemonSocket(socket)),
        Subcommand::Update { job, socket } => rvac_update::run(&job, &socket),
        Subcommand::Completions { shell } => manual::completions(shell),
        Subcommand::Manual { folder } => manual::write(&folder),
        Subcommand::Start { strategy, daemon } => control::start(strategy, &daemon),
        Subcommand::Stop(daemon) => control::send(rvac_api::RequestBody::Stop, &daemon),
        Subcommand::Pause(daemon) => control::send(rvac_api::RequestBody::Pause, &daemon),
        Subcommand::Resume(daemon) => control::send(rvac_api::RequestBody::Resume, &daemon),
        Subcommand::Dock(daemon) => control::send(rvac_api::RequestBody::Dock, &daemon),
        Subcommand::Spot(daemon) => control::send(rvac_api::RequestBody::Spot, &daemon),
        Subcommand::Go { place, daemon } => {
            let (x, y) = (place.x_m, place.y_m);
            control::send(rvac_api::RequestBody::GoTo { x, y }, &daemon)
        }
        Subcommand::Locate(daemon) => control::send(rvac_api::RequestBody::Locate, &daemon),
    };
    match outcome {
        Ok(code) => code,
        Err(error) if is_closed_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            // There is no other place to report that even this cannot be written.
            writeln!(std::io::stderr(), "rvac: {error:#}").ok();
            ExitCode::FAILURE
        }
    }
}

/// `rvac watch | head` ends when head does; that is no error.
fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let io = error.downcast_ref::<std::io::Error>();
    io.is_some_and(|io| io.kind() == std::io::ErrorKind::BrokenPipe)
}
