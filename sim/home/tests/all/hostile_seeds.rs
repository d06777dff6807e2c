//! Valid files of every loader, and what turns them into files that nobody would write.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use home::Pcg;

use crate::loaders::{YAML, mutate, pgm_of, png_of, valetudo_of};
use crate::scene::{HEAD, room};

/// How large the homes of the seeds are.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum SeedSize {
    /// Just large enough for the robot, so that an answer costs little.
    Tiny,
    /// A room.
    Room,
}

/// A file, and the picture that lies beside it.
pub(crate) struct Seed {
    pub(crate) name: String,
    pub(crate) text: Vec<u8>,
    pub(crate) image: Option<(String, Vec<u8>)>,
}

/// One for each format, and for each format of pictures.
pub(crate) fn seeds(size: SeedSize) -> Vec<Seed> {
    let (prefix, columns, rows) = match size {
        SeedSize::Tiny => ("tiny", 14, 14),
        SeedSize::Room => ("room", 40, 20),
    };
    let plan = match size {
        SeedSize::Tiny => format!("{HEAD}cell-m = 0.025\n{}{THINGS}", room(0.7, 0.7)),
        SeedSize::Room => format!("{HEAD}{}{THINGS}{DOCK}", room(3.0, 3.0)),
    };
    let bare = |ending: &str, text: Vec<u8>| Seed {
        name: format!("{prefix}.{ending}"),
        text,
        image: None,
    };
    let grey = walled(columns, rows);
    let text: String = grey.iter().map(|pixel| format!("{pixel} ")).collect();
    let images = [
        ("p5", pgm_of((columns, rows), &grey)),
        ("p2", format!("P2 {columns} {rows} 255\n{text}").into_bytes()),
        ("png", png_of((columns, rows), &grey, png::ColorType::Grayscale)),
    ];
    let ros = images.map(|(kind, bytes)| {
        let image = format!("{prefix}-{kind}.image");
        Seed {
            name: format!("{prefix}-{kind}.yaml"),
            text: format!("image: {image}\n{YAML}").into_bytes(),
            image: Some((image, bytes)),
        }
    });
    let plain = [
        bare("toml", plan.into_bytes()),
        bare("json", valetudo_of(columns as u32).into_bytes()),
    ];
    plain.into_iter().chain(ros).collect()
}

/// Things of every kind, in the corner of a room, so that the robot still fits beside them.
const THINGS: &str = r#"[[wall]]
from = [0.0, 0.0]
to = [0.06, 0.0]
[[door]]
from = [0.0, 0.05]
to = [0.0, 0.1]
state = "closed"
schedule = [{ at-s = 5.0, state = "open" }]
[[furniture]]
legs = [[0.05, 0.05]]
[[rug]]
polygon = [[0.3, 0.3], [0.5, 0.3], [0.5, 0.5]]
[[threshold]]
from = [0.3, 0.6]
to = [0.5, 0.6]
width-m = 0.02
height-m = 0.005
[[mirror]]
from = [0.0, 0.6]
to = [0.0, 0.7]
[[visitor]]
position = [0.1, 0.1]
diameter-m = 0.1
from-s = 1.0
until-s = 2.0
[[walker]]
kind = "pet"
goals = [[0.3, 0.3], [0.4, 0.4]]
from-s = 1.0
until-s = 9.0
"#;
const DOCK: &str = "[dock]\nposition = [0.0, 1.5]\nheading-deg = 0.0\n";

/// A grey picture of floor with a wall around it, of which one row is unknown.
fn walled(columns: usize, rows: usize) -> Vec<u8> {
    let grey = |index: usize| match (index % columns, index / columns) {
        (_, 0) => 205,
        (column, row) if column == 0 || column + 1 == columns || row + 1 == rows => 0,
        _ => 254,
    };
    (0..columns * rows).map(grey).collect()
}

/// Words that turn one valid file into another, or into one that lies.
const WORDS: [&[u8]; 22] = [
    b"image: ",
    b"resolution: ",
    b"negate: ",
    b"mode: raw",
    b"mode: scale",
    b"&a ",
    b"*a",
    b"[[[[[[[[",
    b"{a: {a: ",
    b"? ",
    b"- ",
    b"|\n",
    b"\r\n",
    b"# ",
    b"65535",
    b"4294967296",
    b"1e308",
    b"-0.0",
    b"[[room]]\n",
    b"\"compressedPixels\":[",
    b"\xef\xbb\xbf",
    b"\x1f\x8b\x08",
];

/// Numbers that a reader may stumble over.
const NUMBERS: [&str; 16] = [
    "0", "1", "2", "3", "-1", "0.0", "-0.0", "0.01", "0.3", "0.5", "1e-320", "1e308", "-1e308", "nan", "inf",
    ".inf",
];
/// Those that make a home large, which takes its time, so they come seldom.
const LARGE_NUMBERS: [&str; 4] = ["255", "1.0", "65536", "18446744073709551616"];
/// Of so many numbers one is large.
const LARGE_EVERY: u32 = 128;

/// Does one to three things to a file of which each alone makes it another file.
pub(crate) fn spoil(seed: &[u8], random: &mut Pcg) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=random.below(3) {
        match random.below(8) {
            0 | 1 => with_number(&mut bytes, random),
            2 => with_line(&mut bytes, random),
            3 | 4 => with_word(&mut bytes, random),
            _ => bytes = mutate(&bytes, random),
        }
    }
    bytes
}

fn with_word(bytes: &mut Vec<u8>, random: &mut Pcg) {
    let place = random.below(bytes.len() as u32 + 1) as usize;
    let word = WORDS[random.below(WORDS.len() as u32) as usize];
    let end = bytes.len().min(place + random.below(12) as usize);
    bytes.splice(place..end, word.iter().copied());
}

/// Another number in the place of the next one.
fn with_number(bytes: &mut Vec<u8>, random: &mut Pcg) {
    let place = random.below(bytes.len() as u32 + 1) as usize;
    let is_of_number = |byte: &u8| byte.is_ascii_digit() || b".-".contains(byte);
    let Some(off) = bytes[place..].iter().position(|byte| byte.is_ascii_digit()) else {
        return;
    };
    let from = place + off;
    let length = bytes[from..].iter().take_while(|byte| is_of_number(byte)).count();
    let numbers = match random.below(LARGE_EVERY) {
        0 => LARGE_NUMBERS.as_slice(),
        _ => NUMBERS.as_slice(),
    };
    let number = numbers[random.below(numbers.len() as u32) as usize];
    bytes.splice(from..from + length, number.bytes());
}

/// A line is left out, comes twice, or comes elsewhere.
fn with_line(bytes: &mut Vec<u8>, random: &mut Pcg) {
    let mut lines: Vec<Vec<u8>> = bytes.split(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    let from = random.below(lines.len() as u32) as usize;
    let to = random.below(lines.len() as u32) as usize;
    match random.below(3) {
        0 => drop(lines.remove(from)),
        1 => lines.insert(to, lines[from].clone()),
        _ => lines.swap(from, to),
    }
    *bytes = lines.join(&b'\n');
}

/// How a file comes.
#[derive(Clone, Copy)]
pub(crate) enum Packing {
    Plain,
    Gzip,
    Zlib,
    /// As the map that a picture of Valetudo carries.
    InPicture,
}

impl Packing {
    /// Most files come plainly.
    pub(crate) fn drawn(random: &mut Pcg) -> Self {
        match random.below(16) {
            0 => Self::Gzip,
            1 => Self::Zlib,
            2 => Self::InPicture,
            _ => Self::Plain,
        }
    }

    pub(crate) fn pack(self, bytes: Vec<u8>) -> Vec<u8> {
        let zlib = |bytes: &[u8]| {
            let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
            packer.write_all(bytes).and_then(|()| packer.finish())
        };
        match self {
            Self::Plain => bytes,
            Self::Gzip => {
                let mut packer = GzEncoder::new(Vec::new(), Compression::fast());
                let packed = packer.write_all(&bytes).and_then(|()| packer.finish());
                packed.expect("memory takes all")
            }
            Self::Zlib => zlib(&bytes).expect("memory takes all"),
            Self::InPicture => {
                let map = zlib(&bytes).expect("memory takes all");
                [b"\x89PNG\r\n\x1a\n\0\0\0\x10zTXtValetudoMap\0\0".as_slice(), &map].concat()
            }
        }
    }
}
