//! The files of a package as they will lie in the board's system.

use super::Common;
use super::machine::Machine;
use crate::workspace;
use anyhow::Context;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// Files of the repository, and where they go.
const FILES: [(&str, &str); 20] = [
    (
        "packaging/systemd/vthal.service",
        "lib/systemd/system/vthal.service",
    ),
    (
        "packaging/systemd/rvac-panel.service",
        "lib/systemd/system/rvac-panel.service",
    ),
    (
        "packaging/systemd/rvac-settle.service",
        "lib/systemd/system/rvac-settle.service",
    ),
    (
        "packaging/systemd/rvac-update.path",
        "lib/systemd/system/rvac-update.path",
    ),
    (
        "packaging/systemd/rvac-update.service",
        "lib/systemd/system/rvac-update.service",
    ),
    (
        "packaging/systemd/librervac.tmpfiles",
        "usr/lib/tmpfiles.d/librervac.conf",
    ),
    (
        "packaging/udev/60-librervac.rules",
        "lib/udev/rules.d/60-librervac.rules",
    ),
    (
        "packaging/systemd/rvac-mqtt.service",
        "lib/systemd/system/rvac-mqtt.service",
    ),
    (
        "packaging/systemd/rvac-hooks.service",
        "lib/systemd/system/rvac-hooks.service",
    ),
    (
        "packaging/systemd/rvac-metrics.service",
        "lib/systemd/system/rvac-metrics.service",
    ),
    (
        "packaging/systemd/rvac-dialect.service",
        "lib/systemd/system/rvac-dialect.service",
    ),
    (
        "packaging/grafana/librervac.json",
        "usr/share/doc/librervac/grafana.json",
    ),
    (
        "packaging/prometheus/librervac.yml",
        "usr/share/doc/librervac/prometheus.yml",
    ),
    (
        "clients/mqtt/example.toml",
        "usr/share/doc/librervac/rvac-mqtt.toml",
    ),
    (
        "clients/hooks/example.toml",
        "usr/share/doc/librervac/rvac-hooks.toml",
    ),
    (
        "clients/dialect-server/example.toml",
        "usr/share/doc/librervac/rvac-dialect.toml",
    ),
    ("vthal/example.toml", "usr/share/doc/librervac/example.toml"),
    ("SAFETY.md", "usr/share/doc/librervac/SAFETY.md"),
    (
        "LICENSES/GPL-3.0-or-later.txt",
        "usr/share/doc/librervac/GPL-3.0-or-later.txt",
    ),
    (
        "LICENSES/AGPL-3.0-or-later.txt",
        "usr/share/doc/librervac/AGPL-3.0-or-later.txt",
    ),
];

/// Folders of the repository, and where their files go.
const FOLDERS: [(&str, &str); 2] = [
    ("robots", "usr/share/librervac/robots"),
    ("packaging/configurations", "usr/share/librervac/configurations"),
];

/// Who may do what with the files.
const COPYRIGHT: &str = "\
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: LibreRVAC

Files: *
Copyright: the contributors of LibreRVAC
License: GPL-3.0-or-later
 The text is in GPL-3.0-or-later.txt beside this file.

Files: usr/bin/panel-server usr/share/rvac-panel/*
Copyright: the contributors of LibreRVAC
License: AGPL-3.0-or-later
 The text is in AGPL-3.0-or-later.txt beside this file.

Comment: works of others that are linked into the programs and the page are in THIRD-PARTY.txt.
";

/// Lays the files of a package out; gives the folder that stands for the root of a system.
pub(super) fn lay(common: &Common, machine: Machine, programs: &[PathBuf]) -> anyhow::Result<PathBuf> {
    let root = super::folder().join(machine.name());
    if root.exists() {
        std::fs::remove_dir_all(&root).with_context(|| format!("cannot clear {}", root.display()))?;
    }
    for program in programs {
        let place = root.join("usr/bin").join(program.file_name().unwrap_or_default());
        copy(program, &place, 0o755)?;
    }
    let run = workspace::root().join("packaging/run");
    copy(&run, &root.join("usr/lib/librervac/run"), 0o755)?;
    for (from, to) in FILES {
        copy(&workspace::root().join(from), &root.join(to), 0o644)?;
    }
    for (from, to) in FOLDERS {
        copy_folder(&workspace::root().join(from), &root.join(to))?;
    }
    copy_folder(&common.panel, &root.join("usr/share/rvac-panel"))?;
    copy_folder(&common.manuals, &root)?;
    copy_folder(&common.firmware, &root.join(super::images::PLACE))?;
    copy_folder(&common.licences, &root.join("usr/share/doc/librervac"))?;
    std::fs::write(root.join("usr/share/doc/librervac/copyright"), COPYRIGHT)?;
    Ok(root)
}

fn copy_folder(from: &Path, to: &Path) -> anyhow::Result<()> {
    let entries = std::fs::read_dir(from).with_context(|| format!("cannot read {}", from.display()))?;
    for entry in entries {
        let path = entry?.path();
        let place = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy_folder(&path, &place)?;
        } else {
            copy(&path, &place, 0o644)?;
        }
    }
    Ok(())
}

fn copy(from: &Path, to: &Path, mode: u32) -> anyhow::Result<()> {
    if let Some(folder) = to.parent() {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::copy(from, to).with_context(|| format!("cannot copy {}", from.display()))?;
    std::fs::set_permissions(to, std::fs::Permissions::from_mode(mode))?;
    Ok(())
}
