//! The program of the robot. On anything but the robot's chip it only says where it belongs.
#![cfg_attr(target_arch = "mips", no_std, no_main)]
#![cfg_attr(target_arch = "mips", feature(asm_experimental_arch))]

#[cfg(target_arch = "mips")]
mod chip;

#[cfg(not(target_arch = "mips"))]
fn main() {
    println!("this program runs on the robot's chip; `cargo xtask firmware sr8730` builds it");
}
