//! What was seen, for people and for programs.

use std::time::Duration;

/// What was seen of one kind.
#[derive(Debug, Default)]
pub(crate) struct Figures {
    pub(crate) kills: u32,
    pub(crate) acknowledged: u32,
    /// Kills before the acknowledgement, and how many of the changes that they cut off were there afterwards.
    pub(crate) cut_off: u32,
    pub(crate) cut_off_there: u32,
    pub(crate) corrupt: u32,
    pub(crate) lost: u32,
    pub(crate) ready_within: Duration,
}

impl Figures {
    /// Nothing was damaged, and nothing acknowledged was lost.
    pub(crate) fn is_good(&self) -> bool {
        self.corrupt == 0 && self.lost == 0
    }

    /// One line for people.
    pub(crate) fn sentence(&self, name: &str) -> String {
        format!(
            "{name}: {} kills, {} before an acknowledgement ({} of these changes were there, whole); {} changes acknowledged, {} lost; {} starts told of damage; ready within {:.2} s",
            self.kills,
            self.cut_off,
            self.cut_off_there,
            self.acknowledged,
            self.lost,
            self.corrupt,
            self.ready_within.as_secs_f64(),
        )
    }
}

/// All of it for programs.
pub(crate) fn json(all: &[(&str, Figures)]) -> serde_json::Value {
    let sum = |figure: fn(&Figures) -> u32| all.iter().map(|(_, figures)| figure(figures)).sum::<u32>();
    let kinds = all.iter().map(|(name, figures)| {
        serde_json::json!({
            "kind": name,
            "kills": figures.kills,
            "cut_off": figures.cut_off,
            "cut_off_there": figures.cut_off_there,
            "acknowledged": figures.acknowledged,
            "lost": figures.lost,
            "corrupt": figures.corrupt,
            "ready_within_s": figures.ready_within.as_secs_f64(),
        })
    });
    serde_json::json!({
        "kills": sum(|figures| figures.kills),
        "acknowledged": sum(|figures| figures.acknowledged),
        "acknowledged_and_lost": sum(|figures| figures.lost),
        "corrupt": sum(|figures| figures.corrupt),
        "kinds": kinds.collect::<Vec<_>>(),
    })
}
