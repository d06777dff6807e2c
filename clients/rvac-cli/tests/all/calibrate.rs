//! `rvac calibrate` without a robot.

use std::ffi::OsStr;

use crate::folder::Folder;
use crate::program::rvac;

#[test]
fn a_value_that_there_is_not_is_a_failure_with_the_names_that_there_are() {
    let output = rvac(
        [
            "calibrate",
            "no-such-value",
            "--file",
            "/nonexistent/calibration.toml",
        ],
        b"",
    );
    assert!(!output.status.success(), "{output:?}");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        told.contains("there is no value \"no-such-value\"; known: "),
        "{told}"
    );
}

/// There is no robot and there are no lines: what is wrong with the file is said before either is asked for.
#[test]
fn values_for_the_flash_are_judged_before_the_robot_is_touched() {
    let folder = Folder::new();
    let wiring = folder.join("wiring.toml");
    let text = format!(
        "robot = \"sr8730\"\nserial = \"/nonexistent/serial\"\nfolder = {:?}\n",
        folder.join("flash")
    );
    std::fs::write(&wiring, text).expect("writable");
    let file = folder.join("mine.toml");
    for (text, wanted) in [
        (
            "robot = \"sr8730\"\n[values]\nwheel-track = 5\n",
            "wheel-track is 5 um, but can only lie in 100000 to 500000",
        ),
        ("robot = \"sr8730\"\n[values]\n", "holds no value: measure with"),
        (
            "robot = \"relax\"\n[values]\n",
            "of a robot \"relax\", not \"sr8730\"",
        ),
        (
            "robot = \"sr8730\"\n[values]\nwheel-track = 230000\n",
            "the wiring has no [icsp]",
        ),
    ] {
        std::fs::write(&file, text).expect("writable");
        let arguments = ["flash", "calibration"].map(OsStr::new);
        let rest = [file.as_os_str(), OsStr::new("--wiring"), wiring.as_os_str()];
        let output = rvac(arguments.into_iter().chain(rest), b"");
        assert!(!output.status.success(), "{text}");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(told.contains(wanted), "{text}: {told}");
    }
    assert!(!folder.join("flash").exists());
}
