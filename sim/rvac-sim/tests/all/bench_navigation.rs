//! The bench of navigation as a process.

use std::process::Command;

use serde_json::Value;

fn bench(arguments: &[&str]) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_bench-navigation"))
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .args(["--homes", "homes/furnished-room.toml", "--json"])
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// What this machine was measured to do differs each time.
const OF_THE_MACHINE: [&str; 6] = [
    "wall_seconds",
    "host_cost",
    "host_step_max_us",
    "host_s_per_hour",
    "times_real_time",
    "peak_memory_mib",
];

fn without_machine(value: &mut Value) {
    match value {
        Value::Object(object) => {
            object.retain(|key, _| !OF_THE_MACHINE.contains(&key.as_str()));
            object.values_mut().for_each(without_machine);
        }
        Value::Array(items) => items.iter_mut().for_each(without_machine),
        _ => {}
    }
}

#[test]
#[ignore = "campaign: whole runs, three times; cargo xtask test --all"]
fn figures_do_not_depend_on_the_number_of_threads() {
    let on_threads = |threads| {
        let modes = ["--modes", "bounce,first-run", "--seeds", "2"];
        let length = ["--work-minutes", "2", "--threads", threads];
        let mut object = bench(&[modes, length].concat());
        assert!(object["peak_memory_mib"].as_f64().unwrap() > 1.0);
        without_machine(&mut object);
        object
    };
    let one = on_threads("1");
    let runs = one["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 4);
    assert!(
        runs.iter().all(|run| run["covered"].as_f64() > Some(0.02)),
        "{one}"
    );
    assert_ne!(runs[2]["covered"], runs[3]["covered"], "seeds differ");
    assert_eq!(one, on_threads("2"));
    assert_eq!(one, on_threads("2"));
}

#[test]
fn each_run_takes_the_map_of_the_one_before() {
    let object = bench(&["--modes", "learnt-map", "--seeds", "1", "--work-minutes", "1"]);
    let iou = |round| object["modes"][format!("learnt-map-{round}")]["map_iou"]["median"].as_f64();
    // The same seed without a map would make the same run.
    assert!(iou(1).is_some() && iou(1) < iou(2) && iou(2) < iou(3), "{object}");
}

#[test]
#[ignore = "campaign: a whole run; cargo xtask test --all"]
fn work_goes_on_after_the_job() {
    let object = bench(&["--modes", "known-map", "--seeds", "1", "--work-minutes", "12"]);
    let run = &object["runs"][0];
    assert!(run["jobs"].as_u64() > Some(1), "{run}");
    assert!(run["job_over_t0"].as_f64() < Some(4.0), "of the first job: {run}");
    assert!(run["pose_rmse_10_min_m"].as_f64().is_some(), "{run}");
    assert!(run["sim_seconds"].as_f64() < Some(13.0 * 60.0), "{run}");
}

#[test]
fn the_end_of_a_run_is_seen() {
    let object = bench(&["--modes", "known-map", "--seeds", "1"]);
    let run = &object["runs"][0];
    assert_eq!(
        (&run["docked"], &run["state"]),
        (&true.into(), &"docked".into()),
        "{run}"
    );
}

#[test]
fn a_robot_without_a_gyro_may_get_one() {
    let length = ["--seeds", "1", "--work-minutes", "2", "--modes", "known-map"];
    let turned = bench(&[length.as_slice(), &["--robot", "relax", "--board-gyro"]].concat());
    let refused = bench(&[length.as_slice(), &["--robot", "relax"]].concat());
    let covered = |object: &Value| object["runs"][0]["covered"].as_f64().unwrap();
    assert!(
        covered(&turned) > 0.1 && covered(&refused) < 0.1,
        "{turned} {refused}"
    );
}
