//! Files that nobody would write, against every loader: an answer in time, in bounded memory, without a panic.

use std::io::Write as _;
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use home::{Home, Pcg};

use crate::loaders::{YAML, mutate, pgm, pixels, png_of, valetudo};
use crate::scene::{HEAD, file, folder_of_files, room, sr8730};

/// How long the files come. The count that fits depends on the machine; it must be [`INPUTS_MIN`] at least.
const BUDGET: Duration = Duration::from_secs(20);
/// Most files.
const INPUTS_MAX: u32 = 1_000_000;
/// Fewer than this would show nothing.
const INPUTS_MIN: u32 = 200;
/// An answer takes no more time on the processor than this.
const ANSWER_MAX: Duration = Duration::from_secs(2);
/// The same for a home at the limit of cells.
const LARGEST_ANSWER_MAX: Duration = Duration::from_secs(10);
/// Most memory of the whole program.
const MEMORY_KB_MAX: u64 = 256 << 10;

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

fn with_word(bytes: &mut Vec<u8>, random: &mut Pcg) {
    let place = random.below(bytes.len() as u32 + 1) as usize;
    let word = WORDS[random.below(WORDS.len() as u32) as usize];
    let end = bytes.len().min(place + random.below(12) as usize);
    bytes.splice(place..end, word.iter().copied());
}

/// Time that this thread had on a processor: a busy machine is no fault of a loader.
fn on_processor() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux counts it");
    let nanoseconds = text.split(' ').next().and_then(|first| first.parse().ok());
    Duration::from_nanos(nanoseconds.expect("its first number"))
}

/// Most memory that this program ever had, kB.
fn memory_peak_kb() -> u64 {
    let text = std::fs::read_to_string("/proc/self/status").expect("Linux counts it");
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let number = line.and_then(|rest| rest.trim().split(' ').next()?.parse().ok());
    number.expect("a number of kB")
}

/// The name of a file, its bytes, and those of a picture that lies beside it.
type Seed = (&'static str, Vec<u8>, Option<Vec<u8>>);

/// The seeds: each with the image that it names, if it names one.
fn seeds() -> Vec<Seed> {
    let grey = pixels();
    let yaml = || format!("image: hostile.image\n{YAML}").into_bytes();
    let plan = format!(
        "{HEAD}{}[[furniture]]\nlegs = [[1.0, 1.0]]\n[[wall]]\nfrom = [2.0, 1.0]\nto = [2.0, 2.0]\n[dock]\nposition = [0.0, 1.5]\nheading-deg = 0.0\n",
        room(3.0, 3.0)
    );
    let text: String = grey.iter().map(|pixel| format!("{pixel} ")).collect();
    vec![
        ("hostile.toml", plan.into_bytes(), None),
        ("hostile.json", valetudo().into_bytes(), None),
        ("hostile.yaml", yaml(), Some(pgm(&grey))),
        (
            "hostile.yaml",
            yaml(),
            Some(format!("P2 40 20 255\n{text}").into_bytes()),
        ),
        (
            "hostile.yaml",
            yaml(),
            Some(png_of(&grey, png::ColorType::Grayscale)),
        ),
    ]
}

/// How a file comes.
#[derive(Clone, Copy)]
enum Packing {
    Plain,
    Gzip,
    Zlib,
    /// As the map that a picture of Valetudo carries.
    InPicture,
}

impl Packing {
    /// Half of the files come plainly.
    fn drawn(random: &mut Pcg) -> Self {
        match random.below(6) {
            0 => Self::Gzip,
            1 => Self::Zlib,
            2 => Self::InPicture,
            _ => Self::Plain,
        }
    }

    fn pack(self, bytes: Vec<u8>) -> Vec<u8> {
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

/// What came of many files.
#[derive(Clone, Copy, Debug, Default)]
struct Answers {
    inputs: u32,
    loaded: u32,
    longest: Duration,
}

/// Loads files drawn with a seed, so long and so many at most.
fn attack(seed: u64, budget: Duration, inputs_max: u32) -> Answers {
    let (seeds, robot) = (seeds(), sr8730());
    let folder = format!("hostile-{seed}");
    folder_of_files(&folder);
    let mut random = Pcg::new(38, seed);
    let mut answers = Answers::default();
    let started = Instant::now();
    while answers.inputs < inputs_max && started.elapsed() < budget {
        let (name, text, image) = &seeds[random.below(seeds.len() as u32) as usize];
        let (mut text, mut image) = (text.clone(), image.clone());
        let target = match &mut image {
            Some(image) if random.below(2) == 0 => image,
            _ => &mut text,
        };
        *target = mutate(target, &mut random);
        for _ in 0..random.below(3) {
            with_word(target, &mut random);
        }
        if let Some(image) = image {
            file(&format!("{folder}/hostile.image"), &image);
        }
        let mut packed = Packing::drawn(&mut random).pack(text.clone());
        // Damage to what packs is mostly found at once, so little of it is done.
        if random.below(8) == 0 {
            packed = mutate(&packed, &mut random);
        }
        let path = file(&format!("{folder}/{name}"), &packed);
        let before = on_processor();
        let answer = Home::load(&path, &robot);
        let took = on_processor() - before;
        answers.longest = answers.longest.max(took);
        assert!(
            took < ANSWER_MAX,
            "{took:?} for {:?}",
            String::from_utf8_lossy(&text)
        );
        match answer {
            Ok(home) => {
                answers.loaded += 1;
                assert!(home.reachable_area_m2() > 0.0);
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
        }
        answers.inputs += 1;
    }
    answers
}

#[test]
fn hostile_files_get_an_answer_in_time_and_in_bounded_memory() {
    let answers = attack(15, BUDGET, INPUTS_MAX);
    let peak_kb = memory_peak_kb();
    println!("{answers:?}, memory {peak_kb} kB");
    let Answers { inputs, loaded, .. } = answers;
    assert!(inputs > INPUTS_MIN && loaded > inputs / 50 && loaded < inputs);
    assert!(peak_kb < MEMORY_KB_MAX, "{peak_kb} kB");
}

/// Threads of the million, and its longest time.
const THREADS: u32 = 2;
const LONG_BUDGET: Duration = Duration::from_secs(2 * 60 * 60);

#[test]
#[ignore = "a million files take too long for every run; cargo xtask test --long"]
fn a_million_hostile_files_get_an_answer_in_time_and_in_bounded_memory() {
    let inputs = std::thread::scope(|scope| {
        let threads = (0..THREADS).map(|thread| {
            scope.spawn(move || attack(100 + u64::from(thread), LONG_BUDGET, INPUTS_MAX / THREADS))
        });
        let threads: Vec<_> = threads.collect();
        let answers = threads.into_iter().map(|thread| thread.join().expect("no panic"));
        answers.map(|answers| answers.inputs).sum::<u32>()
    });
    let peak_kb = memory_peak_kb();
    println!("{inputs} files, memory {peak_kb} kB");
    assert_eq!(inputs, INPUTS_MAX);
    assert!(peak_kb < MEMORY_KB_MAX, "{peak_kb} kB");
}

/// A home as large as the limit allows: 70 x 70 m of floor.
#[test]
fn the_largest_home_gets_an_answer_in_bounded_memory() {
    let side = 2_800;
    let mut grey = vec![254; side * side];
    grey[..side].fill(0);
    let mut bytes = format!("P5 {side} {side} 255\n").into_bytes();
    bytes.extend(&grey);
    file("largest.pgm", &bytes);
    let yaml = format!("image: largest.pgm\n{}", YAML.replace("0.05", "0.025"));
    let path = file("largest.yaml", yaml.as_bytes());
    let before = on_processor();
    let home = Home::load(&path, &sr8730()).unwrap();
    let took = on_processor() - before;
    let peak_kb = memory_peak_kb();
    println!("{} m2 in {took:?}, memory {peak_kb} kB", home.free_area_m2());
    assert!(
        took < LARGEST_ANSWER_MAX && peak_kb < MEMORY_KB_MAX,
        "{took:?}, {peak_kb} kB"
    );
}
