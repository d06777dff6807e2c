//! Says which kind of link is built, and links the robot's program, and the example of soft-uart, with the library's memory layout.

fn main() {
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|target| target == "mips") {
        println!("cargo:rustc-link-arg-bins=-Tlink.x");
        println!("cargo:rustc-link-arg-examples=-Tlink.x");
    }
    let has = |feature: &str| std::env::var_os(feature).is_some();
    let kinds = [
        "CARGO_FEATURE_LINK_SAMPLED",
        "CARGO_FEATURE_LINK_SPI",
        "CARGO_FEATURE_LINK_I2C",
    ];
    assert!(
        kinds.into_iter().filter(|kind| has(kind)).count() <= 1,
        "link-sampled, link-spi and link-i2c exclude each other: a robot has one link"
    );
    assert!(
        !has("CARGO_FEATURE_LINK_RS485") || !has("CARGO_FEATURE_LINK_SPI") && !has("CARGO_FEATURE_LINK_I2C"),
        "link-rs485 is a serial link, without link-spi and link-i2c"
    );
    println!("cargo:rustc-check-cfg=cfg(serial_link)");
    if !has("CARGO_FEATURE_LINK_SPI") && !has("CARGO_FEATURE_LINK_I2C") {
        println!("cargo:rustc-cfg=serial_link");
    }
    println!("cargo:rerun-if-changed=build.rs");
}
