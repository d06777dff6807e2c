//! Instructions that nobody executes when a robot starts, whatever it finds.

use std::collections::HashSet;

use monitor::Bridges;
use pic32::image::{Image, SymbolKind};

use crate::testbed::{Fixture, Testbed, TestbedError};

/// A robot starts, greets and describes itself within this time.
const START_MS: u64 = 600;

/// Physical addresses of instructions that are executed neither when a robot starts, nor when it finds its image damaged and
/// starts again.
///
/// # Errors
/// When there is no robot.
pub(super) fn idle_code(fixture: &Fixture) -> Result<HashSet<u32>, TestbedError> {
    let mut testbed = fixture.testbed(1, Bridges::Sound, 0)?;
    let mut idle: HashSet<u32> = instructions(fixture.image()).collect();
    leave_idle(&mut idle, &mut testbed);
    // The order of a set is random, the least member is not.
    if let Some(address) = idle.iter().min() {
        let machine = testbed.robot_mut().machine_mut();
        // An instruction of the image is in flash.
        machine.flip_flash_bit(*address, 0).unwrap_or_default();
    }
    leave_idle(&mut idle, &mut testbed);
    Ok(idle)
}

/// Leaves those in the set that are not executed while the robot starts.
fn leave_idle(idle: &mut HashSet<u32>, testbed: &mut Testbed) {
    testbed.robot_mut().machine_mut().note_touches();
    testbed.run(START_MS);
    for (address, touch) in testbed.robot_mut().machine_mut().take_touches() {
        if touch.executed {
            idle.remove(&address);
        }
    }
}

fn instructions(image: &Image) -> impl Iterator<Item = u32> {
    let functions = image.symbols().iter();
    functions
        .filter(|symbol| symbol.kind == SymbolKind::Function)
        .flat_map(|symbol| (symbol.address..symbol.address + symbol.size).step_by(4))
        .map(|address| address & 0x1FFF_FFFF)
        .filter(|address| (0x1D00_0000..0x1D04_0000).contains(address))
}
