//! Packets a second that a script understands, in each language of `clients/scripts`, beside Rust.
//!
//! A server of ours says packets as fast as they are read. What counts is processor time, which a busy machine does not change; a few
//! packets are subtracted from many, so that the start of an interpreter does not count.

use super::BenchArguments;
use crate::{process, processor, system, workspace};
use anyhow::{Context, bail};
use rvac_api::Update;
use serde::Serialize;
use std::io::{Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

const POSE: &str = "{\"e\":\"pose\",\"x\":1.234,\"y\":-0.567,\"heading\":0.123,\"t\":93.25}\x1f";
/// Ends what the script counts.
const END: &str = "{\"e\":\"done\",\"id\":1}\x1f";
const SEPARATOR: u8 = 0x1F;
/// Packets from which the start of a program is known.
const FEW: usize = 1_000;
/// The word with which this program reads packets itself.
const READ: &str = "read";

/// A language: how its program is started, what Debian calls it, and packets that take it about a second.
struct Language {
    name: &'static str,
    program: &'static str,
    package: &'static str,
    script: &'static str,
    many: usize,
}

const LANGUAGES: [Language; 4] = [
    Language {
        name: "Python",
        program: "python3",
        package: "python3",
        script: "robot.py",
        many: 100_000,
    },
    Language {
        name: "Node",
        program: "node",
        package: "nodejs",
        script: "robot.mjs",
        many: 100_000,
    },
    Language {
        name: "shell",
        program: "sh",
        package: "dash",
        script: "robot.sh",
        many: 100_000,
    },
    Language {
        name: "Raku",
        program: "raku",
        package: "rakudo",
        script: "robot.raku",
        many: 6_000,
    },
];
const RUST_MANY: usize = 400_000;

/// What a language does.
#[derive(Debug, Serialize)]
struct Rate {
    language: &'static str,
    /// In a second of one processor.
    packets_per_s: f64,
    /// Processor time of its start and of the first thousand packets, seconds.
    start_s: f64,
}

/// Measures each language; as `read SOCKET` it is the program in Rust that is measured.
pub(super) fn run(arguments: &BenchArguments) -> anyhow::Result<()> {
    if let [word, socket] = arguments.rest.as_slice()
        && word == READ
    {
        return read(Path::new(socket));
    }
    system::need("socat", &["socat"])?;
    let mut rates = vec![rate("Rust", RUST_MANY, |socket| {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(["bench", "scripts", "--", READ]).arg(socket);
        Ok(command)
    })?];
    for language in &LANGUAGES {
        system::need(language.program, &[language.package])?;
        rates.push(rate(language.name, language.many, |socket| {
            let mut command = Command::new(language.program);
            let scripts = workspace::root().join("clients/scripts");
            command.arg(scripts.join(language.script)).arg(socket).arg("rate");
            Ok(command)
        })?);
    }
    if arguments.json {
        process::print(&serde_json::json!({ "scripts": rates }).to_string());
        return Ok(());
    }
    process::print("| language | packets in a second of processor | start, s |\n| --- | --- | --- |");
    for rate in &rates {
        process::print(&format!(
            "| {} | {:.0} | {:.2} |",
            rate.language, rate.packets_per_s, rate.start_s
        ));
    }
    Ok(())
}

fn rate(
    language: &'static str,
    many: usize,
    command: impl Fn(&Path) -> anyhow::Result<Command>,
) -> anyhow::Result<Rate> {
    let start = time_of(FEW, &command).with_context(|| language.to_owned())?;
    let whole = time_of(many, &command).with_context(|| language.to_owned())?;
    let took = whole.saturating_sub(start);
    if took.is_zero() {
        bail!("{language} took no time for {many} packets");
    }
    Ok(Rate {
        language,
        packets_per_s: (many - FEW) as f64 / took.as_secs_f64(),
        start_s: start.as_secs_f64(),
    })
}

/// Processor time in which a program reads so many packets.
fn time_of(count: usize, command: &impl Fn(&Path) -> anyhow::Result<Command>) -> anyhow::Result<Duration> {
    let socket = std::env::temp_dir().join(format!("librervac-scripts-{}", std::process::id()));
    std::fs::remove_file(&socket).ok(); // Of a run that was killed.
    let listener = UnixListener::bind(&socket)?;
    std::thread::spawn(move || {
        if let Ok((mut reader, _)) = listener.accept() {
            // Who has enough goes away.
            reader.write_all(POSE.repeat(count).as_bytes()).ok();
            reader.write_all(END.as_bytes()).ok();
        }
    });
    let before = processor::of_ended_children();
    let output = process::finish(&mut command(&socket)?);
    std::fs::remove_file(&socket).ok();
    let output = output?;
    let said = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() || !said.contains("packets a second: ") {
        bail!("it ended with {} and said {said:?}", output.status);
    }
    Ok(processor::of_ended_children().saturating_sub(before))
}

/// The same as the scripts do, in Rust.
fn read(socket: &Path) -> anyhow::Result<()> {
    let mut stream = UnixStream::connect(socket)?;
    let begun = std::time::Instant::now();
    let (mut received, mut count) = (Vec::new(), 0_u32);
    let mut part = [0; 65_536];
    loop {
        let size = stream.read(&mut part)?;
        if size == 0 {
            bail!("the other end closed too early");
        }
        received.extend_from_slice(part.get(..size).unwrap_or_default());
        let Some(end) = received.iter().rposition(|byte| *byte == SEPARATOR) else {
            continue;
        };
        let rest = received.split_off(end + 1);
        let whole = std::mem::replace(&mut received, rest);
        for message in whole
            .split(|byte| *byte == SEPARATOR)
            .filter(|message| !message.is_empty())
        {
            let Update::Pose(_) = serde_json::from_slice(message)? else {
                let per_s = f64::from(count) / begun.elapsed().as_secs_f64();
                process::print(&format!("packets a second: {per_s:.0}"));
                return Ok(());
            };
            count += 1;
        }
    }
}
