//! Handlers of six levels interrupt each other and the main program, all of them multiply, divide and call functions; nobody
//! may notice. The main program repeats a calculation: RG7 changes when it comes out as the first time, RG8 goes high when
//! it does not, or when a register that functions may change was changed. Each timer's handler changes a pin of port E.
#![cfg_attr(target_arch = "mips", no_std, no_main)]
#![cfg_attr(target_arch = "mips", feature(asm_experimental_arch))]

mod board;

use core::hint::black_box;
use pic32mx3_hal::gpio::{Level, Port};
use pic32mx3_hal::interrupt::{Context, HandlerCell, Priority, Source, SubPriority, Vector, vector};
use pic32mx3_hal::timer::{Prescaler, SlowPrescaler, Timer};
use pic32mx3_hal::{Peripherals, entry, interrupt, reset};

/// What a handler remembers between its calls: a number and what it became by then, calculated twice.
struct Work {
    number: u32,
}

/// Uses hi, lo and many registers.
#[inline(never)]
fn stir(number: u32) -> u32 {
    let wide = u64::from(number).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let (high, low) = ((wide >> 32) as u32, wide as u32);
    (high ^ low.rotate_left(7)).wrapping_add(low / (high | 1)) ^ (high % (low | 3))
}

/// Stirs a few words in such an order that a changed register shows.
#[inline(never)]
fn calculate(seed: u32) -> u32 {
    let mut words = [0_u32; 16];
    let mut number = seed;
    for _ in 0..4 {
        for word in &mut words {
            number = stir(number ^ black_box(*word));
            *word = word.wrapping_add(number);
        }
    }
    words.iter().fold(0, |sum, word| sum.rotate_left(3) ^ word)
}

// Fills every register that a function may change, lets time pass, and returns which bits differ then: 0 for none.
#[cfg(target_arch = "mips")]
core::arch::global_asm!(
    ".set push",
    ".set noat",
    ".set noreorder",
    ".globl changed_registers",
    "changed_registers:",
    "addiu $sp, $sp, -16",
    "sw $s0, 0($sp)",
    "sw $s1, 4($sp)",
    "sw $ra, 8($sp)",
    "li $s0, 0x12345678",
    "mthi $s0",
    "addiu $s0, $s0, 1",
    "mtlo $s0",
    ".irp number, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 31",
    "lui $\\number, 0x5A00 + \\number",
    ".endr",
    ".rept 200",
    "nop",
    ".endr",
    "mfhi $s1",
    "subu $s1, $s0, $s1",
    "addiu $s1, $s1, -1",
    ".irp number, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 31",
    "lui $s0, 0x5A00 + \\number",
    "xor $s0, $s0, $\\number",
    "or $s1, $s1, $s0",
    ".endr",
    "li $s0, 0x12345679",
    "mflo $v0",
    "xor $s0, $s0, $v0",
    "or $v0, $s1, $s0",
    "lw $s0, 0($sp)",
    "lw $s1, 4($sp)",
    "lw $ra, 8($sp)",
    "jr $ra",
    "addiu $sp, $sp, 16",
    // Changes all of them but the one to return by.
    ".globl change_registers",
    "change_registers:",
    ".irp number, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25",
    "mfc0 $\\number, $9",
    ".endr",
    "mthi $t0",
    "jr $ra",
    "mtlo $t1",
    ".set pop",
);

#[cfg(target_arch = "mips")]
fn registers_survive() -> bool {
    unsafe extern "C" {
        fn changed_registers() -> u32;
    }
    // SAFETY: it keeps to the calling convention.
    unsafe { changed_registers() == 0 }
}

#[cfg(target_arch = "mips")]
fn change_registers() {
    unsafe extern "C" {
        #[link_name = "change_registers"]
        fn change();
    }
    // SAFETY: it keeps to the calling convention.
    unsafe { change() }
}

#[cfg(not(target_arch = "mips"))]
fn change_registers() {}

#[cfg(not(target_arch = "mips"))]
fn registers_survive() -> bool {
    true
}

macro_rules! handlers {
    ($($vector:ident $source:ident $cell:ident $handler:ident $bit:literal;)*) => {
        $(
            static $cell: HandlerCell<vector::$vector, Work> = HandlerCell::empty();

            fn $handler(context: &mut Context<vector::$vector>) {
                if let Some(work) = $cell.get(context) {
                    // The same twice, with time between for others.
                    let first = stir(work.number);
                    if stir(black_box(work.number)) != first {
                        Port::G.set(1 << 8);
                    }
                    work.number = work.number.wrapping_add(1);
                }
                change_registers();
                Port::E.invert(1 << $bit);
                Source::$source.clear();
            }
            interrupt!($vector, $handler);
        )*
    };
}

handlers! {
    TIMER_1 Timer1 WORK_1 on_timer_1 1;
    TIMER_2 Timer2 WORK_2 on_timer_2 2;
    TIMER_3 Timer3 WORK_3 on_timer_3 3;
    TIMER_4 Timer4 WORK_4 on_timer_4 4;
    TIMER_5 Timer5 WORK_5 on_timer_5 5;
}

fn main() -> ! {
    let Some(mut peripherals) = Peripherals::take() else {
        reset::software_reset()
    };
    let mut good = peripherals.pins.rg7.into_output(Level::Low);
    let _bad = peripherals.pins.rg8.into_output(Level::Low);
    Port::E.drive(0b11_1110);
    let expected = calculate(1);
    let handed = WORK_1.hand_over(Work { number: 1 }).is_ok()
        && WORK_2.hand_over(Work { number: 2 }).is_ok()
        && WORK_3.hand_over(Work { number: 3 }).is_ok()
        && WORK_4.hand_over(Work { number: 4 }).is_ok()
        && WORK_5.hand_over(Work { number: 5 }).is_ok();
    let levels = [
        (Vector::Timer1, Priority::Level1),
        (Vector::Timer2, Priority::Level2),
        (Vector::Timer3, Priority::Level4),
        (Vector::Timer4, Priority::Level5),
        (Vector::Timer5, Priority::Level6),
    ];
    for (vector, priority) in levels {
        if !handed || interrupt::set_priority(vector, priority, SubPriority::Sub0).is_err() {
            reset::software_reset();
        }
    }
    // Periods without common factor, so that every order of interrupts comes about.
    peripherals.timer1.start(SlowPrescaler::By1, 4_001);
    peripherals.timer2.start(Prescaler::By1, 3_001);
    peripherals.timer3.start(Prescaler::By1, 2_503);
    peripherals.timer4.start(Prescaler::By1, 2_003);
    peripherals.timer5.start(Prescaler::By1, 1_511);
    let sources: [Source; 5] = [
        Timer::<1>::SOURCE,
        Timer::<2>::SOURCE,
        Timer::<3>::SOURCE,
        Timer::<4>::SOURCE,
        Timer::<5>::SOURCE,
    ];
    sources.into_iter().for_each(Source::enable);
    interrupt::start();
    loop {
        if calculate(black_box(1)) == expected && registers_survive() {
            good.toggle();
        } else {
            Port::G.set(1 << 8);
        }
    }
}
entry!(main);
