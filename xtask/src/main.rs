//! `cargo xtask`: the commands that build, run, test and keep the project in order.
//!
//! Each subcommand is a module. They start programs and read files; nothing of the robot's own logic lives here.
#![forbid(unsafe_code)]

mod bench;
mod book;
mod book_pictures;
mod bundle;
mod chip;
mod codegen;
mod demo;
mod fetched;
mod firmware;
mod hardware;
mod markdown_links;
mod metadata;
mod new_robot;
mod package;
mod panel;
mod process;
mod processor;
mod system;
mod test;
mod tidy;
mod toolchain;
mod workspace;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Commands of the LibreRVAC project.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Builds everything, starts a simulated robot with the whole software, and prints the address of its panel.
    Demo(demo::DemoArguments),
    /// Runs the checks and tests of the project; with --all every one of them.
    Test(test::TestArguments),
    /// Builds the firmware of a robot and tells what it takes.
    Firmware(firmware::FirmwareArguments),
    /// Checks our circuit boards with KiCad 6 and makes Gerber files, drawings and pictures of them.
    Hardware(hardware::HardwareArguments),
    /// Measures one part of the project and prints its figures: the link, the daemon, the simulator, the firmware, how the robot cleans.
    Bench(bench::BenchArguments),
    /// Checks the rules of the repository.
    Tidy(tidy::TidyArguments),
    /// Writes the generated files, or with --check says which are stale.
    Codegen(codegen::CodegenArguments),
    /// Makes the folders of a new robot, with firmware that says hello.
    NewRobot(new_robot::NewRobotArguments),
    /// Packs the programs for the Linux board, for Debian and as archives.
    Package(package::PackageArguments),
    /// Makes a signed update of daemon, panel and firmware for one robot and one processor; or a pair of keys.
    Bundle(bundle::BundleArguments),
    /// Builds the panel for the browser and packs it; with --json tells what a first visit brings over the network.
    Panel(panel::PanelArguments),
    /// Makes the book as a site, and checks all its links.
    Book(book::BookArguments),
    /// Makes the pictures of the book's measurements with today's code.
    BookPictures,
}

fn main() -> ExitCode {
    if let Err(error) = firmware::build::as_compiler() {
        process::complain(&format!("{error:#}"));
        return ExitCode::FAILURE;
    }
    let outcome = match Arguments::parse().command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Test(arguments) => test::run(&arguments),
        Command::Firmware(arguments) => firmware::run(&arguments),
        Command::Hardware(arguments) => hardware::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Tidy(arguments) => tidy::run_with(&arguments),
        Command::Codegen(arguments) => codegen::run(&arguments),
        Command::NewRobot(arguments) => new_robot::run(&arguments),
        Command::Package(arguments) => package::run(&arguments),
        Command::Bundle(arguments) => bundle::run(&arguments),
        Command::Book(arguments) => book::run(&arguments),
        Command::BookPictures => book_pictures::run(),
        Command::Panel(arguments) => panel::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            process::complain(&format!("{error:#}"));
            ExitCode::FAILURE
        }
    }
}
