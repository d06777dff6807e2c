//! What a home file that loads may mean otherwise than its maker thinks.

use std::fmt;
use std::path::PathBuf;

/// Something about a home that is told before a robot drives in it: the file loads, but perhaps not as meant.
#[derive(Clone, Debug, PartialEq)]
pub enum HomeNotice {
    /// The thresholds take the grey for floor that map savers write where nothing is known.
    UnknownIsFloor {
        /// The YAML.
        path: PathBuf,
        /// Its `free_thresh`.
        free_thresh: f64,
        /// Whether `mode: scale` makes floor of it.
        by_scale: bool,
        /// Floor without that grey, square metres.
        known_m2: f64,
        /// Floor as the file is loaded, square metres.
        floor_m2: f64,
    },
    /// `negate: 1` over a picture with the greys of a map saver, which belong to `negate: 0`.
    NegatedSaver {
        /// The YAML.
        path: PathBuf,
        /// Share of the picture that has them, 0 to 1.
        share: f64,
    },
    /// Floor reaches the edge of the picture, so no wall closes it there.
    FloorAtEdge {
        /// The file.
        path: PathBuf,
        /// Share of the edge that is floor, 0 to 1.
        share: f64,
    },
    /// Nearly all of the picture is one grey.
    NearlyOneGrey {
        /// The picture.
        path: PathBuf,
        /// The grey.
        grey: u8,
        /// Its share, 0 to 1.
        share: f64,
    },
    /// The picture has greys that `mode: raw` does not know.
    NotRaw {
        /// The YAML.
        path: PathBuf,
        /// Pixels of 101 to 254.
        pixels: usize,
    },
    /// Crumbs of floor far away from the rest were left out.
    Strays {
        /// The file.
        path: PathBuf,
        /// How many there are.
        count: usize,
        /// Distance of the farthest, metres.
        farthest_m: f64,
    },
    /// The image was not where the YAML says, but beside it.
    ImageBeside {
        /// The YAML.
        path: PathBuf,
        /// What `image:` says.
        named: String,
        /// What was loaded.
        image: PathBuf,
    },
}

impl fmt::Display for HomeNotice {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownIsFloor {
                path,
                free_thresh,
                by_scale,
                known_m2,
                floor_m2,
            } => {
                let (taker, remedy) = if *by_scale {
                    ("`mode: scale`".to_owned(), "`mode: trinary`")
                } else {
                    (format!("`free_thresh: {free_thresh}`"), "`free_thresh: 0.196`")
                };
                write!(
                    out,
                    "{taker} in {} takes grey 205 for floor, which map savers write where nothing is known: {floor_m2:.1} m2 of floor instead of {known_m2:.1} m2; write {remedy} unless that is meant",
                    path.display()
                )
            }
            Self::NegatedSaver { path, share } => write!(
                out,
                "`negate: 1` in {} takes dark for floor, but {:.0} % of the picture have the greys 205 and 254 of a map saver, whose floor is light; write `negate: 0` unless that is meant",
                path.display(),
                share * 100.0
            ),
            Self::FloorAtEdge { path, share } => write!(
                out,
                "floor lies along {:.0} % of the edge of the picture of {}, where no wall closes it; look at `negate` and the thresholds, or draw the walls",
                share * 100.0,
                path.display()
            ),
            Self::NearlyOneGrey { path, grey, share } => write!(
                out,
                "{:.2} % of the pixels of {} have the grey {grey}; look whether it is the picture of the map",
                share * 100.0,
                path.display()
            ),
            Self::NotRaw { path, pixels } => write!(
                out,
                "`mode: raw` in {} knows greys of 0 to 100 and 255, but {pixels} pixels have others and count as unknown; write `mode: trinary` unless that is meant",
                path.display()
            ),
            Self::Strays {
                path,
                count,
                farthest_m,
            } => write!(
                out,
                "{count} crumbs of floor in {}, up to {farthest_m:.0} m from the rest, were left out; wipe them from the map",
                path.display()
            ),
            Self::ImageBeside { path, named, image } => write!(
                out,
                "`image: {named}` in {} is not there; {} beside it was taken; correct `image:`",
                path.display(),
                image.display()
            ),
        }
    }
}
