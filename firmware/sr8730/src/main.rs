//! The robot's program. On any other machine it only prints how to build it for the chip.
#![cfg_attr(target_arch = "mips", no_std, no_main)]
#![cfg_attr(target_arch = "mips", feature(asm_experimental_arch))]

#[cfg(target_arch = "mips")]
mod chip;

#[cfg(not(target_arch = "mips"))]
fn main() {
    println!("this program runs on the robot's chip; `cargo xtask firmware sr8730` builds it");
}
