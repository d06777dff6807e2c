//! RvcOperationalState: what the robot does, what is the matter with it, and pause, resume, go home.

use rs_matter::dm::clusters::decl::globals::{
    ErrorStateStructBuilder, OperationalStateStructArrayBuilder, OperationalStateStructBuilder,
};
use rs_matter::dm::clusters::decl::rvc_operational_state::{
    ClusterAsyncHandler, ErrorStateEnum, FULL_CLUSTER, OperationalCommandResponseBuilder,
    OperationalStateEnum,
};
use rs_matter::dm::{ArrayAttributeRead, Cluster, Dataver, InvokeContext, ReadContext};
use rs_matter::error::{Error, ErrorCode};
use rs_matter::tlv::{Nullable, NullableBuilder, TLVBuilderParent, Utf8StrArrayBuilder, Utf8StrBuilder};
use rs_matter::with;
use rvac_api::RequestBody;

use super::limit;
use crate::refusal::Refusal;
use crate::robot::Robot;
use crate::view::{CHARGING, Fault, PAUSED, RUNNING};

/// The states that the robot can be in.
const STATES: [u8; 7] = [
    OperationalStateEnum::Stopped as u8,
    OperationalStateEnum::Running as u8,
    OperationalStateEnum::Paused as u8,
    OperationalStateEnum::VError as u8,
    OperationalStateEnum::SeekingCharger as u8,
    OperationalStateEnum::Charging as u8,
    OperationalStateEnum::Docked as u8,
];
/// On its dock, or on the way there.
const AT_HOME: [u8; 3] = [
    OperationalStateEnum::SeekingCharger as u8,
    CHARGING,
    OperationalStateEnum::Docked as u8,
];

#[derive(Debug)]
pub(crate) struct Operation<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) version: Dataver,
}

/// What becomes of a command.
enum Outcome {
    Done,
    /// It asks for what does not fit to the state of the robot.
    Unfit(&'static str),
    Refused(Refusal),
}

impl From<Result<(), Refusal>> for Outcome {
    fn from(result: Result<(), Refusal>) -> Self {
        result.map_or_else(Self::Refused, |()| Self::Done)
    }
}

impl Operation<'_> {
    async fn pause(&self) -> Outcome {
        if self.robot.view().state == PAUSED {
            return Outcome::Done;
        }
        let asked = self
            .robot
            .ask(RequestBody::Pause, |view| view.state == PAUSED)
            .await;
        asked.into()
    }

    async fn resume(&self) -> Outcome {
        if self.robot.view().state == RUNNING {
            return Outcome::Done;
        }
        let asked = self
            .robot
            .ask(RequestBody::Resume, |view| view.state != PAUSED)
            .await;
        asked.into()
    }

    async fn go_home(&self) -> Outcome {
        if AT_HOME.contains(&self.robot.view().state) {
            return Outcome::Unfit("It is there, or on its way.");
        }
        let asked = self
            .robot
            .ask(RequestBody::Dock, |view| AT_HOME.contains(&view.state))
            .await;
        asked.into()
    }
}

fn answer<P: TLVBuilderParent>(
    outcome: Outcome,
    response: OperationalCommandResponseBuilder<P>,
) -> Result<P, Error> {
    let error = response.command_response_state()?;
    let fault = match outcome {
        Outcome::Done => None,
        Outcome::Unfit(text) => Some(Fault {
            id: ErrorStateEnum::CommandInvalidInState as u8,
            details: text.to_owned(),
        }),
        Outcome::Refused(refusal) => Some(Fault {
            id: refusal.command_error(),
            details: refusal.text(),
        }),
    };
    write_fault(error, fault.as_ref())?.end()
}

/// What is the matter, or that nothing is. A label is for errors that a maker adds; these are all of the standard's own.
pub(crate) fn write_fault<P: TLVBuilderParent>(
    builder: ErrorStateStructBuilder<P>,
    fault: Option<&Fault>,
) -> Result<P, Error> {
    let id = fault.map_or(ErrorStateEnum::NoError as u8, |fault| fault.id);
    let details = fault.map(|fault| fault.details.as_str());
    builder
        .error_state_id(id)?
        .error_state_label(None)?
        .error_state_details(details)?
        .end()
}

fn write_state<P: TLVBuilderParent>(
    state: u8,
    builder: OperationalStateStructBuilder<P>,
) -> Result<P, Error> {
    builder
        .operational_state_id(state)?
        .operational_state_label(None)?
        .end()
}

impl ClusterAsyncHandler for Operation<'_> {
    const CLUSTER: Cluster<'static> = FULL_CLUSTER.with_attrs(with!(required));

    fn dataver(&self) -> u32 {
        self.version.get()
    }

    fn dataver_changed(&self) {
        self.version.changed();
    }

    /// It has no phases.
    async fn phase_list<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<NullableBuilder<P, Utf8StrArrayBuilder<P>>, Utf8StrBuilder<P>>,
    ) -> Result<P, Error> {
        match builder {
            ArrayAttributeRead::ReadAll(all) | ArrayAttributeRead::ReadNone(all) => all.null(),
            ArrayAttributeRead::ReadOne(..) => Err(ErrorCode::ConstraintError.into()),
        }
    }

    async fn current_phase(&self, _: impl ReadContext) -> Result<Nullable<u8>, Error> {
        Ok(Nullable::none())
    }

    async fn operational_state_list<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<OperationalStateStructArrayBuilder<P>, OperationalStateStructBuilder<P>>,
    ) -> Result<P, Error> {
        match builder {
            ArrayAttributeRead::ReadAll(mut all) => {
                for state in STATES {
                    all = write_state(state, all.push()?)?;
                }
                all.end()
            }
            ArrayAttributeRead::ReadOne(index, one) => {
                let state = STATES.get(usize::from(index)).ok_or(ErrorCode::ConstraintError)?;
                write_state(*state, one)
            }
            ArrayAttributeRead::ReadNone(all) => all.end(),
        }
    }

    async fn operational_state(&self, _: impl ReadContext) -> Result<u8, Error> {
        Ok(self.robot.view().state)
    }

    async fn operational_error<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ErrorStateStructBuilder<P>,
    ) -> Result<P, Error> {
        write_fault(builder, self.robot.view().fault.as_ref())
    }

    async fn handle_pause<P: TLVBuilderParent>(
        &self,
        _: impl InvokeContext,
        response: OperationalCommandResponseBuilder<P>,
    ) -> Result<P, Error> {
        limit(self.robot)?;
        answer(self.pause().await, response)
    }

    async fn handle_resume<P: TLVBuilderParent>(
        &self,
        _: impl InvokeContext,
        response: OperationalCommandResponseBuilder<P>,
    ) -> Result<P, Error> {
        limit(self.robot)?;
        answer(self.resume().await, response)
    }

    async fn handle_go_home<P: TLVBuilderParent>(
        &self,
        _: impl InvokeContext,
        response: OperationalCommandResponseBuilder<P>,
    ) -> Result<P, Error> {
        limit(self.robot)?;
        answer(self.go_home().await, response)
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::Activity;

    use super::STATES;

    #[test]
    fn every_state_of_the_robot_is_one_that_it_says_it_can_be_in() {
        for activity in Activity::ALL {
            assert!(STATES.contains(&activity.words().matter_state), "{activity:?}");
        }
    }
}
