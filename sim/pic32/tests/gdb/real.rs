//! gdb-multiarch over TCP.

use crate::program::{COUNTER, FUNCTION, machine};
use pic32::gdb::{DebugChip, serve};
use pic32::machine::Grounded;
use std::net::TcpListener;
use std::process::Command;

const PROGRAM: &str = "gdb-multiarch";

/// Whether it is there. On the build machine it must be; elsewhere its absence is told.
fn is_installed() -> bool {
    match Command::new(PROGRAM).arg("--version").output() {
        Ok(_) => true,
        Err(error) => {
            assert!(std::env::var_os("CI").is_none(), "{PROGRAM}: {error}");
            println!("skipped: {PROGRAM} is not installed (Debian: apt-get install gdb-multiarch)");
            false
        }
    }
}

#[test]
fn gdb_debugs_a_program() {
    if !is_installed() {
        return;
    }
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port of this machine");
    let port = listener.local_addr().expect("it is bound").port();
    let commands = [
        "set confirm off".to_owned(),
        "set remotetimeout 20".to_owned(),
        format!("target remote 127.0.0.1:{port}"),
        "printf \"begin %x\\n\", $pc".to_owned(),
        format!("break *{FUNCTION:#x}"),
        "continue".to_owned(),
        format!("printf \"function %x %d %d\\n\", $pc, $v0, *(int*){COUNTER:#x}"),
        "continue 3".to_owned(),
        "printf \"later %d\\n\", $v0".to_owned(),
        "stepi".to_owned(),
        "stepi".to_owned(),
        "printf \"back %x\\n\", $pc".to_owned(),
        "set $v0 = 500".to_owned(),
        format!("set *(int*){:#x} = -2", COUNTER + 4),
        "continue".to_owned(),
        format!("printf \"changed %d %d\\n\", $v0, *(int*){:#x}", COUNTER + 4),
        "x/1i $pc".to_owned(),
        "printf \"status %x\\n\", $status".to_owned(),
        "monitor cycle".to_owned(),
        "monitor reset".to_owned(),
        "maintenance flush register-cache".to_owned(),
        "printf \"reset %x\\n\", $pc".to_owned(),
        "detach".to_owned(),
    ];
    let mut command = Command::new(PROGRAM);
    command.args(["--nx", "--batch"]);
    commands.iter().for_each(|text| {
        command.args(["-ex", text]);
    });
    let debugger = std::thread::spawn(move || command.output());
    let (mut machine, mut around) = (machine(), Grounded);
    serve(&listener, &mut DebugChip::new(&mut machine, &mut around)).expect("the connection holds");
    let output = debugger.join().expect("the thread ends").expect("it was found");
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    for wanted in [
        "begin bfc00000",
        "function 9d000040 1 1",
        "later 4",
        "back 9d00000c",
        "changed 501 -2",
        "lw\ta0,0(a1)",
        "status 400004",
        "cycles of SYSCLK since power-on",
        "the chip was reset",
        "reset bfc00000",
    ] {
        assert!(
            format!("{text}{errors}").contains(wanted),
            "{wanted} is not in:\n{text}\n{errors}"
        );
    }
}
