//! Calibration by a client: who has the robot for it, and what the shell does.
//!
//! While a robot is calibrated, its bytes go to the procedure and not to this core, for which the robot is disconnected. The
//! procedure arms motors itself, under leases. It ends with its client, with `stop` of anybody, and with the link.

use rvac_api::CalibrationAnswer;

use super::link_loan::LoanFacts;
use crate::ClientId;
use crate::outputs::{CalibrationOrder, CalibrationTask};
use crate::refusal::Refusal;

/// What clients ask of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CalibrationRequest {
    /// What is measured of the robot that is or was attached.
    Show,
    /// Measure these values; none = all that are missing.
    Begin(Vec<String>),
    /// Answer a page.
    Answer(u32, CalibrationAnswer),
    /// The person holds the motors on, or lets go.
    Hold(bool),
    /// Stop and give the robot back.
    End,
}

/// Who calibrates.
#[derive(Debug, Default)]
pub(crate) struct CalibrationDesk {
    client: Option<ClientId>,
}

impl CalibrationDesk {
    /// Begins for a client, or passes on what it says.
    ///
    /// # Errors
    /// The robot cannot be given to it, or somebody else has it.
    pub(crate) fn order(
        &mut self,
        (client, id): (ClientId, Option<u32>),
        request: CalibrationRequest,
        (facts, device): (LoanFacts, Option<&str>),
    ) -> Result<CalibrationOrder, Refusal> {
        let task = match request {
            CalibrationRequest::Show => CalibrationTask::Show(device.map(str::to_owned)),
            CalibrationRequest::Begin(names) => {
                if self.client.is_some() {
                    return Err(refusal(
                        "being-calibrated",
                        "Somebody calibrates the robot. Wait until that is over, or stop it.",
                    ));
                }
                let device = device.filter(|_| facts.is_attached).ok_or("no-robot")?;
                if !facts.stands_still {
                    return Err(refusal("robot-moves", "The robot moves. Stop it first."));
                }
                self.client = Some(client);
                CalibrationTask::Begin(device.to_owned(), names)
            }
            _ if self.client != Some(client) => {
                return Err(refusal(
                    "not-calibrating",
                    "This client does not calibrate the robot. Begin first.",
                ));
            }
            CalibrationRequest::Answer(page, answer) => CalibrationTask::Answer(page, answer),
            CalibrationRequest::Hold(held) => CalibrationTask::Hold(held),
            CalibrationRequest::End => CalibrationTask::End,
        };
        Ok(CalibrationOrder { client, id, task })
    }

    /// Ends it, whoever does it: for `stop`.
    pub(crate) fn end(&self) -> Option<CalibrationOrder> {
        self.client.map(|client| CalibrationOrder {
            client,
            id: None,
            task: CalibrationTask::End,
        })
    }

    /// Ends it if this client does it: its connection is gone.
    pub(crate) fn forget_client(&self, client: ClientId) -> Option<CalibrationOrder> {
        self.end().filter(|order| order.client == client)
    }

    /// The shell says that the procedure has ended.
    pub(crate) fn over(&mut self) {
        self.client = None;
    }
}

fn refusal(reason: &'static str, text: &str) -> Refusal {
    Refusal {
        reason,
        text: text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{CalibrationDesk, CalibrationRequest};
    use crate::ClientId;
    use crate::desk::link_loan::LoanFacts;
    use crate::outputs::CalibrationTask;

    const STANDS: LoanFacts = LoanFacts {
        is_attached: true,
        stands_still: true,
        is_docked: false,
        charge: None,
    };
    const ONE: ClientId = ClientId(1);
    const OTHER: ClientId = ClientId(2);

    fn ask(
        desk: &mut CalibrationDesk,
        client: ClientId,
        request: CalibrationRequest,
        facts: LoanFacts,
    ) -> Result<CalibrationTask, &'static str> {
        desk.order((client, None), request, (facts, Some("sr8730")))
            .map(|order| order.task)
            .map_err(|refusal| refusal.reason)
    }

    #[test]
    fn a_robot_that_moves_or_is_gone_is_not_calibrated() {
        let moves = LoanFacts {
            stands_still: false,
            ..STANDS
        };
        let gone = LoanFacts {
            is_attached: false,
            ..STANDS
        };
        for (facts, reason) in [(moves, "robot-moves"), (gone, "no-robot")] {
            let mut desk = CalibrationDesk::default();
            let begun = ask(&mut desk, ONE, CalibrationRequest::Begin(Vec::new()), facts);
            assert_eq!(begun, Err(reason));
            assert_eq!(desk.end(), None, "nothing runs");
        }
    }

    #[test]
    fn one_client_calibrates_and_only_it_answers() {
        let mut desk = CalibrationDesk::default();
        let held = CalibrationRequest::Hold(true);
        assert_eq!(ask(&mut desk, ONE, held.clone(), STANDS), Err("not-calibrating"));
        let begin = CalibrationRequest::Begin(vec!["wheel-track".to_owned()]);
        let begun = ask(&mut desk, ONE, begin.clone(), STANDS);
        let wanted = CalibrationTask::Begin("sr8730".to_owned(), vec!["wheel-track".to_owned()]);
        assert_eq!(begun, Ok(wanted));
        assert_eq!(ask(&mut desk, OTHER, begin, STANDS), Err("being-calibrated"));
        assert_eq!(
            ask(&mut desk, OTHER, held.clone(), STANDS),
            Err("not-calibrating")
        );
        assert_eq!(ask(&mut desk, ONE, held, STANDS), Ok(CalibrationTask::Hold(true)));
    }

    #[test]
    fn it_ends_with_its_client_and_with_anybodys_stop() {
        let mut desk = CalibrationDesk::default();
        assert_eq!(desk.end(), None, "nothing runs");
        ask(&mut desk, ONE, CalibrationRequest::Begin(Vec::new()), STANDS).expect("it stands");
        assert_eq!(desk.forget_client(OTHER), None);
        for order in [desk.forget_client(ONE), desk.end()] {
            assert_eq!(order.map(|order| order.task), Some(CalibrationTask::End));
        }
        desk.over();
        assert_eq!(desk.end(), None, "nothing runs");
    }
}
