//! The packed panel, read once into memory.
//!
//! A request names a key of a table and never a path of the disk, so there is nothing to traverse.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use axum::body::{Body, Bytes};
use axum::http::{HeaderMap, HeaderValue, Response, StatusCode, header};

/// A packed panel has about 1 MiB; more than this is another folder named by mistake.
const TOTAL_BYTES_MAX: u64 = 64 << 20;

/// Why the packed panel cannot be served.
#[derive(Debug, thiserror::Error)]
pub enum AssetsError {
    /// The folder or a file in it cannot be read.
    #[error(
        "cannot read the panel's files in {path}: {source}; pack them first (clients/panel/BUILD.md) or correct --assets"
    )]
    Read {
        /// Folder or file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// There is no page in the folder.
    #[error("no index.html in {0}: pack the panel first (clients/panel/BUILD.md) or correct --assets")]
    NoPage(PathBuf),
    /// The folder is not a packed panel.
    #[error("{0} holds more than 64 MiB, which is not a packed panel: correct --assets")]
    TooLarge(PathBuf),
}

/// The files by request path.
#[derive(Clone, Debug)]
pub struct Assets {
    files: BTreeMap<String, File>,
}

#[derive(Clone, Debug)]
struct File {
    plain: Bytes,
    gzip: Option<Bytes>,
    brotli: Option<Bytes>,
    media_type: &'static str,
    cache: &'static str,
}

impl Assets {
    /// Reads the regular files of `folder`; `x.gz` and `x.br` are the packed twins of `x`.
    ///
    /// # Errors
    /// When the folder cannot be read or is not a packed panel.
    pub fn read(folder: &Path) -> Result<Self, AssetsError> {
        let failed = |path: &Path, source| AssetsError::Read {
            path: path.to_owned(),
            source,
        };
        let mut found = BTreeMap::new();
        let mut total = 0;
        for entry in fs::read_dir(folder).map_err(|e| failed(folder, e))? {
            let path = entry.map_err(|e| failed(folder, e))?.path();
            let facts = fs::metadata(&path).map_err(|e| failed(&path, e))?;
            let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
                continue;
            };
            if !facts.is_file() {
                continue;
            }
            total += facts.len();
            if total > TOTAL_BYTES_MAX {
                return Err(AssetsError::TooLarge(folder.to_owned()));
            }
            found.insert(
                name.to_owned(),
                Bytes::from(fs::read(&path).map_err(|e| failed(&path, e))?),
            );
        }
        if !found.contains_key("index.html") {
            return Err(AssetsError::NoPage(folder.to_owned()));
        }
        Ok(Self { files: table(&found) })
    }

    /// The answer to a GET of `path`.
    #[must_use]
    pub fn answer(&self, path: &str, request: &HeaderMap) -> Response<Body> {
        let Some(file) = self.files.get(path) else {
            return not_found();
        };
        let twins = [("br", &file.brotli), ("gzip", &file.gzip)];
        let packed = twins
            .into_iter()
            .filter(|(coding, _)| accepts(request, coding))
            .find_map(|(coding, bytes)| Some((coding, bytes.as_ref()?)));
        let bytes = packed.map_or(&file.plain, |(_, bytes)| bytes);
        let mut response = Response::new(Body::from(bytes.clone()));
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(file.media_type));
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static(file.cache));
        if file.gzip.is_some() || file.brotli.is_some() {
            headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
        }
        if let Some((coding, _)) = packed {
            headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static(coding));
        }
        response
    }
}

fn table(found: &BTreeMap<String, Bytes>) -> BTreeMap<String, File> {
    let mut files = BTreeMap::new();
    for (name, plain) in found {
        let Some(media_type) = media_type(name) else {
            continue;
        };
        let page = name == "index.html";
        // All other names carry a hash of their content.
        let cache = if page || name == "sw.js" {
            "no-cache"
        } else {
            "public, max-age=31536000, immutable"
        };
        let gzip = found.get(&format!("{name}.gz")).cloned();
        let brotli = found.get(&format!("{name}.br")).cloned();
        let key = if page { "/".to_owned() } else { format!("/{name}") };
        files.insert(
            key,
            File {
                plain: plain.clone(),
                gzip,
                brotli,
                media_type,
                cache,
            },
        );
    }
    files
}

fn media_type(name: &str) -> Option<&'static str> {
    match name.rsplit_once('.')?.1 {
        "html" => Some("text/html; charset=utf-8"),
        "css" => Some("text/css; charset=utf-8"),
        "js" => Some("text/javascript; charset=utf-8"),
        "wasm" => Some("application/wasm"),
        "svg" => Some("image/svg+xml"),
        "png" => Some("image/png"),
        "webmanifest" => Some("application/manifest+json"),
        _ => None,
    }
}

fn accepts(request: &HeaderMap, wanted: &str) -> bool {
    request
        .get_all(header::ACCEPT_ENCODING)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .any(|value| {
            value.split(',').any(|offer| {
                let (coding, quality) = offer.split_once(';').unwrap_or((offer, ""));
                coding.trim() == wanted && !quality.trim().ends_with("q=0")
            })
        })
}

fn not_found() -> Response<Body> {
    let mut response = Response::new(Body::from(
        "There is nothing at this address; the panel is at /.\n",
    ));
    *response.status_mut() = StatusCode::NOT_FOUND;
    response.headers_mut().insert(
        header::CONTENT_TYPE,
        HeaderValue::from_static("text/plain; charset=utf-8"),
    );
    response
}
