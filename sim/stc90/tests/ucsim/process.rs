//! uCsim.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// Names of the program, by release.
const PROGRAMS: [&str; 2] = ["s51", "ucsim_51"];

/// The program.
#[derive(Debug)]
pub(crate) struct UcSim(&'static str);

impl UcSim {
    /// Looks for it. On the build machine it must be there; elsewhere its absence is told.
    pub(crate) fn find() -> Option<Self> {
        let is_there = |program: &&str| Command::new(program).arg("-V").output().is_ok();
        let found = PROGRAMS.into_iter().find(is_there);
        if found.is_none() {
            assert!(std::env::var_os("CI").is_none(), "uCsim is not installed");
            println!("skipped: uCsim is not installed (Debian: apt-get install sdcc-ucsim)");
        }
        found.map(Self)
    }

    /// Executes commands of its console on an 8052 with a program, and gives what it prints: each command, and what it
    /// answers.
    pub(crate) fn run(&self, hex: &str, commands: &str) -> Output {
        self.run_with_line(hex, commands, &[])
    }

    /// The same while these bytes come in by the UART.
    pub(crate) fn run_with_line(&self, hex: &str, commands: &str, line_in: &[u8]) -> Output {
        let folder = Folder::new();
        let (program, script) = (folder.file("program.ihx"), folder.file("commands"));
        let (line, heard) = (folder.file("line"), folder.file("heard"));
        std::fs::write(&heard, line_in).expect("a temporary file");
        std::fs::write(&program, hex).expect("a temporary file");
        let load = format!("file \"{}\"\nreset\n", program.display());
        std::fs::write(&script, format!("{load}{commands}quit\n")).expect("a temporary file");
        let output = Command::new(self.0)
            .args(["-q", "-b", "-R", "1", "-t", "C52", "-X", "12M", "-C"])
            .arg(&script)
            // Without the first, input is looked at once a second.
            .args(["-e", "uart0_check_often=1", "-S"])
            .arg(format!("uart=0,in={},out={}", heard.display(), line.display()))
            .stdin(Stdio::null())
            .output();
        Output {
            printed: output.expect("uCsim was found").stdout,
            sent: std::fs::read(line).unwrap_or_default(),
        }
    }
}

/// What came of a run.
#[derive(Debug)]
pub(crate) struct Output {
    /// On the console.
    pub(crate) printed: Vec<u8>,
    /// By the UART.
    pub(crate) sent: Vec<u8>,
}

/// A temporary folder that goes away with its owner.
#[derive(Debug)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new() -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("stc90-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that stays behind is no reason to fail.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
