//! ROS `map_server` maps: a YAML and an image.

use std::path::{Path, PathBuf};

use super::image::{GreyImage, GreyImageError};
use super::{DockWish, Draft, HomeError, ReadError, fit, image, read_limited, stem};
use crate::plan::{Cell, Grid, SurfaceMap};
use crate::pose::Pose;

/// Longest image file.
const IMAGE_BYTES_MAX: u64 = 64 << 20;

/// The keys that `map_server` defines; others are ignored, as it does.
#[derive(Default)]
struct MapYaml {
    image: Option<String>,
    resolution_m: Option<f64>,
    origin: Vec<f64>,
    negate: Option<f64>,
    occupied: Option<f64>,
    free: Option<f64>,
    mode: Option<String>,
}

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

pub(crate) fn read(path: &Path, text: &str) -> Result<Draft, HomeError> {
    let yaml = parse(path, text)?;
    let resolution_m = required(path, yaml.resolution_m, "resolution")?;
    if !(0.002..=1.0).contains(&resolution_m) {
        return Err(invalid(
            path,
            "resolution",
            format!("{resolution_m} must lie between 0.002 and 1 m per pixel"),
        ));
    }
    let thresholds = thresholds(path, &yaml)?;
    let origin = origin(path, &yaml.origin)?;
    let name = required(path, yaml.image.clone(), "image")?;
    let image = load_image(path, &name)?;
    let coarse = Grid {
        cell_m: resolution_m,
        width: image.width,
        height: image.height,
        cells: cells(&image, &thresholds),
    };
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
    })
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

fn thresholds(path: &Path, yaml: &MapYaml) -> Result<Thresholds, HomeError> {
    let occupied = yaml.occupied.unwrap_or(0.65);
    let free = yaml.free.unwrap_or(0.196);
    if !(0.0..=1.0).contains(&occupied) || !(0.0..=1.0).contains(&free) || free > occupied {
        let problem = format!("free_thresh {free} and occupied_thresh {occupied} must rise within 0 to 1");
        return Err(invalid(path, "occupied_thresh", problem));
    }
    let mode = match yaml.mode.as_deref() {
        None | Some("trinary") => MapMode::Trinary,
        Some("scale") => MapMode::Scale,
        Some("raw") => MapMode::Raw,
        Some(other) => {
            let problem = format!("`{other}` is not one of trinary, scale, raw");
            return Err(invalid(path, "mode", problem));
        }
    };
    Ok(Thresholds {
        occupied,
        free,
        negate: yaml.negate.unwrap_or(0.0) != 0.0,
        mode,
    })
}

fn origin(path: &Path, numbers: &[f64]) -> Result<Pose, HomeError> {
    match numbers {
        [] => Ok(Pose::default()),
        [x, y] => Ok(Pose::new(*x, *y, 0.0)),
        [x, y, yaw] => Ok(Pose::new(*x, *y, *yaw)),
        _ => {
            let problem = format!("has {} numbers, but must be [x, y, yaw]", numbers.len());
            Err(invalid(path, "origin", problem))
        }
    }
}

fn load_image(path: &Path, name: &str) -> Result<GreyImage, HomeError> {
    let file: PathBuf = path.parent().unwrap_or(Path::new("")).join(name);
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
    image::decode(&bytes).map_err(|error| match error {
        GreyImageError::Truncated(place) => HomeError::Truncated {
            path: file.clone(),
            place,
        },
        GreyImageError::TooManyPixels(cells, limit) => HomeError::TooManyCells {
            path: file.clone(),
            cells,
            limit,
        },
        GreyImageError::Wrong(place, problem) => HomeError::Invalid {
            path: file.clone(),
            place,
            problem,
        },
    })
}

fn invalid(path: &Path, place: &str, problem: String) -> HomeError {
    HomeError::Invalid {
        path: path.to_owned(),
        place: format!("`{place}`"),
        problem,
    }
}

fn required<T>(path: &Path, value: Option<T>, key: &str) -> Result<T, HomeError> {
    value.ok_or_else(|| {
        invalid(
            path,
            key,
            "it is missing; add it as the map's maker would".to_owned(),
        )
    })
}

/// The flat YAML that map savers write: `key: value` lines, the origin as `[x, y, yaw]` or as `- x` lines.
fn parse(path: &Path, text: &str) -> Result<MapYaml, HomeError> {
    let mut yaml = MapYaml::default();
    let mut in_origin = false;
    for (number, line) in text.lines().enumerate() {
        let line = strip_comment(line);
        let place = |key: &str| format!("{key}` in line {}", number + 1);
        if let Some(item) = line.trim_start().strip_prefix("- ").filter(|_| in_origin) {
            yaml.origin.push(numeral(path, &place("origin"), item)?);
            continue;
        }
        let Some((key, value)) = line.split_once(':') else {
            continue;
        };
        let (key, value) = (key.trim(), value.trim());
        in_origin = key == "origin" && value.is_empty();
        match key {
            "image" => yaml.image = Some(value.trim_matches(['"', '\'']).to_owned()),
            "mode" => yaml.mode = Some(value.trim_matches(['"', '\'']).to_owned()),
            "resolution" => yaml.resolution_m = Some(numeral(path, &place(key), value)?),
            "negate" => yaml.negate = Some(truth(path, &place(key), value)?),
            "occupied_thresh" => yaml.occupied = Some(numeral(path, &place(key), value)?),
            "free_thresh" => yaml.free = Some(numeral(path, &place(key), value)?),
            "origin" if !in_origin => {
                for item in value.trim_matches(['[', ']']).split(',') {
                    yaml.origin.push(numeral(path, &place(key), item)?);
                }
            }
            _ => {}
        }
        if yaml.origin.len() > 3 {
            break;
        }
    }
    Ok(yaml)
}

fn strip_comment(line: &str) -> &str {
    match line.find(" #") {
        Some(end) => &line[..end],
        None if line.trim_start().starts_with('#') => "",
        None => line,
    }
}

fn truth(path: &Path, place: &str, value: &str) -> Result<f64, HomeError> {
    match value {
        "true" => Ok(1.0),
        "false" => Ok(0.0),
        _ => numeral(path, place, value),
    }
}

fn numeral(path: &Path, place: &str, value: &str) -> Result<f64, HomeError> {
    match value.trim().parse::<f64>() {
        Ok(number) if number.is_finite() && number.abs() <= 1e6 => Ok(number),
        _ => Err(HomeError::Invalid {
            path: path.to_owned(),
            place: format!("`{place}"),
            problem: format!("`{}` is not a number of a sensible size", value.trim()),
        }),
    }
}
