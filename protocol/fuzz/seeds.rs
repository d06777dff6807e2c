//! Puts the golden packets into the corpora of the fuzz targets: a fuzzer that begins with nothing needs hours to find
//! its first whole packet.

mod golden;

use std::fs;
use std::io;
use std::path::Path;

const TARGETS: [&str; 4] = ["command_text", "report_text", "binary", "sessions"];

fn main() -> io::Result<()> {
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    for target in TARGETS {
        let folder = corpora.join(target);
        fs::create_dir_all(&folder)?;
        for (number, piece) in golden::pieces().iter().enumerate() {
            fs::write(folder.join(format!("golden-{number:03}")), piece)?;
        }
    }
    Ok(())
}
