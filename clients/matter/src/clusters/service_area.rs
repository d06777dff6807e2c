//! ServiceArea: the rooms of the map, and which of them the next job cleans.

use rs_matter::dm::clusters::decl::service_area::{
    AreaStructArrayBuilder, AreaStructBuilder, AttributeId, ClusterHandler, CommandId, FULL_CLUSTER, Feature,
    MapStructArrayBuilder, MapStructBuilder, OperationalStatusEnum, ProgressStructArrayBuilder,
    ProgressStructBuilder, SelectAreasRequest, SelectAreasResponseBuilder, SelectAreasStatus,
    SkipAreaRequest, SkipAreaResponseBuilder,
};
use rs_matter::dm::{ArrayAttributeRead, Cluster, Dataver, InvokeContext, ReadContext};
use rs_matter::error::{Error, ErrorCode};
use rs_matter::tlv::{Nullable, TLVBuilderParent, ToTLVArrayBuilder, ToTLVBuilder};
use rs_matter::with;

use super::limit;
use crate::choices::AREAS_MAX;
use crate::progress::{RoomProgress, RoomState};
use crate::robot::Robot;
use crate::text::{AREA_TEXT_BYTES_MAX, cut};
use crate::view::{Area, View};

#[derive(Debug)]
pub(crate) struct Areas<'a> {
    pub(crate) robot: &'a Robot,
    pub(crate) version: Dataver,
}

/// Why a selection is none.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Unfit {
    JobRuns,
    NoSuchRoom { area: u32 },
    TooMany { count: usize },
}

impl Unfit {
    const fn status(&self) -> SelectAreasStatus {
        match self {
            Self::JobRuns => SelectAreasStatus::InvalidInMode,
            Self::NoSuchRoom { .. } => SelectAreasStatus::UnsupportedArea,
            Self::TooMany { .. } => SelectAreasStatus::InvalidSet,
        }
    }

    fn text(&self) -> String {
        let text = match self {
            Self::JobRuns => "A job is under way. Choose rooms when it is done.".to_owned(),
            Self::NoSuchRoom { area } => {
                format!("The map has no room {area}. Choose one of those that it has.")
            }
            Self::TooMany { count } => {
                format!("A job has {AREAS_MAX} rooms at most, not {count}. Choose fewer.")
            }
        };
        cut(&text, AREA_TEXT_BYTES_MAX)
    }
}

/// The rooms of a selection in its order, each once. None means all.
fn selection(view: &View, wanted: &[u32]) -> Result<Vec<u16>, Unfit> {
    let mut rooms = Vec::new();
    for area in wanted {
        let room = u16::try_from(*area).ok().filter(|room| view.has_area(*room));
        let room = room.ok_or(Unfit::NoSuchRoom { area: *area })?;
        if !rooms.contains(&room) {
            rooms.push(room);
        }
    }
    if rooms.len() > AREAS_MAX {
        return Err(Unfit::TooMany { count: rooms.len() });
    }
    if view.cleans {
        return Err(Unfit::JobRuns);
    }
    Ok(rooms)
}

fn write_area<P: TLVBuilderParent>(
    (area, map): (&Area, Option<&Area>),
    builder: AreaStructBuilder<P>,
) -> Result<P, Error> {
    let map = map.map_or(Nullable::none(), |map| Nullable::some(u32::from(map.id)));
    let about = builder.area_id(u32::from(area.id))?.map_id(map)?.area_info()?;
    let place = about
        .location_info()?
        .non_null()?
        .location_name(area.name.as_str())?
        .floor_number(Nullable::none())?
        .area_type(Nullable::none())?
        .end()?;
    place.landmark_info()?.null()?.end()?.end()
}

fn write_map<P: TLVBuilderParent>(map: &Area, builder: MapStructBuilder<P>) -> Result<P, Error> {
    builder.map_id(u32::from(map.id))?.name(map.name.as_str())?.end()
}

fn write_progress<P: TLVBuilderParent>(
    row: &RoomProgress,
    builder: ProgressStructBuilder<P>,
) -> Result<P, Error> {
    let status = match row.state {
        RoomState::Pending => OperationalStatusEnum::Pending,
        RoomState::Operating => OperationalStatusEnum::Operating,
        RoomState::Skipped => OperationalStatusEnum::Skipped,
        RoomState::Completed => OperationalStatusEnum::Completed,
    };
    let took_s = row.took_s.map_or(Nullable::none(), Nullable::some);
    builder
        .area_id(u32::from(row.room))?
        .status(status)?
        .total_operational_time(Some(took_s))?
        .estimated_time(None)?
        .end()
}

impl ClusterHandler for Areas<'_> {
    const CLUSTER: Cluster<'static> = FULL_CLUSTER
        .with_features(Feature::MAPS.bits() | Feature::PROGRESS_REPORTING.bits())
        .with_attrs(
            with!(required; AttributeId::SupportedMaps | AttributeId::CurrentArea | AttributeId::Progress),
        )
        .with_cmds(with!(CommandId::SelectAreas));

    fn dataver(&self) -> u32 {
        self.version.get()
    }

    fn dataver_changed(&self) {
        self.version.changed();
    }

    fn supported_areas<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<AreaStructArrayBuilder<P>, AreaStructBuilder<P>>,
    ) -> Result<P, Error> {
        let view = self.robot.view();
        let map = view.map.as_ref();
        match builder {
            ArrayAttributeRead::ReadAll(mut all) => {
                for area in &view.areas {
                    all = write_area((area, map), all.push()?)?;
                }
                all.end()
            }
            ArrayAttributeRead::ReadOne(index, one) => {
                let area = view
                    .areas
                    .get(usize::from(index))
                    .ok_or(ErrorCode::ConstraintError)?;
                write_area((area, map), one)
            }
            ArrayAttributeRead::ReadNone(all) => all.end(),
        }
    }

    fn supported_maps<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<MapStructArrayBuilder<P>, MapStructBuilder<P>>,
    ) -> Result<P, Error> {
        let view = self.robot.view();
        match builder {
            ArrayAttributeRead::ReadAll(mut all) => {
                if let Some(map) = &view.map {
                    all = write_map(map, all.push()?)?;
                }
                all.end()
            }
            ArrayAttributeRead::ReadOne(index, one) => {
                let map = view.map.as_ref().filter(|_| index == 0);
                write_map(map.ok_or(ErrorCode::ConstraintError)?, one)
            }
            ArrayAttributeRead::ReadNone(all) => all.end(),
        }
    }

    fn selected_areas<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<ToTLVArrayBuilder<P, u32>, ToTLVBuilder<P, u32>>,
    ) -> Result<P, Error> {
        let choices = self.robot.choices();
        match builder {
            ArrayAttributeRead::ReadAll(mut all) => {
                for room in choices.areas() {
                    all = all.push(&u32::from(*room))?;
                }
                all.end()
            }
            ArrayAttributeRead::ReadOne(index, one) => {
                let room = choices
                    .areas()
                    .get(usize::from(index))
                    .ok_or(ErrorCode::ConstraintError)?;
                one.set(&u32::from(*room))
            }
            ArrayAttributeRead::ReadNone(all) => all.end(),
        }
    }

    fn current_area(&self, _: impl ReadContext) -> Result<Nullable<u32>, Error> {
        let here = self.robot.view().here;
        Ok(here.map_or(Nullable::none(), |room| Nullable::some(u32::from(room))))
    }

    fn progress<P: TLVBuilderParent>(
        &self,
        _: impl ReadContext,
        builder: ArrayAttributeRead<ProgressStructArrayBuilder<P>, ProgressStructBuilder<P>>,
    ) -> Result<P, Error> {
        let view = self.robot.view();
        match builder {
            ArrayAttributeRead::ReadAll(mut all) => {
                for row in &view.progress {
                    all = write_progress(row, all.push()?)?;
                }
                all.end()
            }
            ArrayAttributeRead::ReadOne(index, one) => {
                let row = view.progress.get(usize::from(index));
                write_progress(row.ok_or(ErrorCode::ConstraintError)?, one)
            }
            ArrayAttributeRead::ReadNone(all) => all.end(),
        }
    }

    fn handle_select_areas<P: TLVBuilderParent>(
        &self,
        context: impl InvokeContext,
        request: SelectAreasRequest<'_>,
        response: SelectAreasResponseBuilder<P>,
    ) -> Result<P, Error> {
        limit(self.robot)?;
        let wanted = request.new_areas()?;
        let wanted = wanted.iter().collect::<Result<Vec<u32>, Error>>()?;
        let selected = selection(&self.robot.view(), &wanted);
        match selected {
            Ok(rooms) => {
                self.robot.choices_mut().choose_areas(rooms);
                context.notify_own_attr_changed(AttributeId::SelectedAreas as u32);
                response
                    .status(SelectAreasStatus::Success)?
                    .status_text("")?
                    .end()
            }
            Err(unfit) => response
                .status(unfit.status())?
                .status_text(unfit.text().as_str())?
                .end(),
        }
    }

    /// Not among the commands: a job of ours cannot leave out a part of itself.
    fn handle_skip_area<P: TLVBuilderParent>(
        &self,
        _: impl InvokeContext,
        _: SkipAreaRequest<'_>,
        _: SkipAreaResponseBuilder<P>,
    ) -> Result<P, Error> {
        Err(ErrorCode::CommandNotFound.into())
    }
}

#[cfg(test)]
mod tests {
    use super::{Unfit, selection};
    use crate::view::{Area, View};

    #[test]
    fn a_selection_keeps_its_order_and_names_only_rooms_that_there_are() {
        let areas = (1..=40).map(|id| Area {
            id,
            name: format!("Room {id}"),
        });
        let mut view = View {
            areas: areas.collect(),
            ..View::default()
        };
        assert_eq!(selection(&view, &[3, 1, 3]), Ok(vec![3, 1]));
        assert_eq!(selection(&view, &[]), Ok(vec![]));
        for area in [0, 41, 65_537] {
            assert_eq!(selection(&view, &[1, area]), Err(Unfit::NoSuchRoom { area }));
        }
        let all: Vec<u32> = (1..=40).collect();
        assert_eq!(selection(&view, &all), Err(Unfit::TooMany { count: 40 }));
        assert_eq!(selection(&view, &all[..32]).map(|rooms| rooms.len()), Ok(32));
        view.cleans = true;
        assert_eq!(selection(&view, &[1]), Err(Unfit::JobRuns));
        assert_eq!(selection(&view, &[99]), Err(Unfit::NoSuchRoom { area: 99 }));
        assert!(Unfit::JobRuns.text().len() <= 256);
    }
}
