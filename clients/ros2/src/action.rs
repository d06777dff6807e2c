//! Serves the action of [`crate::docking`]: one goal at a time.

use std::time::Duration;

use ros2_client::action::{ExecutingGoalHandle, GoalEndStatus};
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, interval, timeout};

use crate::docking::{Course, DockFeedback, DockGoal, DockResult, DockView, Docking};
use crate::node::DockServer;

/// Between two messages of how it goes.
const FEEDBACK_EVERY: Duration = Duration::from_millis(500);
/// A client that does not ask how its goal ended by then does not want to know.
const RESULT_KEPT: Duration = Duration::from_secs(60);

/// What the daemon is to be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DockWish {
    Dock,
    /// The goal was cancelled.
    GiveUp,
}

/// Works until the node ends.
pub(crate) async fn serve(
    server: &DockServer,
    mut seen: watch::Receiver<DockView>,
    wishes: mpsc::Sender<DockWish>,
) {
    loop {
        match serve_one(server, &mut seen, &wishes).await {
            Ok(()) => {}
            Err(text) => tracing::warn!("dock_robot: {text}"),
        }
    }
}

/// Takes a goal and brings it to its end.
async fn serve_one(
    server: &DockServer,
    seen: &mut watch::Receiver<DockView>,
    wishes: &mpsc::Sender<DockWish>,
) -> Result<(), String> {
    let new = server.receive_new_goal().await.map_err(text)?;
    tracing::info!("called: dock_robot");
    let accepted = server.accept_goal(new).await.map_err(text)?;
    let goal = server.start_executing_goal(accepted).await.map_err(text)?;
    wishes.send(DockWish::Dock).await.map_err(text)?;
    let (end, result) = follow(server, goal.clone(), seen, wishes).await;
    let told = timeout(RESULT_KEPT, server.send_result_response(goal, end, result)).await;
    // Nobody asked, which is not our fault.
    told.unwrap_or(Ok(())).map_err(text)
}

async fn follow(
    server: &DockServer,
    goal: ExecutingGoalHandle<DockGoal>,
    seen: &mut watch::Receiver<DockView>,
    wishes: &mpsc::Sender<DockWish>,
) -> (GoalEndStatus, DockResult) {
    let asked = Instant::now();
    let mut docking = Docking::default();
    let mut ticks = interval(FEEDBACK_EVERY);
    // The first comes at once, before the daemon can have heard of it.
    ticks.tick().await;
    loop {
        tokio::select! {
            _ = ticks.tick() => {}
            cancel = server.receive_cancel_request() => {
                if let Ok(cancel) = cancel
                    && cancel.contains_goal(&goal.goal_id())
                {
                    // Whoever cancels must not hear of it before the robot stops.
                    wishes.send(DockWish::GiveUp).await.ok();
                    let mine = std::iter::once(goal.goal_id());
                    server.respond_to_cancel_requests(&cancel, mine).await.ok();
                    let result = DockResult::from(&Course::Underway { is_driving: false });
                    return (GoalEndStatus::Canceled, result);
                }
                continue;
            }
        }
        let course = docking.look(&seen.borrow_and_update(), asked.elapsed());
        match course {
            Course::Underway { is_driving } => {
                let feedback = DockFeedback::of(is_driving, asked.elapsed());
                // A client that is slow misses some.
                server.publish_feedback(goal.clone(), feedback).await.ok();
            }
            Course::Docked => return (GoalEndStatus::Succeeded, DockResult::from(&course)),
            Course::Failed { .. } => return (GoalEndStatus::Aborted, DockResult::from(&course)),
        }
    }
}

fn text(error: impl std::fmt::Debug) -> String {
    format!("{error:?}")
}
