//! How long it takes until the robot stands in its home: told before anything is built.

use super::DemoArguments;
use crate::panel::Page;
use crate::workspace::{self, Profile, program};
use crate::{firmware, process};
use std::path::PathBuf;

/// Something that is built the first time.
struct Part {
    what: &'static str,
    /// What is there once it was built.
    product: PathBuf,
    /// Seconds of processor that a build of it takes from nothing.
    processor_s: f64,
}

/// Seconds of processor that were measured on an empty target folder; the crates that cargo downloads were there.
const PROGRAMS_S: f64 = 240.0;
const PAGE_S: f64 = 440.0;
const PACKER_S: f64 = 45.0;
const FIRMWARE_S: f64 = 40.0;

/// Tells it.
pub(super) fn tell(arguments: &DemoArguments) {
    let missing: Vec<Part> = parts(arguments)
        .into_iter()
        .filter(|part| !part.product.exists())
        .collect();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    process::say(&sentence(&missing, cores));
}

fn parts(arguments: &DemoArguments) -> Vec<Part> {
    let built = |what, product, processor_s| Part {
        what,
        product,
        processor_s,
    };
    let dev = |name| program(name, Profile::Dev);
    let mut parts = vec![built("simulator and daemon", dev("vthal"), PROGRAMS_S)];
    if arguments.emulated {
        let elf = workspace::target()
            .join("firmware")
            .join(format!("{}.elf", firmware::ROBOT));
        parts.push(built("the robot's firmware", elf, FIRMWARE_S));
    }
    if !arguments.headless {
        let page = Page::Demo.folder().join("index.html");
        parts.push(built("the page", page, PAGE_S));
        let packer = workspace::target().join("uipack/debug/uipack");
        parts.push(built("its packer", packer, PACKER_S));
    }
    parts
}

fn sentence(missing: &[Part], cores: usize) -> String {
    if missing.is_empty() {
        return "all of this was built before: it takes seconds when nothing has changed since, and as long as building that again \
                when something has"
            .to_owned();
    }
    let names: Vec<&str> = missing.iter().map(|part| part.what).collect();
    let processor_s: f64 = missing.iter().map(|part| part.processor_s).sum();
    format!(
        "not built yet: {}; with {cores} cores that takes about {:.0} minutes, once",
        names.join(", "),
        (processor_s / cores as f64 / 60.0).ceil()
    )
}

#[cfg(test)]
mod tests {
    use super::{Part, sentence};
    use std::path::PathBuf;

    fn part(what: &'static str, processor_s: f64) -> Part {
        Part {
            what,
            product: PathBuf::new(),
            processor_s,
        }
    }

    #[test]
    fn a_first_build_takes_minutes_and_a_later_one_seconds() {
        let told = sentence(&[part("a", 100.0), part("b", 200.0)], 2);
        assert_eq!(
            told,
            "not built yet: a, b; with 2 cores that takes about 3 minutes, once"
        );
        assert!(sentence(&[], 2).contains("seconds"));
    }
}
