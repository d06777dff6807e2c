//! When a gamepad should rumble because of the bumper.

use rvac_api::Status;

/// Name of the inhibit of a pressed bumper.
const BUMPER: &str = "bumper";

/// Notices that the bumper goes down. A bumper that is pressed at the first status is no bump.
#[derive(Clone, Copy, Debug, Default)]
pub struct BumpWatch {
    pressed: Option<bool>,
}

impl BumpWatch {
    /// Looks at what the robot says now: whether the bumper has just gone down.
    pub fn look(&mut self, status: &Status) -> bool {
        let pressed = status.inhibits.iter().any(|inhibit| inhibit == BUMPER);
        self.pressed.replace(pressed) == Some(false) && pressed
    }
}

#[cfg(test)]
mod tests {
    use super::BumpWatch;
    use rvac_api::Status;

    #[test]
    fn a_bump_is_felt_once_however_long_it_lasts() {
        let mut watch = BumpWatch::default();
        let mut felt = |inhibits: &[&str]| {
            watch.look(&Status {
                inhibits: inhibits.iter().map(|&name| name.to_owned()).collect(),
                ..Status::default()
            })
        };
        assert!(!felt(&["bumper"]), "it was pressed before anybody looked");
        assert!(!felt(&["docked"]));
        assert!(felt(&["docked", "bumper"]));
        assert!(!felt(&["bumper"]));
        assert!(!felt(&[]));
        assert!(!felt(&["cliff"]), "nothing was touched");
        assert!(felt(&["bumper"]));
    }
}
