//! Maps and logs of others lie beside the repository for tests; none of them may come into it.

use super::Finding;
use super::files::Files;
use std::collections::BTreeMap;
use std::path::Path;

/// The folder beside the repository.
const BESIDE: &str = "../shared";
/// Smaller files can be equal by chance.
const SIZE_MIN: u64 = 64;

/// Compares every file of ours with every file there.
pub(super) fn check(files: &Files) -> anyhow::Result<Finding> {
    let folder = Files::outside(BESIDE);
    if !folder.is_dir() {
        return Ok(Finding::Skipped(format!("{BESIDE} is not there")));
    }
    let mut foreign: BTreeMap<u64, Vec<std::path::PathBuf>> = BTreeMap::new();
    collect(&folder, &mut foreign)?;
    let mut found = Vec::new();
    for file in files.all() {
        let alike = u64::try_from(file.bytes.len())
            .ok()
            .and_then(|size| foreign.get(&size));
        for path in alike.into_iter().flatten() {
            if std::fs::read(path).is_ok_and(|bytes| bytes == file.bytes) {
                found.push(format!(
                    "{}: is the same as {}; make one of our own",
                    file.path,
                    path.display()
                ));
            }
        }
    }
    Ok(Finding::Checked(found))
}

fn collect(folder: &Path, found: &mut BTreeMap<u64, Vec<std::path::PathBuf>>) -> anyhow::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let meta = entry.metadata()?;
        if meta.is_dir() {
            collect(&entry.path(), found)?;
        } else if meta.len() >= SIZE_MIN {
            found.entry(meta.len()).or_default().push(entry.path());
        }
    }
    Ok(())
}
