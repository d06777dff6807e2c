//! A link that is not there, for one reason and then for another. Waits are for events.

use std::fs;
use std::time::Duration;

use robot_link::LinkAddress;
use tokio::sync::{mpsc, watch};
use vthal_core::LineHolder;
use vthal_core::device::Opening;

use super::{LineOrders, RobotLine, serve};
use crate::event::{Event, LinkEvent};

/// Longer than several attempts to open it.
const SAME_CAUSE: Duration = Duration::from_millis(700);
const PATIENCE: Duration = Duration::from_secs(20);

#[tokio::test]
async fn a_cause_is_told_once_and_a_cause_that_changes_is_told() {
    let root = std::env::temp_dir().join(format!("rvac-link-{}", std::process::id()));
    fs::create_dir_all(&root).unwrap();
    let path = root.join("tty");
    let robot = RobotLine {
        address: LinkAddress::Usb(path.clone()),
        rates_baud: vec![115_200],
        opening: Opening {
            rates_baud: &[115_200],
            answer_within_ms: 1_000,
            wake_pulse_ms: 0,
            settle_ms: 0,
        },
    };
    let (events, mut told) = mpsc::channel(16);
    let (_orders, to_robot) = mpsc::channel(16);
    let (_holder, holder) = watch::channel(LineHolder::Daemon);
    let served = serve(robot, events, LineOrders { to_robot, holder });
    let seen = async {
        let mut next = async |patience| match tokio::time::timeout(patience, told.recv()).await {
            Ok(Some(Event::Link(LinkEvent::Absent(error)))) => Some(error.to_string()),
            Ok(other) => panic!("{other:?}"),
            Err(_) => None,
        };
        let first = next(PATIENCE).await.expect("it is not there");
        assert!(first.contains("No such file"), "{first}");
        assert_eq!(next(SAME_CAUSE).await, None, "told already");
        fs::write(&path, "no terminal").unwrap();
        let second = next(PATIENCE).await.expect("it is something else");
        assert!(!second.contains("No such file"), "{second}");
    };
    tokio::select! {
        () = served => panic!("it serves for ever"),
        () = seen => {}
    }
    fs::remove_dir_all(&root).unwrap();
}
