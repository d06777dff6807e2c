//! A client that asks without end, and one that changes something meanwhile.

use mixer::standard_profile;
use tokio::sync::mpsc::{Receiver, channel};
use vthal_bench::Scratch;
use vthal_core::{ArchiveOrder, ArchiveTask, ClientId, MixOrder, MixTask};

use super::{KeptPaths, MixOutcome, QUESTIONS_MAX, start};
use crate::event::Event;
use crate::kept_store::KeptStore;

/// Far more than there is room for.
const MANY: usize = 100;
const CHANGER: ClientId = ClientId(2);

fn paths_in(folder: &Scratch) -> KeptPaths {
    KeptStore::new(&folder.join("state")).into_paths()
}

fn question(number: usize) -> ArchiveOrder {
    ArchiveOrder {
        client: ClientId(1),
        id: u32::try_from(number).ok(),
        task: ArchiveTask::Export { floor: None, from: 0 },
    }
}

fn change() -> MixOrder {
    MixOrder {
        client: CHANGER,
        id: None,
        task: MixTask::Save {
            profile: standard_profile().to_json(),
            was: None,
        },
    }
}

/// Questions that were answered until the change was.
fn answered_before_the_change(events: &mut Receiver<Event>) -> usize {
    let mut answered = 0;
    loop {
        match events.blocking_recv() {
            Some(Event::Archive(_)) => answered += 1,
            Some(Event::Mixes(answer)) => {
                assert_eq!(answer.client, CHANGER);
                assert!(matches!(answer.outcome, Ok(MixOutcome::Changed(_))), "{answer:?}");
                return answered;
            }
            _ => {}
        }
    }
}

#[test]
fn questions_without_end_leave_room_for_changes() {
    // The answers are not read yet, so that only the first question is carried out.
    let (sender, mut events) = channel(1);
    let folder = Scratch::new().expect("creates");
    let thread = start(paths_in(&folder), sender).expect("starts");
    let taken = (0..MANY)
        .filter(|number| thread.order_archive(question(*number)))
        .count();
    assert!((1..=QUESTIONS_MAX + 1).contains(&taken), "{taken} were taken");
    assert!(!thread.order_archive(question(MANY)),);
    assert!(thread.order_mix(change()), "a change is refused");
    assert!(answered_before_the_change(&mut events) <= taken);
    drop(events);
    thread.finish();
}

#[test]
fn a_question_that_was_answered_makes_room_for_the_next() {
    let (sender, mut events) = channel(1);
    let folder = Scratch::new().expect("creates");
    let thread = start(paths_in(&folder), sender).expect("starts");
    for number in 0..MANY {
        while !thread.order_archive(question(number)) {
            std::thread::yield_now();
        }
        assert!(matches!(events.blocking_recv(), Some(Event::Archive(_))));
    }
    drop(events);
    thread.finish();
}
