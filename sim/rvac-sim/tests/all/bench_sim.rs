//! The bench of the simulator as a process.

use std::process::Command;

use serde_json::Value;

/// The bench itself checks that the copies of world and brain behave as the originals, and fails otherwise.
#[test]
#[ignore = "campaign: whole runs; cargo xtask test --all"]
fn the_time_of_each_case_is_reported_by_parts() {
    let output = Command::new(env!("CARGO_BIN_EXE_bench-sim"))
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .args(["--minutes", "2", "--parts", "--json"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let object: Value = serde_json::from_slice(&output.stdout).unwrap();
    let cases = object["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 3);
    for case in cases {
        let seconds = |value: &Value| value.as_f64().unwrap();
        let parts = case["parts"].as_object().unwrap();
        let sum_s: f64 = parts.values().map(seconds).sum();
        assert!((sum_s - seconds(&case["processor_s"])).abs() < 1e-6, "{case}");
        assert!(seconds(&parts["world_s"]) > 0.0, "{case}");
        assert!(seconds(&parts["brain_s"]) > 0.0, "{case}");
        assert!(seconds(&case["sim_seconds"]) >= 120.0, "{case}");
    }
}
