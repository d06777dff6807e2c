//! What goes to the thread that writes and reads files, and what comes back from it.

use rvac_api::{Failure, RunRecord, Topic, Update};
use vthal_core::{
    ArchiveOrder, ClientId, EditedMap, FloorOrder, HealthOrder, Input, LearntOrder, MapOrder, MixOrder,
    ScheduleOrder,
};

use super::{Daemon, refusal};
use crate::archive_desk::{ArchiveAnswer, ArchiveOutcome};
use crate::checkpoint_thread::{FloorAnswer, MapAnswer, MapOutcome, MixAnswer, MixOutcome};
use crate::client;
use crate::outbox::Class;
use crate::run_thread::RunAnswer;

/// Who has asked for something, and the number of the request.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asker {
    pub(super) client: ClientId,
    pub(super) id: Option<u32>,
}

impl Daemon {
    /// Sends a client the result of its order, and the core what it needs.
    pub(super) fn take_map_answer(&mut self, MapAnswer { client, id, outcome }: MapAnswer) {
        let answer = match outcome {
            MapOutcome::Listed(floor, maps) => Some(Update::Maps {
                floor: Some(floor),
                maps,
            }),
            MapOutcome::Kept => None,
            MapOutcome::Restored(floor, number, home) => {
                self.handle(Input::MapRestored {
                    floor,
                    number,
                    home: *home,
                });
                None
            }
            MapOutcome::Refused(reason, text) => {
                self.refuse(Asker { client, id }, reason, text);
                return;
            }
        };
        self.tell_done(Asker { client, id }, answer);
    }

    pub(super) fn take_floor_answer(&mut self, answer: FloorAnswer) {
        let FloorAnswer {
            client,
            id,
            task,
            outcome,
        } = answer;
        match outcome {
            Ok((floors, made)) => {
                self.handle(Input::FloorsKept { task, floors, made });
                self.tell_done(Asker { client, id }, None);
            }
            Err(error) => self.refuse(Asker { client, id }, error.name(), error.to_string()),
        }
    }

    pub(super) fn take_archive_answer(&mut self, ArchiveAnswer { client, id, outcome }: ArchiveAnswer) {
        let answer = match outcome {
            Ok(ArchiveOutcome::Piece(piece)) => Some(*piece),
            Ok(ArchiveOutcome::Waits) => None,
            Ok(ArchiveOutcome::TakenIn(floors, taken)) => {
                self.handle(Input::FloorsTakenIn { floors, taken });
                None
            }
            Err(error) => {
                self.refuse(Asker { client, id }, error.name(), error.to_string());
                return;
            }
        };
        self.tell_done(Asker { client, id }, answer);
    }

    pub(super) fn take_mix_answer(&mut self, MixAnswer { client, id, outcome }: MixAnswer) {
        let answer = match outcome {
            Ok(MixOutcome::Listed(mixes)) => Some(Update::Mixes { mixes }),
            Ok(MixOutcome::Changed(mixes)) => {
                // Whoever drives or edits elsewhere must not work with a stale copy.
                let update = Update::Mixes { mixes };
                let followers: Vec<ClientId> = self.core.followers(Topic::Inputs).collect();
                for client in followers {
                    self.tell(client, &update);
                }
                None
            }
            Err(error) => {
                self.refuse(Asker { client, id }, error.name(), error.to_string());
                return;
            }
        };
        self.tell_done(Asker { client, id }, answer);
    }

    pub(super) fn take_run_answer(&mut self, RunAnswer { client, id, outcome }: RunAnswer) {
        match outcome {
            Ok(update) => self.tell_done(Asker { client, id }, Some(*update)),
            Err(error) => self.refuse(Asker { client, id }, error.name(), error.to_string()),
        }
    }

    /// What came of an order, if it has an answer of its own, and that it is done, if whoever asked numbered it.
    pub(super) fn tell_done(&mut self, asker: Asker, answer: Option<Update>) {
        for update in answer.into_iter().chain(asker.id.map(|id| Update::Done { id })) {
            self.tell(asker.client, &update);
        }
    }

    pub(super) fn tell(&mut self, client: ClientId, update: &Update) {
        if let Some(client) = self.clients.get_mut(&client) {
            client.push(Class::Lossless, client::encode(update));
        }
    }

    /// Not while outputs of the core are carried out, which this makes more of.
    pub(super) fn refuse(&mut self, Asker { client, id }: Asker, reason: &str, text: String) {
        let reason = reason.to_owned();
        let failure = Failure { id, reason, text };
        self.handle(Input::Refused { client, failure });
    }

    /// A doubt is of the map that is the newest before what the run has left.
    pub(super) fn keep_maps(&mut self) {
        if let Some(floor) = self.outputs.doubted_floor.take() {
            self.wiring.checkpoints.send_doubt(floor);
        }
        if let Some(home) = self.outputs.home.take() {
            self.wiring.checkpoints.send_home(home);
        }
    }

    pub(super) fn order_map(&mut self, order: MapOrder) {
        if !self.wiring.checkpoints.order(order) {
            let (MapOrder::List { client, id, .. } | MapOrder::Restore { client, id, .. }) = order;
            self.tell_busy(client, id);
        }
    }

    pub(super) fn order_floor(&mut self, order: FloorOrder) {
        let (client, id) = (order.client, order.id);
        if !self.wiring.checkpoints.order_floor(order) {
            self.tell_busy(client, id);
        }
    }

    pub(super) fn order_archive(&mut self, order: ArchiveOrder) {
        let (client, id) = (order.client, order.id);
        if !self.wiring.checkpoints.order_archive(order) {
            self.tell_busy(client, id);
        }
    }

    pub(super) fn order_mix(&mut self, order: MixOrder) {
        let (client, id) = (order.client, order.id);
        if !self.wiring.checkpoints.order_mix(order) {
            self.tell_busy(client, id);
        }
    }

    pub(super) fn keep_schedules(&mut self, order: ScheduleOrder) {
        let number = order.number;
        if !self.wiring.checkpoints.keep_schedules(order) {
            let text = "The disk is too slow to take schedules now; they are as they were before.".to_owned();
            self.handle(Input::SchedulesKept {
                number,
                result: Err(text),
            });
        }
    }

    pub(super) fn keep_health(&mut self, order: HealthOrder) {
        let number = order.number;
        if !self.wiring.checkpoints.keep_health(order) {
            let text =
                "The disk is too slow to take the loads of the motors now; they are as they were before."
                    .to_owned();
            self.handle(Input::HealthKept {
                number,
                result: Err(text),
            });
        }
    }

    pub(super) fn keep_learnt(&mut self, order: LearntOrder) {
        let number = order.number;
        if !self.wiring.checkpoints.keep_learnt(order) {
            let text =
                "The disk is too slow to take what the robot has learnt now; the next run says it again.";
            self.handle(Input::LearntKept {
                number,
                result: Err(text.to_owned()),
            });
        }
    }

    pub(super) fn keep_run(&mut self, record: Box<RunRecord>) {
        let number = record.run.number;
        if !self.wiring.checkpoints.keep_run(record) {
            let text = "the disk is too slow to take the record of a run now; it is tried again".to_owned();
            self.handle(Input::RunKept {
                number,
                result: Err(text),
            });
        }
    }

    pub(super) fn tell_busy(&mut self, client: ClientId, id: Option<u32>) {
        let text = "The disk is too slow to answer now; ask again.".to_owned();
        self.tell(client, &refusal(id, "disk-busy", text));
    }

    pub(super) fn keep_edit(&mut self, edit: EditedMap) {
        let (client, id) = (edit.client, edit.id);
        if !self.wiring.checkpoints.edit(edit) {
            let text =
                "The robot knows it now, but the disk is too slow: it is kept with the next change or run.";
            self.tell(client, &refusal(id, "disk-busy", text.to_owned()));
        }
    }
}
