//! Updates that are cut off at each of their steps, and then at each step of the way back.

use minisign::KeyPair;
use rvac_update::{Accepted, UpdateError, WayBack};

use crate::update_world::{
    ModelChip, ModelChipPort, Release, RobotEnd as _, UpdateWorld, accepted, key_pair,
};

/// A board with a chip that is a text.
type ModelWorld = UpdateWorld<ModelChip, ModelChipPort>;

/// Updates that were cut off, and what came of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UpdateCuts {
    /// Runs that were cut off.
    pub cut: u32,
    /// After which the next runs ended with programs that are not whole, or with a robot that says nothing.
    pub broken: u32,
    /// After which programs and firmware were of different updates.
    pub mixed: u32,
    /// After which the same update could not be put in use, although it works.
    pub stuck: u32,
}

/// How a board goes from one update to the next.
#[derive(Debug)]
struct Course {
    before: Option<Release>,
    after: Release,
    /// Whether the update works.
    works: bool,
    readable: bool,
}

impl Course {
    fn accepted(&self, pair: &KeyPair) -> Accepted {
        Accepted {
            way_back: match self.readable {
                true => WayBack::Needed,
                false => WayBack::None,
            },
            ..accepted(pair)
        }
    }

    /// A board on which the update before is in use.
    fn world(&self, pair: &KeyPair) -> anyhow::Result<ModelWorld> {
        let mut world = ModelWorld::with_model()?;
        if let Some(before) = &self.before {
            world.install(&before.packed(pair)?, &self.accepted(pair))?;
        }
        world.robot.borrow_mut().is_readable = self.readable;
        Ok(world)
    }
}

fn courses() -> Vec<Course> {
    let silent = Release {
        firmware: Some("silent".to_owned()),
        ..Release::good(2)
    };
    let broken = Release {
        daemon: "broken".to_owned(),
        ..Release::good(2)
    };
    let course = |before: Option<Release>, after: Release| Course {
        works: after.daemon != "broken" && after.firmware.as_deref() != Some("silent"),
        before,
        after,
        readable: true,
    };
    vec![
        course(None, Release::good(1)),
        course(Some(Release::good(1)), Release::good(2)),
        course(Some(Release::good(1)), silent),
        course(Some(Release::good(1)), broken),
        Course {
            readable: false,
            ..course(Some(Release::good(1)), Release::good(2))
        },
    ]
}

/// Cuts each course at each step.
///
/// # Errors
/// When a trial cannot be made.
pub fn cut_everywhere() -> anyhow::Result<UpdateCuts> {
    let pair = key_pair();
    let mut cuts = UpdateCuts::default();
    for course in courses() {
        let archive = course.after.packed(&pair)?;
        let mut whole = course.world(&pair)?;
        whole.supply.come_back(None);
        let outcome = whole.install(&archive, &course.accepted(&pair));
        anyhow::ensure!(outcome.is_ok() == course.works, "{outcome:?}");
        for step in 0..whole.supply.used() {
            cut_at(step, (&course, &archive, &pair), &mut cuts)?;
        }
    }
    Ok(cuts)
}

fn cut_at(
    step: u64,
    (course, archive, pair): (&Course, &[u8], &KeyPair),
    cuts: &mut UpdateCuts,
) -> anyhow::Result<()> {
    let mut world = course.world(pair)?;
    world.supply.come_back(Some(step));
    let refused = world.install(archive, &course.accepted(pair)).is_err();
    anyhow::ensure!(world.supply.is_cut(), "step {step} is not reached");
    cuts.cut += 1;
    // Each next run comes one step further.
    for lasts in 0.. {
        world.supply.come_back(Some(lasts));
        let settled = world.settle();
        if !world.supply.is_cut() {
            settled?;
            break;
        }
        cuts.cut += 1;
    }
    world.supply.come_back(None);
    let before: Vec<&Release> = course.before.iter().chain([&course.after]).collect();
    let (daemon, firmware) = (world.daemon(), world.robot.borrow().content.clone());
    let is_after = daemon.as_deref() == Some(course.after.daemon.as_str());
    let has_after = course.after.firmware.as_deref() == Some(firmware.as_str());
    // Without a way back the update is finished even if it is the cut that ended it.
    let speaks = world.robot.borrow().speaks();
    cuts.broken += u32::from(!world.runs_whole(&before) || !speaks);
    cuts.mixed += u32::from(is_after != has_after);
    if course.works && !is_after {
        let again = world.install(archive, &course.accepted(pair));
        cuts.stuck += u32::from(again.is_err());
    } else if course.works {
        let again = world.install(archive, &course.accepted(pair));
        let is_old = matches!(again, Err(UpdateError::OldEpoch { .. }));
        cuts.stuck += u32::from(!is_old || !refused && step == 0);
    }
    Ok(())
}
