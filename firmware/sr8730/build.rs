//! Links the robot's program, and the example of soft-uart, with the library's memory layout.

fn main() {
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|target| target == "mips") {
        println!("cargo:rustc-link-arg-bins=-Tlink.x");
        println!("cargo:rustc-link-arg-examples=-Tlink.x");
    }
    println!("cargo:rerun-if-changed=build.rs");
}
