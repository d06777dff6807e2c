//! Files that nobody would write, against every loader: an answer in time, in bounded memory, without a panic.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use home::{Home, HomeError, Pcg, RobotModel};

use crate::hostile_seeds::{Packing, Seed, SeedSize, seeds, spoil};
use crate::loaders::{YAML, mutate};
use crate::scene::{file, sr8730};

/// Files of one test. Each of the two tests has a seed of its own and half of the million.
const INPUTS: u32 = 500_000;
/// Of so many files one is of a whole room, which costs fifty times as much.
const ROOM_EVERY: u32 = 1_000;
/// An answer takes no more time on the processor than this.
const ANSWER_MAX: Duration = Duration::from_secs(2);
/// The same for a home at the limit of cells.
const LARGEST_ANSWER_MAX: Duration = Duration::from_secs(10);
/// Most memory of the whole program.
const MEMORY_KB_MAX: u64 = 256 << 10;

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

/// A folder of one attack, in memory where the system has one: a disk would take longer than a loader.
struct Folder(PathBuf);

impl Folder {
    fn new(seed: u64) -> Self {
        let memory = Path::new("/dev/shm");
        let parent = match memory.is_dir() {
            true => memory,
            false => Path::new(env!("CARGO_TARGET_TMPDIR")),
        };
        let path = parent.join(format!("hostile-{}-{seed}", std::process::id()));
        std::fs::create_dir_all(&path).expect("the folder of test files takes folders");
        Self(path)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).expect("the folder of test files takes them");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Loads a file, and gives the time that it took. Who seems to be late has another try, by the clock of the processor.
fn answer(path: &Path, robot: &RobotModel) -> (Result<Home, HomeError>, Duration) {
    let begun = Instant::now();
    let answer = Home::load(path, robot);
    let took = begun.elapsed();
    if took < ANSWER_MAX {
        return (answer, took);
    }
    let before = on_processor();
    let answer = Home::load(path, robot);
    (answer, on_processor() - before)
}

/// What came of many files.
#[derive(Clone, Copy, Debug, Default)]
struct Answers {
    inputs: u32,
    loaded: u32,
    longest: Duration,
}

impl Answers {
    fn take(&mut self, (answer, took): (Result<Home, HomeError>, Duration)) {
        self.inputs += 1;
        self.longest = self.longest.max(took);
        match answer {
            Ok(home) => {
                self.loaded += 1;
                assert!(home.reachable_area_m2() > 0.0);
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
        }
    }
}

/// Files drawn with a seed.
struct Attack {
    folder: Folder,
    robot: RobotModel,
    random: Pcg,
}

impl Attack {
    fn new(seed: u64) -> Self {
        Self {
            folder: Folder::new(seed),
            robot: sr8730(),
            random: Pcg::new(38, seed),
        }
    }

    /// Lays a file down that nobody would write, and gives its place. The picture beside it, or the text that names the picture, is right.
    fn lay(&mut self, seed: &Seed) -> PathBuf {
        let (folder, random) = (&self.folder, &mut self.random);
        match &seed.image {
            Some((name, image)) if random.below(2) == 0 => {
                folder.write(name, &spoil(image, random));
                return folder.write(&seed.name, &seed.text);
            }
            Some((name, image)) => {
                folder.write(name, image);
            }
            None => {}
        }
        let mut packed = Packing::drawn(random).pack(spoil(&seed.text, random));
        // Damage to what packs is mostly found at once, so little of it is done.
        if random.below(8) == 0 {
            packed = mutate(&packed, random);
        }
        folder.write(&seed.name, &packed)
    }

    /// Loads so many files, of which one of `room_every` is of a whole room.
    fn run(&mut self, inputs: u32, room_every: u32) -> Answers {
        let (tiny, rooms) = (seeds(SeedSize::Tiny), seeds(SeedSize::Room));
        let mut answers = Answers::default();
        for number in 0..inputs {
            let among = match number % room_every {
                0 => &rooms,
                _ => &tiny,
            };
            let seed = &among[self.random.below(among.len() as u32) as usize];
            let path = self.lay(seed);
            let (answer, took) = answer(&path, &self.robot);
            assert!(
                took < ANSWER_MAX,
                "{took:?} for {:?}",
                std::fs::read(&path).map(|text| String::from_utf8_lossy(&text).into_owned())
            );
            answers.take((answer, took));
        }
        answers
    }
}

/// Half of the million.
fn half_a_million(seed: u64) {
    let answers = Attack::new(seed).run(INPUTS, ROOM_EVERY);
    let peak_kb = memory_peak_kb();
    println!("{answers:?}, memory {peak_kb} kB");
    let Answers { inputs, loaded, .. } = answers;
    assert!(loaded > inputs / 50 && loaded < inputs);
    assert!(peak_kb < MEMORY_KB_MAX, "{peak_kb} kB");
}

#[test]
fn hostile_files_get_an_answer_in_time_and_in_bounded_memory() {
    half_a_million(15);
}

#[test]
fn other_hostile_files_get_an_answer_in_time_and_in_bounded_memory() {
    half_a_million(16);
}

/// Threads of the million, and of their files one of so many is of a whole room.
const THREADS: u32 = 2;
const LONG_INPUTS: u32 = 1_000_000;
const LONG_ROOM_EVERY: u32 = 1;

#[test]
#[ignore = "a million files of whole rooms take too long for every run; cargo xtask test --long"]
fn a_million_hostile_files_get_an_answer_in_time_and_in_bounded_memory() {
    let inputs = std::thread::scope(|scope| {
        let threads = (0..THREADS).map(|thread| {
            let mut attack = Attack::new(100 + u64::from(thread));
            scope.spawn(move || attack.run(LONG_INPUTS / THREADS, LONG_ROOM_EVERY))
        });
        let threads: Vec<_> = threads.collect();
        let answers = threads.into_iter().map(|thread| thread.join().expect("no panic"));
        answers.map(|answers| answers.inputs).sum::<u32>()
    });
    let peak_kb = memory_peak_kb();
    println!("{inputs} files, memory {peak_kb} kB");
    assert_eq!(inputs, LONG_INPUTS);
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
