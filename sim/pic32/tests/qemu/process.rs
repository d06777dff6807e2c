//! qemu-user.

use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};

const PROGRAM: &str = "qemu-mipsel-static";
/// A core with release 2 of the architecture and without floating point, like ours.
const CORE: &str = "24Kc";

/// The program.
#[derive(Debug)]
pub(crate) struct Qemu;

impl Qemu {
    /// Looks for it. On the build machine it must be there; elsewhere its absence is told.
    pub(crate) fn find() -> Option<Self> {
        match Command::new(PROGRAM).arg("--version").output() {
            Ok(_) => Some(Self),
            Err(error) => {
                assert!(std::env::var_os("CI").is_none(), "{PROGRAM}: {error}");
                println!("skipped: {PROGRAM} is not installed (Debian: apt-get install qemu-user-static)");
                None
            }
        }
    }

    /// Runs a file of Linux for MIPS and gives what it writes.
    pub(crate) fn run(&self, file: &[u8]) -> Vec<u8> {
        let path = temporary();
        std::fs::write(&path, file).expect("a temporary file");
        make_executable(&path);
        let output = Command::new(PROGRAM).args(["-cpu", CORE]).arg(&path).output();
        std::fs::remove_file(&path).expect("the temporary file is ours");
        let output = output.expect("qemu was found");
        assert!(
            output.status.success(),
            "{PROGRAM} ended with {} after {} bytes: {}",
            output.status,
            output.stdout.len(),
            String::from_utf8_lossy(&output.stderr)
        );
        output.stdout
    }
}

fn temporary() -> PathBuf {
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    std::env::temp_dir().join(format!("pic32-{}-{number}", std::process::id()))
}

fn make_executable(path: &PathBuf) {
    use std::os::unix::fs::PermissionsExt;
    let permissions = std::fs::Permissions::from_mode(0o700);
    std::fs::set_permissions(path, permissions).expect("the temporary file is ours");
}
