//! `rvac calibrate` without a robot.

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
