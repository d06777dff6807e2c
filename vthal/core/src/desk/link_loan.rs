//! The serial line, lent to a client that writes the robot's firmware.
//!
//! The daemon lets go of the line and takes it again by itself when the client's connection ends, however that happens: a flasher that
//! is killed leaves no robot without its daemon. While the line is lent, the robot counts as disconnected.

use crate::ClientId;
use crate::core::desk_request::RobotAnswers;
use crate::outputs::LineHolder;
use crate::refusal::Refusal;

/// The pack must last through a flash, and through a second one.
const CHARGE_MIN: f64 = 0.4;

/// What is known of the robot, for whoever asks for its line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LoanFacts {
    /// It answers.
    pub(crate) is_attached: bool,
    /// Nothing of it moves.
    pub(crate) stands_still: bool,
    /// It stands on its dock, or is of a model without one.
    pub(crate) is_docked: bool,
    /// Of its pack, 0..1, where that is measured.
    pub(crate) charge: Option<f64>,
}

/// Who has the line, if not the daemon.
#[derive(Debug, Default)]
pub(crate) struct LinkLoan {
    holder: Option<ClientId>,
}

impl LinkLoan {
    /// Lends the line.
    ///
    /// # Errors
    /// Another client has it, or the robot is not where its firmware may be written.
    pub(crate) fn lend(
        &mut self,
        client: ClientId,
        answers: RobotAnswers,
        facts: LoanFacts,
    ) -> Result<LineHolder, Refusal> {
        if self.holder.is_some_and(|holder| holder != client) {
            return Err(refusal(
                "link-lent",
                "Another program has the serial line. Wait until it is done.",
            ));
        }
        if self.holder.is_none() {
            check(answers, facts)?;
        }
        self.holder = Some(client);
        Ok(LineHolder::Client)
    }

    /// The client is gone: the daemon takes the line again if it was lent to that one.
    pub(crate) fn forget_client(&mut self, client: ClientId) -> Option<LineHolder> {
        let held = self.holder == Some(client);
        held.then(|| {
            self.holder = None;
            LineHolder::Daemon
        })
    }
}

fn check(answers: RobotAnswers, facts: LoanFacts) -> Result<(), Refusal> {
    if !facts.is_attached {
        return match answers {
            RobotAnswers::Silent => Ok(()),
            RobotAnswers::Expected => Err(refusal(
                "no-robot",
                "The robot does not answer, so nobody knows where it stands. Look at it: on its dock, with a charged pack? Then \
                 ask again with --robot-is-silent.",
            )),
        };
    }
    if !facts.stands_still {
        return Err(refusal(
            "robot-moves",
            "The robot moves. Stop it and send it to its dock.",
        ));
    }
    if !facts.is_docked {
        return Err(refusal(
            "not-docked",
            "The robot is not on its dock. Send it there first, or set it there by hand.",
        ));
    }
    match facts.charge {
        Some(charge) if charge < CHARGE_MIN => Err(refusal(
            "battery-low",
            "The pack has less than 40 %. Let it charge first.",
        )),
        _ => Ok(()),
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
    use super::{LinkLoan, LoanFacts};
    use crate::ClientId;
    use crate::core::desk_request::RobotAnswers;
    use crate::outputs::LineHolder;

    const READY: LoanFacts = LoanFacts {
        is_attached: true,
        stands_still: true,
        is_docked: true,
        charge: Some(0.4),
    };

    #[test]
    fn a_robot_that_is_not_ready_keeps_its_daemon() {
        let cases = [
            (
                LoanFacts {
                    is_attached: false,
                    ..READY
                },
                "no-robot",
            ),
            (
                LoanFacts {
                    stands_still: false,
                    ..READY
                },
                "robot-moves",
            ),
            (
                LoanFacts {
                    is_docked: false,
                    ..READY
                },
                "not-docked",
            ),
            (
                LoanFacts {
                    charge: Some(0.39),
                    ..READY
                },
                "battery-low",
            ),
        ];
        for (facts, reason) in cases {
            let mut loan = LinkLoan::default();
            let refused = loan
                .lend(ClientId(1), RobotAnswers::Expected, facts)
                .map_err(|refusal| refusal.reason);
            assert_eq!(refused, Err(reason));
            assert_eq!(loan.forget_client(ClientId(1)), None, "nothing was lent");
        }
    }

    #[test]
    fn silence_excuses_only_a_robot_that_is_silent() {
        let silent = LoanFacts {
            is_attached: false,
            ..READY
        };
        let mut loan = LinkLoan::default();
        assert_eq!(
            loan.lend(ClientId(1), RobotAnswers::Silent, silent),
            Ok(LineHolder::Client)
        );
        let moves = LoanFacts {
            stands_still: false,
            ..READY
        };
        let refused = LinkLoan::default().lend(ClientId(1), RobotAnswers::Silent, moves);
        assert_eq!(refused.map_err(|refusal| refusal.reason), Err("robot-moves"));
    }

    #[test]
    fn the_line_is_lent_to_one_client_and_comes_back_with_its_end() {
        let mut loan = LinkLoan::default();
        let (one, other) = (ClientId(1), ClientId(2));
        assert_eq!(
            loan.lend(one, RobotAnswers::Expected, READY),
            Ok(LineHolder::Client)
        );
        // The robot is disconnected now; asking again does not end the loan.
        let lent = LoanFacts {
            is_attached: false,
            ..READY
        };
        assert_eq!(
            loan.lend(one, RobotAnswers::Expected, lent),
            Ok(LineHolder::Client)
        );
        let refused = loan
            .lend(other, RobotAnswers::Silent, lent)
            .map_err(|refusal| refusal.reason);
        assert_eq!(refused, Err("link-lent"));
        assert_eq!(loan.forget_client(other), None);
        assert_eq!(loan.forget_client(one), Some(LineHolder::Daemon));
        assert_eq!(
            loan.lend(other, RobotAnswers::Expected, READY),
            Ok(LineHolder::Client)
        );
    }
}
