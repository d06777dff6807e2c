//! The files of the packed panel, named by their content.

use std::fs;
use std::num::NonZeroU64;
use std::path::Path;

use anyhow::{Context, Result, bail};
use brotli::enc::BrotliEncoderParams;
use zopfli::{Format, Options};

/// Files in the order they were added.
#[derive(Debug, Default)]
pub(crate) struct Bundle {
    files: Vec<File>,
}

#[derive(Debug)]
struct File {
    name: String,
    plain: Vec<u8>,
    gzip: Vec<u8>,
    brotli: Vec<u8>,
}

impl Bundle {
    /// Adds a file and returns the name it got: `panel.css` becomes `panel-0123456789abcdef.css`.
    pub(crate) fn add(&mut self, name: &str, content: Vec<u8>) -> String {
        let named = hashed(name, fnv1a_64(&content));
        self.push(named.clone(), content);
        named
    }

    /// Adds two scripts that import each other as `./panel.js`, and returns the names they got. Either changes with the content
    /// of both.
    pub(crate) fn add_bound(&mut self, scripts: [(&str, String); 2]) -> Result<[String; 2]> {
        let [(first, first_text), (second, second_text)] = scripts;
        let hash = fnv1a_64(format!("{first_text}{second_text}").as_bytes());
        let [first_name, second_name] = [first, second].map(|name| hashed(name, hash));
        let first_text = renamed(&first_text, second, &second_name).context(first.to_owned())?;
        let second_text = renamed(&second_text, first, &first_name).context(second.to_owned())?;
        self.push(first_name.clone(), first_text.into_bytes());
        self.push(second_name.clone(), second_text.into_bytes());
        Ok([first_name, second_name])
    }

    /// Adds a file that keeps its name.
    pub(crate) fn add_named(&mut self, name: &str, content: Vec<u8>) {
        self.push(name.to_owned(), content);
    }

    /// Tells these files from all others.
    pub(crate) fn version(&self) -> String {
        let all: Vec<u8> = self.files.iter().flat_map(|file| file.plain.clone()).collect();
        format!("{:016x}", fnv1a_64(&all))
    }

    /// Name of each file, and its bytes: plain, as gzip, as Brotli.
    pub(crate) fn sizes(&self) -> impl Iterator<Item = (&str, [usize; 3])> {
        self.files.iter().map(|file| {
            let sizes = [&file.plain, &file.gzip, &file.brotli].map(Vec::len);
            (file.name.as_str(), sizes)
        })
    }

    /// Writes all files and their packed twins into an existing folder.
    pub(crate) fn write(&self, folder: &Path) -> Result<()> {
        for file in &self.files {
            for (ending, bytes) in [("", &file.plain), (".gz", &file.gzip), (".br", &file.brotli)] {
                let path = folder.join(format!("{}{ending}", file.name));
                fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
            }
        }
        Ok(())
    }

    fn push(&mut self, name: String, plain: Vec<u8>) {
        let (gzip, brotli) = (gzip(&plain), brotli(&plain));
        self.files.push(File {
            name,
            plain,
            gzip,
            brotli,
        });
    }
}

fn hashed(name: &str, hash: u64) -> String {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, "bin"));
    format!("{stem}-{hash:016x}.{ending}")
}

/// The script with the new name of what it imports.
fn renamed(text: &str, import: &str, name: &str) -> Result<String> {
    let statement = |name: &str| format!("from \"./{name}\"");
    if !text.contains(&statement(import)) {
        bail!("the script has no import {}", statement(import));
    }
    Ok(text.replace(&statement(import), &statement(name)))
}

/// Rounds of the search for short codes; more than this save a thousandth.
const ROUNDS: NonZeroU64 = NonZeroU64::new(3).expect("is not zero");

/// The same bytes give the same archive: no time stamp, no name.
fn gzip(plain: &[u8]) -> Vec<u8> {
    let options = Options {
        iteration_count: ROUNDS,
        ..Options::default()
    };
    let mut packed = Vec::new();
    zopfli::compress(options, Format::Gzip, plain, &mut packed).expect("writing to memory does not fail");
    packed
}

/// A quarter smaller than gzip. Browsers take it over HTTPS and from their own computer.
fn brotli(plain: &[u8]) -> Vec<u8> {
    let parameters = BrotliEncoderParams {
        quality: 11,
        lgwin: 22,
        size_hint: plain.len(),
        ..BrotliEncoderParams::default()
    };
    let mut packed = Vec::new();
    brotli::BrotliCompress(&mut &*plain, &mut packed, &parameters).expect("writing to memory does not fail");
    packed
}

/// Fowler-Noll-Vo 1a, 64 bits. It tells versions apart and guards against nothing.
fn fnv1a_64(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::{Bundle, fnv1a_64};

    #[test]
    fn hash_is_the_published_one() {
        assert_eq!(fnv1a_64(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a_64(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn names_follow_the_content() {
        let mut bundle = Bundle::default();
        let first = bundle.add("panel.css", b"a".to_vec());
        assert_ne!(first, bundle.add("panel.css", b"b".to_vec()));
        assert_eq!(first, bundle.add("panel.css", b"a".to_vec()));
        assert!(first.starts_with("panel-") && first.ends_with(".css"));
    }

    #[test]
    fn scripts_that_import_each_other_find_each_other() {
        let mut bundle = Bundle::default();
        let scripts = |body: &str| {
            let first = "import * as late from \"./late.js\"; f({ \"./late.js\": late })".to_owned();
            [
                ("panel.js", first),
                ("late.js", format!("import x from \"./panel.js\"; {body}")),
            ]
        };
        let [name, late] = bundle.add_bound(scripts("a")).unwrap();
        let texts: Vec<String> = bundle
            .files
            .iter()
            .map(|file| String::from_utf8_lossy(&file.plain).into_owned())
            .collect();
        // The module inside asks for it by the old name.
        assert_eq!(
            texts[0],
            format!("import * as late from \"./{late}\"; f({{ \"./late.js\": late }})")
        );
        assert!(texts[1].contains(&format!("\"./{name}\"")));
        assert_ne!(name, bundle.add_bound(scripts("b")).unwrap()[0]);
        assert!(
            bundle
                .add_bound([("panel.js", String::new()), ("late.js", String::new())])
                .is_err()
        );
    }
}
