//! Interrupts at any instruction, delay slots included, disturb nothing.

use crate::block::Kind;
use crate::chip::{DataPlace, written};
use crate::encode::{DATA, NOP, constant, immediate, special};
use crate::image::placed;
use crate::numbers::Numbers;
use crate::program::{CODE, Program};
use pic32::cpu::{Access, Bus, BusFault, Cpu, ExceptionCode, Exit, InterruptRequest, Taken};
use pic32::image::Image;
use pic32::memory::Memory;

const RESET: u32 = 0x1FC0_0000;
/// Where handlers begin, behind the program.
const VECTORS: u32 = 0x9D03_F000;
const SPACING: u32 = 64;
const WRITE: u32 = 4004;
const STATUS: u32 = 12;
const CAUSE: u32 = 13;
const COUNT: i16 = 0x200;
/// Status with IE.
const ENABLED: u32 = 1;
/// Cause with IV.
const VECTORED: u32 = 0x0080_0000;

fn mtc0(register: u32, select: u32, from: u32) -> u32 {
    0x10 << 26 | 4 << 21 | from << 16 | register << 11 | select
}

const ERET: u32 = 0x4200_0018;

/// Prepares the core and jumps to the program.
fn boot() -> Vec<u32> {
    let mut words = constant(DATA, DataPlace::Cached.address()).to_vec();
    let mut set = |register, select, value| {
        words.extend(constant(2, value));
        words.push(mtc0(register, select, 2));
    };
    set(15, 1, VECTORS);
    set(12, 1, SPACING);
    set(CAUSE, 0, VECTORED);
    set(STATUS, 0, ENABLED);
    // Behind the two instructions by which the program would set the register that handlers need.
    words.extend(constant(2, (0x8000_0000 | CODE) + 8));
    words.extend([special(0x08, 0, 2, 0), NOP]);
    words
}

/// Counts in memory, through registers that it saves.
fn handler(place: i16) -> Vec<u32> {
    let at = |offset: i16| (COUNT + offset) as u32;
    vec![
        immediate(0x2B, 2, DATA, at(4)),
        immediate(0x23, 2, DATA, at(place)),
        NOP,
        immediate(9, 2, 2, 1),
        immediate(0x2B, 2, DATA, at(place)),
        immediate(0x23, 2, DATA, at(4)),
        ERET,
        NOP,
    ]
}

/// The same in the second register set, whose registers are its own.
fn handler_in_shadow(place: i16) -> Vec<u32> {
    let at = (COUNT + place) as u32;
    let read_previous = 0x10 << 26 | 0x0A << 21;
    vec![
        read_previous | DATA << 16 | DATA << 11,
        immediate(0x23, 3, DATA, at),
        NOP,
        immediate(9, 3, 3, 1),
        immediate(0x2B, 3, DATA, at),
        // Anything in another register of this set.
        immediate(9, 31, 31, 77),
        ERET,
        NOP,
    ]
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn image(program: &Program) -> Image {
    let mut image = Image::erased();
    let handlers = [(0, handler(0)), (SPACING, handler_in_shadow(8))];
    image
        .write(CODE, &placed(program, DataPlace::Cached.address()))
        .expect("it fits");
    image.write(RESET, &bytes(&boot())).expect("it fits");
    for (offset, words) in handlers {
        image
            .write(VECTORS + 0x200 + offset, &bytes(&words))
            .expect("it fits");
    }
    image
}

/// Withdraws a request as soon as it is taken.
#[derive(Debug, Default)]
struct Controller {
    taken: Option<Taken>,
}

impl Bus for Controller {
    fn load(&mut self, _: Access) -> Result<u32, BusFault> {
        Err(BusFault)
    }

    fn store(&mut self, _: Access, _: u32) -> Result<(), BusFault> {
        Err(BusFault)
    }

    fn horizon(&self) -> u64 {
        self.taken.map_or(u64::MAX, |taken| taken.cycle)
    }

    fn interrupt_taken(&mut self, taken: Taken) {
        self.taken = Some(taken);
    }
}

/// What the program writes, and how many interrupts it counted in each set.
fn run(
    program: &Program,
    mut requests: impl FnMut() -> (u64, Option<InterruptRequest>),
) -> (Vec<u8>, [u32; 2], [u32; 2]) {
    let mut memory = Memory::new(&image(program));
    let mut cpu = Cpu::new();
    let mut controller = Controller::default();
    let mut output = Vec::new();
    let mut taken = [0; 2];
    loop {
        let (cycles, request) = requests();
        // A handler that is running is left alone: its exception level keeps others out.
        cpu.interrupt(request);
        let until = cpu.cycle() + cycles;
        match cpu.run(&mut memory, &mut controller, until) {
            Exit::Reached => {}
            Exit::Horizon => {
                let found = controller.taken.take().expect("the horizon was for this");
                taken[usize::from(found.request.shadow_set)] += 1;
                cpu.interrupt(None);
                while cpu.system_register(12, 0) & 2 != 0 {
                    cpu.step(&mut memory, &mut controller);
                }
            }
            Exit::Exception(exception) => {
                assert_eq!(exception.code, ExceptionCode::Syscall, "{exception:x?}");
                if cpu.register(2) != WRITE {
                    let counted = [0, 8].map(|place| counter(&memory, place));
                    return (output, counted, taken);
                }
                output.extend(written(&cpu, &memory));
                leave(&mut cpu, &mut memory, exception.address + 4);
            }
            other => panic!("the program ended with {other:x?}"),
        }
    }
}

/// Ends the exception of a system call as its handler would.
fn leave(cpu: &mut Cpu, memory: &mut Memory, address: u32) {
    cpu.set_system_register(14, 0, address);
    // The general vector holds an `eret`.
    memory
        .write(VECTORS - 0x8000_0000 + 0x180, &ERET.to_le_bytes())
        .expect("it is flash");
    cpu.interrupt(None);
    cpu.step(memory, &mut Controller::default());
    assert_eq!(cpu.pc(), address);
}

fn counter(memory: &Memory, place: i16) -> u32 {
    let mut bytes = [0; 4];
    let address = DataPlace::Physical.address() + (COUNT + place) as u32;
    memory.read(address, &mut bytes).expect("it is RAM");
    u32::from_le_bytes(bytes)
}

#[test]
fn interrupts_between_any_two_instructions_disturb_nothing() {
    for seed in 0..4 {
        let program = Program::random(seed, 400, Kind::Interrupted);
        let (undisturbed, _, none) = run(&program, || (u64::MAX / 4, None));
        assert_eq!(none, [0, 0]);
        let mut numbers = Numbers::new(seed);
        let (disturbed, counted, taken) = run(&program, || {
            let shadow_set = numbers.below(2) as u8;
            let request = InterruptRequest {
                level: numbers.below(7) as u8 + 1,
                vector: shadow_set,
                shadow_set,
            };
            let wanted = numbers.below(2) == 0;
            (u64::from(numbers.below(12)) + 1, wanted.then_some(request))
        });
        assert!(undisturbed == disturbed, "seed {seed}");
        assert_eq!(counted, taken, "seed {seed}");
        assert!(taken.iter().all(|count| *count > 300), "{taken:?}");
    }
}
