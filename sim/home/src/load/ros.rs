//! ROS `map_server` maps: a YAML and an image.

use std::path::{Path, PathBuf};

use super::image::{GreyImage, GreyImageError};
use super::map_yaml::{MapYaml, shortened};
use super::{DockWish, Draft, HomeError, HomeNotice, ReadError, fit, image, read_limited, stem, stray};
use crate::plan::{Cell, Grid, SurfaceMap};
use crate::pose::Pose;

/// Longest image file.
const IMAGE_BYTES_MAX: u64 = 64 << 20;

/// How grey becomes floor.
struct Thresholds {
    occupied: f64,
    free: f64,
    negate: bool,
    mode: MapMode,
}

#[derive(Clone, Copy, PartialEq)]
enum MapMode {
    Trinary,
    Scale,
    Raw,
}

/// The greys that map savers write where nothing is known, and for floor.
const UNKNOWN_GREY: u8 = 205;
const FLOOR_GREY: u8 = 254;
/// Share of a picture with these greys from which a map saver has made it.
const SAVER_SHARE: f64 = 0.5;
/// Share of a picture from which one grey is suspicious. The wide canvas of a mapper leaves more than this to rooms.
const ONE_GREY_SHARE: f64 = 0.999;
/// Share of the picture's edge from which floor there is told: a beam through a window touches it as well.
const EDGE_SHARE: f64 = 0.02;

pub(crate) fn read(path: &Path, text: &str) -> Result<Draft, HomeError> {
    let yaml = MapYaml::parse(path, text)?;
    let resolution_m = yaml.number("resolution", "0.05")?;
    if !(0.002..=1.0).contains(&resolution_m) {
        return Err(yaml.invalid(
            "resolution",
            format!("{resolution_m} must lie between 0.002 and 1 m per pixel; write metres, as 0.05"),
        ));
    }
    let thresholds = thresholds(&yaml)?;
    let origin = origin(&yaml)?;
    let found = load_image(path, &yaml)?;
    let mut coarse = Grid {
        cell_m: resolution_m,
        width: found.image.width,
        height: found.image.height,
        cells: cells(&found.image, &thresholds),
    };
    if !coarse.cells.iter().any(|cell| cell.is_floor()) {
        return Err(no_floor(&yaml, &found, &thresholds));
    }
    let mut notices = notices(path, &found, &thresholds, &coarse);
    notices.extend(stray::leave_out(path, &mut coarse));
    let (grid, x_m, y_m) = fit(path, &coarse)?;
    Ok(Draft {
        name: stem(path),
        rooms: None,
        grid,
        file_from_plan: origin.then(Pose::new(x_m, y_m, 0.0)),
        dock: DockWish::Anywhere,
        surfaces: SurfaceMap::hard(),
        doors: Vec::new(),
        mirrors: Vec::new(),
        walkers: Vec::new(),
        start: None,
        notices,
    })
}

/// How often each grey occurs; transparent pixels count nowhere.
fn histogram(image: &GreyImage) -> [usize; 256] {
    let mut counts = [0; 256];
    for grey in image.pixels.iter().flatten() {
        if let Some(count) = counts.get_mut(usize::from(*grey)) {
            *count += 1;
        }
    }
    counts
}

/// The grey that most pixels have, and its share of all.
fn commonest(counts: [usize; 256], image: &GreyImage) -> (u8, f64) {
    let (grey, count) = (0..=u8::MAX)
        .zip(counts)
        .max_by_key(|(_, count)| *count)
        .unwrap_or_default();
    (grey, count as f64 / image.pixels.len().max(1) as f64)
}

fn no_floor(yaml: &MapYaml<'_>, found: &FoundImage, thresholds: &Thresholds) -> HomeError {
    let (grey, share) = commonest(histogram(&found.image), &found.image);
    let counts = if share > 0.0 {
        format!("{:.1} % of its pixels have the grey {grey}", share * 100.0)
    } else {
        "all of its pixels are transparent".to_owned()
    };
    let remedy = match thresholds.mode {
        MapMode::Raw => {
            "in `mode: raw` floor has the greys 0 to 49; write `mode: trinary` for a picture of a map saver"
        }
        _ if thresholds.negate => "with `negate: 1` floor is dark; look at `negate` and `free_thresh`",
        _ => "floor is light; look at `negate` and `free_thresh`",
    };
    yaml.invalid(
        "image",
        format!("{} has no floor at all: {counts}; {remedy}", found.path.display()),
    )
}

/// What this map may mean otherwise than its maker thinks.
fn notices(path: &Path, found: &FoundImage, thresholds: &Thresholds, coarse: &Grid) -> Vec<HomeNotice> {
    let path = path.to_owned();
    let mut notices = Vec::new();
    if let Some(named) = &found.named {
        notices.push(HomeNotice::ImageBeside {
            path: path.clone(),
            named: shortened(named),
            image: found.path.clone(),
        });
    }
    let counts = histogram(&found.image);
    let (grey, share) = commonest(counts, &found.image);
    if share > ONE_GREY_SHARE {
        notices.push(HomeNotice::NearlyOneGrey {
            path: found.path.clone(),
            grey,
            share,
        });
    }
    notices.extend(saver_greys(&path, found, thresholds, coarse));
    let pixels = counts.iter().take(255).skip(101).sum();
    if thresholds.mode == MapMode::Raw && pixels > 0 {
        notices.push(HomeNotice::NotRaw {
            path: path.clone(),
            pixels,
        });
    }
    let share = floor_share_of_edge(coarse);
    if share > EDGE_SHARE {
        notices.push(HomeNotice::FloorAtEdge { path, share });
    }
    notices
}

/// What becomes of the greys of a map saver, if it is not what the saver meant by them.
fn saver_greys(
    path: &Path,
    found: &FoundImage,
    thresholds: &Thresholds,
    coarse: &Grid,
) -> Option<HomeNotice> {
    let counts = histogram(&found.image);
    let count = |grey: u8| counts.get(usize::from(grey)).copied().unwrap_or(0);
    let unknown = count(UNKNOWN_GREY);
    if unknown == 0 || thresholds.mode == MapMode::Raw {
        return None;
    }
    if thresholds.negate {
        let share = (unknown + count(FLOOR_GREY)) as f64 / found.image.pixels.len().max(1) as f64;
        return (share > SAVER_SHARE).then(|| HomeNotice::NegatedSaver {
            path: path.to_owned(),
            share,
        });
    }
    if !thresholds.cell(Some(UNKNOWN_GREY)).is_floor() {
        return None;
    }
    let floor = coarse.cells.iter().filter(|cell| cell.is_floor()).count();
    let shade = f64::from(255 - UNKNOWN_GREY) / 255.0;
    Some(HomeNotice::UnknownIsFloor {
        path: path.to_owned(),
        free_thresh: thresholds.free,
        by_scale: thresholds.mode == MapMode::Scale && shade >= thresholds.free,
        known_m2: (floor - unknown.min(floor)) as f64 * coarse.cell_area_m2(),
        floor_m2: floor as f64 * coarse.cell_area_m2(),
    })
}

fn floor_share_of_edge(grid: &Grid) -> f64 {
    let at_edge = |index: usize| {
        let (column, row) = (index % grid.width, index / grid.width);
        column == 0 || row == 0 || column + 1 == grid.width || row + 1 == grid.height
    };
    let edge = grid.cells.iter().enumerate().filter(|(index, _)| at_edge(*index));
    let (mut all, mut floor) = (0, 0);
    for (_, cell) in edge {
        all += 1;
        floor += usize::from(cell.is_floor());
    }
    floor as f64 / all.max(1) as f64
}

/// Image rows run downward from the top; ours run upward.
fn cells(image: &GreyImage, thresholds: &Thresholds) -> Vec<Cell> {
    image
        .pixels
        .chunks_exact(image.width)
        .rev()
        .flatten()
        .map(|pixel| thresholds.cell(*pixel))
        .collect()
}

impl Thresholds {
    fn cell(&self, pixel: Option<u8>) -> Cell {
        let Some(grey) = pixel else {
            return Cell::Outside;
        };
        if self.mode == MapMode::Raw {
            return match grey {
                0..=49 => Cell::Floor,
                50..=100 => Cell::Obstacle,
                _ => Cell::Outside,
            };
        }
        let shade = if self.negate { grey } else { 255 - grey };
        let occupied = f64::from(shade) / 255.0;
        if occupied > self.occupied {
            Cell::Obstacle
        } else if occupied < self.free {
            Cell::Floor
        } else if self.mode == MapMode::Trinary {
            Cell::Outside
        } else if occupied < 0.5 * (self.occupied + self.free) {
            Cell::Floor
        } else {
            Cell::Obstacle
        }
    }
}

fn thresholds(yaml: &MapYaml<'_>) -> Result<Thresholds, HomeError> {
    let occupied = yaml.number("occupied_thresh", "0.65")?;
    let free = yaml.number("free_thresh", "0.196")?;
    if !(0.0..=1.0).contains(&occupied) || !(0.0..=1.0).contains(&free) || free > occupied {
        let problem = format!(
            "free_thresh {free} and occupied_thresh {occupied} must rise within 0 to 1; savers write 0.196 and 0.65"
        );
        return Err(yaml.invalid("occupied_thresh", problem));
    }
    let mode = match yaml.optional("mode", "trinary")? {
        None | Some("trinary") => MapMode::Trinary,
        Some("scale") => MapMode::Scale,
        Some("raw") => MapMode::Raw,
        Some(other) => {
            let problem = format!(
                "`{}` is not one of trinary, scale, raw; write one of them",
                shortened(other)
            );
            return Err(yaml.invalid("mode", problem));
        }
    };
    Ok(Thresholds {
        occupied,
        free,
        negate: yaml.truth("negate")?,
        mode,
    })
}

fn origin(yaml: &MapYaml<'_>) -> Result<Pose, HomeError> {
    match yaml.numbers("origin", "[0.0, 0.0, 0.0]")?.as_slice() {
        [x, y, yaw] => Ok(Pose::new(*x, *y, *yaw)),
        numbers => {
            let problem = format!("it has {} numbers; write three: [x, y, yaw]", numbers.len());
            Err(yaml.invalid("origin", problem))
        }
    }
}

/// An image, and where it lay.
struct FoundImage {
    path: PathBuf,
    image: GreyImage,
    /// What the YAML names, if the image was elsewhere.
    named: Option<String>,
}

/// The file that `image:` names: from the folder of the YAML, from `~`, or as a `file://` address.
fn image_file(path: &Path, name: &str) -> PathBuf {
    let address = name.strip_prefix("file://");
    let name = match address {
        Some(address) => without_percents(address.strip_prefix("localhost").unwrap_or(address)),
        None => name.to_owned(),
    };
    match (name.strip_prefix("~/"), std::env::home_dir()) {
        (Some(rest), Some(folder)) => folder.join(rest),
        _ => path.parent().unwrap_or(Path::new("")).join(name),
    }
}

/// An address with the bytes that it writes as `%20`. What is no such byte stays.
fn without_percents(address: &str) -> String {
    let mut bytes = Vec::with_capacity(address.len());
    let mut rest = address.as_bytes();
    while let Some((first, behind)) = rest.split_first() {
        let digits = behind
            .get(..2)
            .and_then(|digits| std::str::from_utf8(digits).ok());
        let byte = digits.filter(|_| *first == b'%').and_then(|digits| {
            let is_hex = digits.bytes().all(|digit| digit.is_ascii_hexdigit());
            is_hex.then(|| u8::from_str_radix(digits, 16).ok()).flatten()
        });
        bytes.push(byte.unwrap_or(*first));
        rest = behind
            .get(if byte.is_some() { 2 } else { 0 }..)
            .unwrap_or_default();
    }
    String::from_utf8(bytes).unwrap_or_else(|_| address.to_owned())
}

/// The last part of a name in the spelling of any system: `C:\maps\flat.pgm` as well.
fn last_part(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

fn load_image(path: &Path, yaml: &MapYaml<'_>) -> Result<FoundImage, HomeError> {
    let name = yaml.text("image", "map.pgm")?;
    if name.trim().is_empty() || name.contains(['\0', '\n']) {
        return Err(yaml.invalid("image", "it names no file; write `image: map.pgm`".to_owned()));
    }
    let named = image_file(path, name);
    // A name with its folder is often written as seen from elsewhere: `maps/flat.pgm` in `maps/flat.yaml`.
    let last = last_part(name);
    let beside = path.with_file_name(last);
    let is_beside = !last.is_empty() && !named.exists() && beside.is_file();
    let (file, named) = if is_beside {
        (beside, Some(name.to_owned()))
    } else {
        (named, None)
    };
    let bytes = read_limited(&file, IMAGE_BYTES_MAX).map_err(|error| match error {
        ReadError::TooLong(bytes) => HomeError::TooLong {
            path: file.clone(),
            bytes,
            limit: IMAGE_BYTES_MAX,
        },
        ReadError::Io(cause) => HomeError::ImageMissing {
            yaml: path.to_owned(),
            image: file.clone(),
            cause,
        },
    })?;
    match image::decode(&bytes) {
        Ok(image) => Ok(FoundImage {
            path: file,
            image,
            named,
        }),
        Err(error) => Err(image_error(file, error)),
    }
}

fn image_error(path: PathBuf, error: GreyImageError) -> HomeError {
    match error {
        GreyImageError::Truncated(place) => HomeError::Truncated { path, place },
        GreyImageError::TooManyPixels(cells, limit) => HomeError::TooManyCells { path, cells, limit },
        GreyImageError::Wrong(place, problem) => HomeError::Invalid { path, place, problem },
    }
}
