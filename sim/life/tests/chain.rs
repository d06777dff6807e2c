//! Two runs of a life in a small room.

use std::path::PathBuf;
use std::sync::Arc;

use home::{Home, Noise, RobotModel};
use life::{Chain, ChainSettings, LifeRun, LifeTable, LivedHome, Wear};

const PLAN: &str = r#"
    format = "librervac-home"
    version = 1
    name = "Small room"
    [[room]]
    polygon = [[0, 0], [2.4, 0], [2.4, 2.0], [0, 2.0]]
    [dock]
    position = [1.2, 0.0]
    heading-deg = 90
"#;

/// A state folder of one chain.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("life-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("can be made");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

fn lived(name: &str, seed: u64) -> Vec<LifeRun> {
    let model = RobotModel::by_name("sr8730").expect("comes with the project");
    let home = Home::from_floorplan("room", PLAN, &model).expect("is a home");
    let settings = ChainSettings {
        model,
        noise: Noise::nominal(),
        runs: 2,
        seed,
        wear: Wear::default(),
        new_robots: false,
        timing: false,
    };
    let folder = Folder::new(name);
    let home = LivedHome::Fixed(Arc::new(home));
    let chain = Chain::new(&home, &settings, &folder.0);
    chain.live(|_| {}).expect("it lives")
}

fn json(runs: &[LifeRun]) -> String {
    serde_json::json!({ "runs": runs, "days": LifeTable::of(&[runs.to_vec()]) }).to_string()
}

#[test]
fn a_life_is_the_same_each_time_and_its_runs_differ() {
    let [first, again, other] =
        [("first", 1), ("again", 1), ("other", 2)].map(|(name, seed)| lived(name, seed));
    assert_eq!(json(&first), json(&again));
    assert_ne!(json(&first), json(&other));
    assert_ne!(first[0].report, first[1].report, "each run has its own noise");
    for run in &first {
        assert!(
            run.map_bytes.is_some_and(|bytes| bytes > 100),
            "a map is on the disk"
        );
        assert!(run.report.covered > 0.8, "{:?}", run.report);
        assert_eq!(run.report.monitor_violations, 0);
    }
}
