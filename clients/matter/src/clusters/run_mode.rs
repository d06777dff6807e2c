//! RvcRunMode: whether the robot has a job.

use rs_matter::dm::clusters::decl::globals::{ModeOptionStructArrayBuilder, ModeOptionStructBuilder};
use rs_matter::dm::clusters::decl::rvc_run_mode::{
    AttributeId, ChangeToModeRequest, ChangeToModeResponseBuilder, ClusterAsyncHandler, FULL_CLUSTER, ModeTag,
};
use rs_matter::dm::{ArrayAttributeRead, Cluster, Dataver, InvokeContext, ReadContext};
use rs_matter::error::Error;
use rs_matter::tlv::TLVBuilderParent;
use rs_matter::with;
use rvac_api::RequestBody;

use super::limit;
use super::modes::{self, Mode, UNSUPPORTED};
use crate::refusal::Refusal;
use crate::robot::Robot;

const IDLE: u8 = 0;
const CLEANING: u8 = 1;
/// The robot draws its map while it cleans, and has no mode that does only that.
const MODES: [Mode; 2] = [
    Mode {
        id: IDLE,
        label: "Idle",
        tags: &[ModeTag::Idle as u16],
    },
    Mode {
        id: CLEANING,
        label: "Cleaning",
        tags: &[ModeTag::Cleaning as u16],
    },
];

#[derive(Debug)]
pub(crate) struct RunMode<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) version: Dataver,
}

impl RunMode<'_> {
    fn current(&self) -> u8 {
        if self.robot.view().cleans { CLEANING } else { IDLE }
    }

    async fn change(&self, wanted: u8) -> Result<(), Refusal> {
        if wanted == IDLE {
            return self.robot.ask(RequestBody::Stop, |view| !view.cleans).await;
        }
        let job = self.robot.job();
        self.robot.ask(job, |view| view.cleans).await
    }
}

impl ClusterAsyncHandler for RunMode<'_> {
    const CLUSTER: Cluster<'static> = FULL_CLUSTER.with_attrs(with!(required));

    fn dataver(&self) -> u32 {
        self.version.get()
    }

    fn dataver_changed(&self) {
        self.version.changed();
    }

    async fn supported_modes<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<ModeOptionStructArrayBuilder<P>, ModeOptionStructBuilder<P>>,
    ) -> Result<P, Error> {
        modes::write(&MODES, builder)
    }

    async fn current_mode(&self, _: impl ReadContext) -> Result<u8, Error> {
        Ok(self.current())
    }

    async fn handle_change_to_mode<P: TLVBuilderParent>(
        &self,
        context: impl InvokeContext,
        request: ChangeToModeRequest<'_>,
        response: ChangeToModeResponseBuilder<P>,
    ) -> Result<P, Error> {
        let wanted = request.new_mode()?;
        if !MODES.iter().any(|mode| mode.id == wanted) {
            return response.status(UNSUPPORTED)?.status_text(Some(""))?.end();
        }
        if wanted == self.current() {
            return response.status(0)?.status_text(None)?.end();
        }
        limit(self.robot)?;
        match self.change(wanted).await {
            Ok(()) => {
                context.notify_own_attr_changed(AttributeId::CurrentMode as u32);
                response.status(0)?.status_text(None)?.end()
            }
            Err(refusal) => {
                let text = refusal.text();
                response
                    .status(refusal.mode_status())?
                    .status_text(Some(text.as_str()))?
                    .end()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::modes::tests::check;
    use super::MODES;

    #[test]
    fn the_modes_are_as_the_specification_wants_them() {
        check(&MODES);
    }
}
