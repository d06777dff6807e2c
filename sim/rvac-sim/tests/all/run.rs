//! The batch commands as processes.

use crate::echo;
use crate::folder::Folder;
use std::borrow::Cow;
use std::process::{Command, Output};

use serde_json::Value;

fn rvac_sim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rvac-sim"))
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .args(arguments)
        .output()
        .unwrap()
}

fn report(seed: &str) -> Value {
    let home = "homes/two-room-flat.toml";
    let output = rvac_sim(&["run", "--home", home, "--seed", seed, "--minutes", "2", "--json"]);
    assert!(output.status.success(), "{output:?}");
    parsed(&output)
}

fn parsed(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

fn printed(output: &Output) -> Cow<'_, str> {
    String::from_utf8_lossy(&output.stderr)
}

#[test]
fn it_tells_what_the_robot_decided_and_why() {
    let words = [
        "run",
        "--home",
        "homes/two-room-flat.toml",
        "--minutes",
        "1",
        "--json",
    ];
    let silent = rvac_sim(&words);
    let explained = rvac_sim(&[words.as_slice(), &["--explain"]].concat());
    let starts = "brain    state-cleaning (command)";
    assert!(printed(&explained).contains(starts), "{}", printed(&explained));
    assert!(!printed(&silent).contains(starts));
    let figures = |output| {
        let mut figures = parsed(output);
        figures["wall_seconds"].take();
        figures
    };
    assert_eq!(figures(&silent), figures(&explained));
}

/// Keys of a report.
const KEYS: [&str; 63] = [
    "home",
    "free_area_m2",
    "reachable_area_m2",
    "covered",
    "t0_s",
    "path_m",
    "bumps",
    "stuck",
    "foot_contacts",
    "foot_pushed_max_ms",
    "monitor_violations",
    "pose_rmse_m",
    "t80_over_t0",
    "t90_over_t0",
    "t95_over_t0",
    "share_at_t0",
    "share_at_1_8_t0",
    "share_told",
    "share_told_low",
    "told_low_over_true",
    "job_over_t0",
    "away_s",
    "charging_s",
    "turn_deg_per_m2",
    "bumps_per_m2",
    "pose_rmse_10_min_m",
    "pose_rmse_30_min_m",
    "pose_rmse_60_min_m",
    "pose_rmse_120_min_m",
    "pose_rmse_aligned_m",
    "pose_error_max_m",
    "pose_error_max_aligned_m",
    "heading_rmse_deg",
    "lost_seconds",
    "lost_times",
    "lost_stretches",
    "lost_unnoticed_s",
    "lost_unnoticed_aligned_s",
    "lost_false_alarm_s",
    "map_iou",
    "map_iou_aligned",
    "carpet_recall",
    "carpet_precision",
    "wall_error_m",
    "wall_error_aligned_m",
    "estimate_error",
    "time_spent",
    "field",
    "map_obstacles",
    "nees_heading",
    "nees_place",
    "nees_place_aligned",
    "nees_place_median_aligned",
    "pose_error_median_aligned_m",
    "pose_error_median_m",
    "pose_error_p90_aligned_m",
    "pose_error_p90_m",
    "sigma_median_m",
    "told_minus_true",
    "docked",
    "state",
    "sim_seconds",
    "wall_seconds",
];

#[test]
fn a_report_has_all_keys_and_repeats_itself() {
    let mut first = report("7");
    let mut second = report("7");
    let keys: Vec<_> = first.as_object().unwrap().keys().cloned().collect();
    let mut wanted = KEYS;
    wanted.sort_unstable();
    assert_eq!(keys, wanted);
    assert_eq!(first["sim_seconds"], 120.0);
    assert!(first["path_m"].as_f64().unwrap() > 5.0, "it moves: {first}");
    assert!(first["covered"].as_f64().unwrap() > 0.05, "it sweeps: {first}");
    for report in [&mut first, &mut second] {
        report["wall_seconds"] = Value::Null;
    }
    assert_eq!(first, second);
    assert_ne!(first["path_m"], report("8")["path_m"]);
}

#[test]
fn what_the_host_took_of_the_processor_is_reported_on_demand() {
    let home = "homes/two-room-flat.toml";
    let output = rvac_sim(&["run", "--home", home, "--minutes", "1", "--host-cost", "--json"]);
    let report = parsed(&output);
    let processor_s = report["host_cost"]["processor_s"].as_f64();
    assert!(processor_s.is_some_and(|seconds| seconds > 0.0), "{report}");
}

#[test]
fn an_image_that_is_no_robot_is_reported() {
    let folder = Folder::new("echo");
    let image = folder.join("echo.hex");
    std::fs::write(&image, echo::image()).unwrap();
    let home = "homes/two-room-flat.toml";
    let image_name = image.to_str().unwrap();
    let output = rvac_sim(&["run", "--home", home, "--json", "--firmware", image_name]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("did not answer within 5 s"), "{text}");
    assert_eq!(output.stdout, b"");
}

#[test]
fn kept_runs_become_one_page_without_foreign_parts() {
    let files = Folder::new("page");
    let folder = files.join("runs");
    let name = folder.to_str().unwrap();
    let empty = rvac_sim(&["report", name]);
    assert_eq!(empty.status.code(), Some(2), "there is no such folder yet");
    for seed in ["1", "2"] {
        let run = [
            "run",
            "--home",
            "generated:14",
            "--minutes",
            "1",
            "--seed",
            seed,
            "--keep",
            name,
        ];
        assert!(rvac_sim(&run).status.success());
    }
    let output = rvac_sim(&["report", name]);
    assert!(output.status.success(), "{output:?}");
    let page = std::fs::read_to_string(folder.join("index.html")).unwrap();
    assert_eq!(page.matches("<h2>Generated 14</h2>").count(), 1);
    assert_eq!(
        page.matches("<figure>").count(),
        4,
        "the home and the map of each run"
    );
    assert!(page.contains("seed 1") && page.contains("seed 2"));
    for foreign in ["<script", "http:", "https:", "src=", "NaN", "inf"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
}

#[test]
#[ignore = "campaign: whole runs for a page; cargo xtask test --all"]
fn a_page_shows_bounce_beside_a_run_that_came_without() {
    let files = Folder::new("bounce");
    let folder = files.join("runs");
    let name = folder.to_str().unwrap();
    let home = "homes/furnished-room.toml";
    let run = [
        "run",
        "--home",
        home,
        "--minutes",
        "1",
        "--strategy",
        "systematic",
    ];
    assert!(
        rvac_sim(&[run.as_slice(), &["--seed", "3", "--keep", name]].concat())
            .status
            .success()
    );
    let page = |arguments: &[&str]| {
        let output = rvac_sim(&[&["report", name], arguments].concat());
        assert!(output.status.success(), "{output:?}");
        std::fs::read_to_string(folder.join("index.html")).unwrap()
    };
    let bounce = "bounce, nominal noise, seed 3";
    assert!(!page(&[]).contains(bounce));
    let both = page(&["--with-bounce"]);
    assert!(both.contains(bounce) && both.contains("systematic, nominal noise, seed 3"));
    assert_eq!(page(&["--with-bounce"]), both, "it is there already");
    let kept = std::fs::read_dir(&folder).unwrap().count();
    assert_eq!(kept, 3, "two runs and the page");
}

#[test]
fn trials_are_counted() {
    let output = rvac_sim(&["faults", "--seeds", "0..3", "--minutes", "1", "--json"]);
    assert!(output.status.success(), "{output:?}");
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["trials"], 3);
    assert_eq!(summary["violations"], 0);
    assert!(summary["faults"].as_u64().unwrap() > 10);
    assert_eq!(summary["sim_seconds"], 180.0);
}

/// The report of a run of the robot with next to no sensors.
fn relax(arguments: &[&str]) -> Value {
    let flat = [
        "run",
        "--robot",
        "relax",
        "--home",
        "homes/two-room-flat.toml",
        "--json",
    ];
    let output = rvac_sim(&[&flat, arguments].concat());
    assert!(output.status.success(), "{output:?}");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["monitor_violations"], 0);
    report
}

#[test]
fn a_relax_with_a_gyro_on_its_linux_board_keeps_its_place_in_a_known_home() {
    let known = ["--known-map", "--strategy", "systematic", "--minutes", "12"];
    let report = relax(&[&known[..], &["--board-gyro"]].concat());
    let error_m = report["pose_rmse_m"].as_f64().unwrap();
    assert!(error_m < 0.15, "{error_m} m");
    assert!(report["covered"].as_f64().unwrap() > 0.4, "{report}");
    let without = relax(&known);
    assert_eq!(
        without["state"], "idle",
        "it ends the job when nothing tells its heading"
    );
    assert!(without["covered"].as_f64().unwrap() < 0.2, "{without}");
}

#[test]
fn a_relax_without_gyro_keeps_no_map_and_with_beacons_it_knows_its_place() {
    let alone = relax(&["--minutes", "15"]);
    assert_eq!(alone["map_iou"], Value::Null);
    assert!(alone["covered"].as_f64().unwrap() > 0.5, "it cleans all the same");
    let heard = relax(&["--minutes", "15", "--beacons", "4"]);
    let rmse_m = |report: &Value| report["pose_rmse_m"].as_f64().unwrap();
    assert!(
        rmse_m(&heard) < 0.5 * rmse_m(&alone),
        "{} m, {} m",
        rmse_m(&heard),
        rmse_m(&alone)
    );
}

#[test]
fn bad_input_names_itself() {
    let flat = "homes/two-room-flat.toml";
    let folder = Folder::new("cut");
    let cut = folder.join("cut.elf");
    std::fs::write(&cut, b"\x7fELF\x01\x01\x01\0").unwrap();
    let cut = cut.to_str().unwrap();
    let cases: [(&[&str], &str); 10] = [
        (&["run", "--home", "nowhere.toml"], "nowhere.toml"),
        (&["run", "--home", "Cargo.toml"], "Cargo.toml"),
        (&["run", "--home", "generated:0"], "generated:7"),
        (&["run", "--home", flat, "--strategy", "magic"], "magic"),
        (&["run", "--home", flat, "--minutes", "-3"], "-3"),
        (&["faults", "--seeds", "9..3"], "9..3"),
        (&["run", "--home", flat, "--firmware", "no.elf"], "no.elf"),
        (&["run", "--home", flat, "--firmware", "Cargo.toml"], "no ELF"),
        (&["run", "--home", flat, "--firmware", cut], "ends at byte 8"),
        (&["faults", "--firmware", "no.elf"], "cargo xtask firmware"),
    ];
    for (arguments, named) in cases {
        let output = rvac_sim(arguments);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(named), "{text}");
        assert_eq!(output.stdout, b"");
    }
}
