//! The robots' firmware in the package: whoever flashes a robot needs no compiler.

use crate::firmware;
use anyhow::Context;
use std::path::{Path, PathBuf};

/// Where the images lie in the board's system.
pub(super) const PLACE: &str = "usr/share/librervac/firmware";

/// Builds the images into `folder`; gives the folder.
pub(super) fn gather(folder: &Path) -> anyhow::Result<PathBuf> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for (name, image) in firmware::images_for_owners()? {
        std::fs::copy(&image, folder.join(name))
            .with_context(|| format!("cannot copy {}", image.display()))?;
    }
    Ok(folder.to_path_buf())
}
