//! `rvac drive`: a person drives with a gamepad, the keyboard of the terminal, or a program that sends inputs.
//!
//! However this program ends, its connection ends with it, and the daemon stops the wheels; while it runs, a pad that goes
//! away stops them at once.

mod keys;
mod pad;
mod profile;
mod script;
mod session;
mod shaker;

use std::io::IsTerminal as _;
use std::process::ExitCode;
use std::sync::mpsc::channel;

use anyhow::bail;
use mixer::{Device, PadReading, Source};
use rvac_api::Update;

use crate::arguments::DriveOptions;
use crate::socket::Connection;
use session::Session;
use shaker::Shaker;

pub(crate) use profile::{kept as kept_profiles, named as named_profile, read as read_profile};

/// Something that came in.
#[derive(Debug)]
enum DriveEvent {
    /// An input reads this.
    Moved(Source, f64),
    /// This pad is there from now on, and reads this.
    Plugged(u8, PadReading),
    /// This pad has said something, whatever it was.
    Heard(u8),
    /// A device is gone with all of its inputs.
    Gone(Device),
    /// This pad can shake.
    CanShake(u8, Shaker),
    /// A line to be shown.
    Remark(String),
    /// Nothing more will come: drive no longer.
    Ended,
    /// A line of the script is wrong.
    Wrong(script::LineError),
    /// The daemon says something.
    Daemon(Box<Update>),
    /// The connection to the daemon is gone.
    Lost(anyhow::Error),
}

pub(crate) fn run(options: &DriveOptions) -> anyhow::Result<ExitCode> {
    let mut connection = Connection::open(&options.daemon)?;
    let profile = profile::chosen(options, &mut connection)?;
    let robot = profile::robot(&mut connection)?;
    let (events, inbox) = channel();
    // Restores the terminal when it goes.
    let mut terminal = None;
    if options.readings {
        script::listen(events.clone());
    } else {
        pad::listen(events.clone());
        if !options.pad && std::io::stdin().is_terminal() {
            terminal = Some(keys::listen(events.clone())?);
        } else if !options.pad {
            bail!(
                "the input is no terminal: --pad drives with a gamepad alone, --readings takes readings from the input"
            );
        }
    }
    let mut session = Session::new(connection.sender()?, profile, &robot)?;
    session::hear(connection, events);
    let outcome = session.run(&inbox);
    drop(terminal);
    outcome
}
