//! RvcCleanMode: how hard brushes and suction run in jobs that begin by Matter.

use bridge::FanSpeed;
use rs_matter::dm::clusters::decl::globals::{ModeOptionStructArrayBuilder, ModeOptionStructBuilder};
use rs_matter::dm::clusters::decl::rvc_clean_mode::{
    AttributeId, ChangeToModeRequest, ChangeToModeResponseBuilder, ClusterHandler, FULL_CLUSTER, ModeTag,
    StatusCode,
};
use rs_matter::dm::{ArrayAttributeRead, Cluster, Dataver, InvokeContext, ReadContext};
use rs_matter::error::Error;
use rs_matter::tlv::TLVBuilderParent;
use rs_matter::with;

use super::limit;
use super::modes::{self, Mode, UNSUPPORTED};
use crate::robot::Robot;

const VACUUM: u16 = ModeTag::Vacuum as u16;
/// In the order of [`FanSpeed::ALL`]; the place there is the number here.
const MODES: [Mode; 4] = [
    mode(0, &[VACUUM, ModeTag::Auto as u16]),
    mode(1, &[VACUUM, ModeTag::Quiet as u16]),
    mode(2, &[VACUUM]),
    mode(3, &[VACUUM, ModeTag::Max as u16]),
];
/// A job goes on as it began.
const JOB_RUNS: &str = "A job is under way. Choose again when it is done.";

const fn mode(id: u8, tags: &'static [u16]) -> Mode {
    Mode {
        id,
        label: FanSpeed::ALL[id as usize].name(),
        tags,
    }
}

#[derive(Debug)]
pub(crate) struct Suction<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) version: Dataver,
}

impl Suction<'_> {
    fn current(&self) -> u8 {
        let speed = self.robot.choices().speed();
        let place = FanSpeed::ALL.iter().position(|known| *known == speed);
        place.and_then(|place| MODES.get(place)).map_or(0, |mode| mode.id)
    }
}

impl ClusterHandler for Suction<'_> {
    const CLUSTER: Cluster<'static> = FULL_CLUSTER.with_attrs(with!(required));

    fn dataver(&self) -> u32 {
        self.version.get()
    }

    fn dataver_changed(&self) {
        self.version.changed();
    }

    fn supported_modes<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<ModeOptionStructArrayBuilder<P>, ModeOptionStructBuilder<P>>,
    ) -> Result<P, Error> {
        modes::write(&MODES, builder)
    }

    fn current_mode(&self, _: impl ReadContext) -> Result<u8, Error> {
        Ok(self.current())
    }

    fn handle_change_to_mode<P: TLVBuilderParent>(
        &self,
        context: impl InvokeContext,
        request: ChangeToModeRequest<'_>,
        response: ChangeToModeResponseBuilder<P>,
    ) -> Result<P, Error> {
        let wanted = request.new_mode()?;
        let Some(speed) = FanSpeed::ALL.get(usize::from(wanted)) else {
            return response.status(UNSUPPORTED)?.status_text(Some(""))?.end();
        };
        if wanted == self.current() {
            return response.status(0)?.status_text(None)?.end();
        }
        limit(self.robot)?;
        if self.robot.view().cleans {
            let status = StatusCode::CleaningInProgress as u8;
            return response.status(status)?.status_text(Some(JOB_RUNS))?.end();
        }
        self.robot.choices_mut().choose_speed(*speed);
        context.notify_own_attr_changed(AttributeId::CurrentMode as u32);
        response.status(0)?.status_text(None)?.end()
    }
}

#[cfg(test)]
mod tests {
    use bridge::FanSpeed;

    use super::super::modes::tests::check;
    use super::MODES;

    #[test]
    fn the_modes_are_as_the_specification_wants_them_and_each_speed_has_one() {
        check(&MODES);
        assert_eq!(MODES.map(|mode| mode.label), FanSpeed::ALL.map(FanSpeed::name));
        assert!(
            MODES
                .iter()
                .enumerate()
                .all(|(place, mode)| usize::from(mode.id) == place)
        );
    }
}
