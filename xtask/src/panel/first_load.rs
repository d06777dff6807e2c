//! What a first visit to the panel brings over the network, read from the packed files.

use crate::process;
use anyhow::Context;
use serde_json::json;
use std::fs;
use std::path::Path;

/// What browsers fetch only when the page goes to a phone's home screen.
const LATER: &str = "apple-touch-icon";

/// Files that the page names and their bytes, packed as a browser takes them.
fn fetched(folder: &Path) -> anyhow::Result<Vec<(String, u64)>> {
    let page_path = folder.join("index.html");
    let page =
        fs::read_to_string(&page_path).with_context(|| format!("cannot read {}", page_path.display()))?;
    let named = page
        .lines()
        .filter(|line| !line.contains(LATER))
        .flat_map(|line| line.split("href=\"").chain(line.split("src=\"")).skip(1))
        .filter_map(|rest| Some(rest.split_once('"')?.0.to_owned()));
    let mut names: Vec<String> = std::iter::once("index.html".to_owned())
        .chain(named)
        .filter(|name| folder.join(name).is_file())
        .collect();
    names.sort();
    names.dedup();
    let sized = |name: String| {
        let packed = folder.join(format!("{name}.br"));
        let bytes = fs::metadata(&packed)
            .with_context(|| format!("cannot read {}", packed.display()))?
            .len();
        Ok((name, bytes))
    };
    names.into_iter().map(sized).collect()
}

/// Prints it as one line of JSON: bytes over the wire with Brotli, and requests.
pub(super) fn print(folder: &Path) -> anyhow::Result<()> {
    let files = fetched(folder)?;
    let bytes: u64 = files.iter().map(|(_, bytes)| bytes).sum();
    process::print(
        &json!({ "first_load_bytes": bytes, "requests": files.len(), "files": files }).to_string(),
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::fetched;
    use std::fs;

    #[test]
    fn the_page_and_what_it_names_is_counted_once() {
        let folder = std::env::temp_dir().join(format!("xtask-first-load-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let page = "<link rel=\"icon\" href=\"a.svg\">\n<link rel=\"modulepreload\" href=\"p.js\">\n\
                    <script src=\"p.js\"></script>\n<link rel=\"apple-touch-icon\" href=\"i.png\">";
        for (name, bytes) in [
            ("index.html", page.as_bytes()),
            ("a.svg", b"1"),
            ("p.js", b"22"),
            ("i.png", b"333"),
        ] {
            fs::write(folder.join(name), bytes).unwrap();
            fs::write(folder.join(format!("{name}.br")), bytes).unwrap();
        }
        let files = fetched(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a.svg", "index.html", "p.js"]);
        assert_eq!(files[2].1, 2);
    }
}
