//! The floors on the disk of a daemon that has none.

use vthal_core::{FloorHome, FloorTask, Input, KeptFloor};

/// What its disk keeps of floors.
#[derive(Clone, Debug, Default)]
pub(crate) struct HostFloors {
    floors: Vec<KeptFloor>,
}

impl HostFloors {
    pub(crate) fn of(floors: &[KeptFloor]) -> Self {
        let mut floors = floors.to_vec();
        if floors.is_empty() {
            floors.push(KeptFloor::new(1));
        }
        Self { floors }
    }

    pub(crate) fn keep(&mut self, kept: FloorHome) {
        self.change(kept.floor, |floor| floor.home = Some(kept.home.clone()));
    }

    /// Does what the core orders, and says so.
    pub(crate) fn obey(&mut self, task: FloorTask) -> Input<'static> {
        let mut made = None;
        match &task {
            FloorTask::New(name) => {
                let last = self.floors.iter().map(|floor| floor.number).max().unwrap_or(0);
                made = Some(last + 1);
                self.floors.push(KeptFloor {
                    name: name.clone(),
                    ..KeptFloor::new(last + 1)
                });
            }
            FloorTask::Name(number, name) => self.change(*number, |floor| floor.name.clone_from(name)),
            FloorTask::Remove(number) => self.change(*number, |floor| floor.removed = true),
            FloorTask::Restore(number) => self.change(*number, |floor| floor.removed = false),
        }
        Input::FloorsKept {
            task,
            floors: self.floors.clone(),
            made,
        }
    }

    fn change(&mut self, number: u16, change: impl Fn(&mut KeptFloor)) {
        self.floors
            .iter_mut()
            .filter(|floor| floor.number == number)
            .for_each(change);
    }
}
