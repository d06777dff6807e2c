//! What runs before the program: reset entry, vectors, entry and exit of interrupts, as assembly. See `link.x` for where
//! it lies and `reset.S` for what it does.

/// Makes a function the program: `entry!(main);` with `fn main() -> !`. It runs with interrupts off, statics initialised, the
/// flash's wait states and prefetch set for 80 MHz, JTAG off (unless `__pre_init` was replaced), and every pin an input.
#[macro_export]
macro_rules! entry {
    ($main:path) => {
        const _: () = {
            // On other machines the function is an ordinary `main`, and nothing calls this one.
            #[cfg_attr(target_arch = "mips", unsafe(no_mangle))]
            #[allow(
                dead_code,
                reason = "called by the start-up code, which is not there on other machines"
            )]
            extern "C" fn __program() -> ! {
                let main: fn() -> ! = $main;
                main()
            }
        };
    };
}

#[cfg(target_arch = "mips")]
mod assembly {
    use core::arch::global_asm;

    // One block, so that all of it is linked when the reset entry is.
    global_asm!(
        ".set push",
        ".set noreorder",
        ".set noat",
        ".set mips32r2",
        ".set nomips16",
        include_str!("reset.S"),
        include_str!("exception.S"),
        include_str!("interrupt.S"),
        include_str!("vectors.S"),
        ".set pop",
        ".text",
        options(raw)
    );
}
