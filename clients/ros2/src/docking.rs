//! Docking as the action of Nav2, `nav2_msgs/action/DockRobot`: the robot has one dock and finds the way itself, so of a goal only that it came
//! counts. What the daemon tells decides how it goes and how it ended.

use std::time::Duration;

use rvac_api::{Activity, Status};
use serde::{Deserialize, Serialize};

use crate::messages::PoseStamped;

/// The daemon starts to dock, or refuses, within this time.
const BEGINS_WITHIN: Duration = Duration::from_secs(10);

/// A goal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct DockGoal {
    use_dock_id: bool,
    dock_id: String,
    dock_pose: PoseStamped,
    dock_type: String,
    max_staging_time: f32,
    navigate_to_staging_pose: bool,
}
impl ros2_client::Message for DockGoal {}

/// How it ended.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DockResult {
    pub(crate) success: bool,
    pub(crate) error_code: u16,
    num_retries: u16,
    pub(crate) error_msg: String,
}
impl ros2_client::Message for DockResult {}

/// How it goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct DockFeedback {
    state: u16,
    docking_time: Elapsed,
    num_retries: u16,
}
impl ros2_client::Message for DockFeedback {}

/// builtin_interfaces/Duration
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Elapsed {
    sec: i32,
    nanosec: u32,
}

impl DockFeedback {
    /// `CONTROLLING` while the robot drives, before that `NONE`. The daemon tells no retries.
    pub(crate) fn of(is_driving: bool, elapsed: Duration) -> Self {
        const CONTROLLING: u16 = 3;
        Self {
            state: if is_driving { CONTROLLING } else { 0 },
            docking_time: Elapsed {
                sec: i32::try_from(elapsed.as_secs()).unwrap_or(i32::MAX),
                nanosec: elapsed.subsec_nanos(),
            },
            num_retries: 0,
        }
    }
}

/// Error codes of the action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DockError {
    FailedToDetectDock = 904,
    FailedToControl = 905,
    FailedToCharge = 906,
    Unknown = 999,
}

impl DockError {
    /// The code for a reason of the daemon.
    fn of(reason: &str) -> Self {
        match reason {
            "no-beam" | "dock-not-found" | "dock-unknown" | "which-dock" => Self::FailedToDetectDock,
            "dock-no-contact" | "dock-contact-lost" | "dock-power-lost" => Self::FailedToCharge,
            _ => Self::FailedToControl,
        }
    }
}

/// What is known of the request and the robot.
#[derive(Clone, Debug, Default)]
pub(crate) struct DockView {
    /// What the robot does; none while the daemon is away.
    pub(crate) status: Option<Status>,
    /// Reason and text with which the daemon has refused.
    pub(crate) refusal: Option<(String, String)>,
}

/// Where a goal is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Course {
    Underway { is_driving: bool },
    Docked,
    Failed { error: DockError, text: String },
}

/// Follows one goal.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Docking {
    has_driven: bool,
}

impl Docking {
    /// Looks at the robot, so long after it was asked.
    pub(crate) fn look(&mut self, view: &DockView, asked_ago: Duration) -> Course {
        let Some(status) = &view.status else {
            return failed(DockError::Unknown, "the robot's daemon is away");
        };
        let activity = Activity::from_name(&status.state);
        if activity == Some(Activity::Docked) {
            return Course::Docked;
        }
        if let Some((reason, text)) = &view.refusal {
            return failed(DockError::of(reason), &format!("{reason}: {text}"));
        }
        if activity == Some(Activity::Docking) {
            self.has_driven = true;
            return Course::Underway { is_driving: true };
        }
        if self.has_driven {
            let reason = &status.reason;
            return failed(DockError::of(reason), reason);
        }
        if asked_ago >= BEGINS_WITHIN {
            return failed(DockError::Unknown, "it did not begin to dock");
        }
        Course::Underway { is_driving: false }
    }
}

fn failed(error: DockError, text: &str) -> Course {
    Course::Failed {
        error,
        text: text.to_owned(),
    }
}

impl From<&Course> for DockResult {
    fn from(course: &Course) -> Self {
        match course {
            Course::Failed { error, text } => Self {
                error_code: *error as u16,
                error_msg: text.clone(),
                ..Self::default()
            },
            Course::Docked => Self {
                success: true,
                ..Self::default()
            },
            Course::Underway { .. } => Self {
                error_msg: "given up".to_owned(),
                ..Self::default()
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use rvac_api::Status;

    use super::{Course, DockError, DockResult, DockView, Docking};

    fn view(state: &str, reason: &str) -> DockView {
        DockView {
            status: Some(Status {
                state: state.to_owned(),
                reason: reason.to_owned(),
                ..Status::default()
            }),
            refusal: None,
        }
    }

    fn courses(views: &[DockView]) -> Vec<DockResult> {
        let mut docking = Docking::default();
        let mut results = Vec::new();
        for view in views {
            let course = docking.look(view, Duration::from_secs(1));
            if !matches!(course, Course::Underway { .. }) {
                results.push(DockResult::from(&course));
            }
        }
        results
    }

    #[test]
    fn a_robot_that_drives_home_succeeds() {
        let ended = courses(&[
            view("idle", "command"),
            view("docking", "command"),
            view("docked", "docked"),
        ]);
        assert_eq!(ended.len(), 1);
        assert!(
            ended
                .iter()
                .all(|result| result.success && result.error_code == 0)
        );
    }

    #[test]
    fn each_way_of_failing_has_its_code() {
        for (reason, code) in [
            ("no-beam", 904),
            ("dock-not-found", 904),
            ("dock-no-contact", 906),
            ("dock-power-lost", 906),
            ("wheel-drop", 905),
        ] {
            let ended = courses(&[view("docking", "command"), view("stuck", reason)]);
            assert_eq!(
                ended.first().map(|result| result.error_code),
                Some(code),
                "{reason}"
            );
            assert!(
                ended
                    .iter()
                    .all(|result| !result.success && result.error_msg == reason)
            );
        }
    }

    #[test]
    fn a_refusal_ends_it_with_its_name_and_silence_too() {
        let refused = DockView {
            refusal: Some((
                "dock-unknown".to_owned(),
                "Nobody knows where the dock is.".to_owned(),
            )),
            ..view("idle", "command")
        };
        let ended = courses(&[refused]);
        assert_eq!(ended.first().map(|result| result.error_code), Some(904));
        let late = Docking::default().look(&view("idle", "command"), Duration::from_secs(11));
        assert!(matches!(
            late,
            Course::Failed {
                error: DockError::Unknown,
                ..
            }
        ));
        let away = Docking::default().look(&DockView::default(), Duration::ZERO);
        assert!(matches!(
            away,
            Course::Failed {
                error: DockError::Unknown,
                ..
            }
        ));
    }
}
