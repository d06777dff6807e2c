//! The checks, on files as real boards have them.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use super::{Board, Grade, all, candidates};
use crate::folder::Folder;

/// A time at which the clock is set: 2026-11-28.
const NOW_S: u64 = 1_795_800_000;

/// A Raspberry Pi Zero W with its console off and Bluetooth off, the package installed and set up.
fn pi_zero() -> Folder {
    let folder = Folder::new();
    for (path, text) in [
        ("proc/device-tree/model", "Raspberry Pi Zero W Rev 1.1\0"),
        ("proc/cmdline", "console=tty1 root=PARTUUID=1-02 rootwait\n"),
        ("dev/ttyAMA0", ""),
        ("etc/vthal.toml", "[link]\nserial = \"/dev/serial0\"\n"),
        (
            "etc/passwd",
            "root:x:0:0::/root:/bin/sh\nvthal:x:998:998::/:/bin/false\n",
        ),
        ("etc/group", "dialout:x:20:pi,vthal\n"),
        ("sys/devices/platform/soc/soc:firmware/get_throttled", "0\n"),
        ("sys/class/thermal/thermal_zone0/temp", "48312\n"),
        ("sys/class/tty/ttyS0/type", "0\n"),
    ] {
        put(&folder, path, text);
    }
    link(&folder, "ttyAMA0", "dev/serial0");
    link(&folder, "/usr/share/zoneinfo/Europe/Tallinn", "etc/localtime");
    fs::create_dir_all(folder.join("var/lib/vthal")).expect("a folder");
    folder
}

fn put(folder: &Folder, path: &str, text: &str) {
    let file = folder.join(path);
    fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
    fs::write(file, text).expect("written");
}

fn link(folder: &Folder, target: &str, path: &str) {
    let place = folder.join(path);
    fs::create_dir_all(place.parent().expect("a folder")).expect("a folder");
    fs::remove_file(&place).ok();
    symlink(target, place).expect("linked");
}

/// Checks that are not good, with their causes.
fn complaints(folder: &Folder) -> Vec<(&'static str, Grade, String)> {
    all(&Board::below(&folder.join("")), NOW_S)
        .into_iter()
        .filter(|finding| finding.grade != Grade::Good)
        .inspect(|finding| assert!(!finding.remedy.is_empty(), "{finding:?}"))
        .map(|finding| (finding.check, finding.grade, finding.cause))
        .collect()
}

#[test]
fn a_board_in_order_has_nothing_to_say() {
    assert_eq!(complaints(&pi_zero()), []);
}

#[test]
fn each_thing_that_keeps_a_robot_from_working_has_its_line() {
    type Spoil = fn(&Folder);
    let cases: [(&str, Grade, Spoil); 11] = [
        ("console", Grade::Fault, |folder| {
            put(folder, "proc/cmdline", "console=serial0,115200 console=tty1\n");
        }),
        ("console", Grade::Fault, |folder| {
            link(
                folder,
                "/lib/systemd/system/serial-getty@.service",
                "etc/systemd/system/getty.target.wants/serial-getty@ttyAMA0.service",
            );
        }),
        ("console", Grade::Fault, |folder| {
            put(
                folder,
                "proc/417/cmdline",
                "/sbin/agetty\0-o\0-p\0ttyAMA0\0vt220\0",
            );
        }),
        ("serial", Grade::Fault, |folder| {
            fs::remove_file(folder.join("dev/ttyAMA0")).expect("removed");
        }),
        ("configuration", Grade::Fault, |folder| {
            put(folder, "etc/vthal.toml", "[link]\nserial = /dev/serial0\n");
        }),
        ("groups", Grade::Fault, |folder| {
            put(folder, "etc/group", "dialout:x:20:pi\nvthal:x:998:\n");
        }),
        ("zone", Grade::Warning, |folder| {
            link(folder, "/usr/share/zoneinfo/Etc/UTC", "etc/localtime");
        }),
        ("zone", Grade::Warning, |folder| {
            fs::remove_file(folder.join("etc/localtime")).expect("removed");
        }),
        ("supply", Grade::Fault, |folder| {
            put(
                folder,
                "sys/devices/platform/soc/soc:firmware/get_throttled",
                "50005\n",
            );
        }),
        ("supply", Grade::Warning, |folder| {
            put(
                folder,
                "sys/devices/platform/soc/soc:firmware/get_throttled",
                "0x50000\n",
            );
        }),
        ("heat", Grade::Warning, |folder| {
            put(folder, "sys/class/thermal/thermal_zone0/temp", "83000\n");
        }),
    ];
    for (check, grade, spoil) in cases {
        let folder = pi_zero();
        spoil(&folder);
        let found = complaints(&folder);
        let [(named, how, cause)] = found.as_slice() else {
            panic!("{check}: {found:?}");
        };
        assert_eq!((*named, *how), (check, grade), "{cause}");
    }
}

#[test]
fn the_device_of_any_link_must_be_there() {
    let folder = pi_zero();
    put(&folder, "etc/vthal.toml", "link = \"spi:/dev/spidev0.0\"\n");
    let found = complaints(&folder);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        (found[0].0, found[0].2.as_str()),
        ("serial", "/dev/spidev0.0 is not there")
    );
    put(&folder, "dev/spidev0.0", "");
    assert_eq!(complaints(&folder), []);
    put(&folder, "etc/vthal.toml", "link = \"tcp:robot.local:4000\"\n");
    assert_eq!(complaints(&folder), [], "a network has no device");
    put(&folder, "etc/vthal.toml", "link = \"wifi:robot.local\"\n");
    let found = complaints(&folder);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "configuration");
}

#[test]
fn bluetooth_on_the_good_port_is_told() {
    let folder = pi_zero();
    put(&folder, "dev/ttyS0", "");
    link(&folder, "ttyS0", "dev/serial0");
    let found = complaints(&folder);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "bluetooth");
}

#[test]
fn a_board_that_was_not_set_up_is_told_to_be() {
    let folder = pi_zero();
    fs::remove_file(folder.join("etc/vthal.toml")).expect("removed");
    let found = complaints(&folder);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "configuration");
}

#[test]
fn each_serial_device_is_found_once_and_by_the_name_that_lasts() {
    let folder = pi_zero();
    for name in [
        "dev/ttyS0",
        "dev/ttyS31",
        "dev/ttyUSB0",
        "dev/ttyprintk",
        "dev/tty1",
    ] {
        put(&folder, name, "");
    }
    put(&folder, "sys/class/tty/ttyS31/type", "0\n");
    link(
        &folder,
        "../../ttyUSB0",
        "dev/serial/by-id/usb-FTDI_FT232R-if00-port0",
    );
    let found = candidates(&Board::below(&folder.join("")));
    let paths: Vec<&Path> = found.iter().map(|device| device.path.as_path()).collect();
    assert_eq!(
        paths,
        [
            Path::new("/dev/serial0"),
            Path::new("/dev/serial/by-id/usb-FTDI_FT232R-if00-port0")
        ]
    );
    assert_eq!(found[1].kernel_name, "ttyUSB0");
}

#[test]
fn a_real_board_is_looked_at_without_harm() {
    let findings = all(&Board::below(&PathBuf::from("/")), NOW_S);
    assert!(findings.iter().any(|finding| finding.check == "disk"));
}

#[test]
fn a_gyro_that_is_configured_must_be_there_and_answer() {
    const SENSOR: &str = "sys/bus/iio/devices/iio:device0";
    let folder = pi_zero();
    let configuration = "link = \"uart:/dev/serial0\"\n[imu]\ndevice = \"mpu6050\"\nup = \"-y\"\n";
    put(&folder, "etc/vthal.toml", configuration);
    let told = |cause: &str| vec![("gyro", Grade::Fault, cause.to_owned())];
    assert_eq!(
        complaints(&folder),
        told("the kernel has no sensor mpu6050 (it has none)")
    );
    put(&folder, &format!("{SENSOR}/name"), "bmi160\n");
    assert_eq!(
        complaints(&folder),
        told("the kernel has no sensor mpu6050 (it has bmi160)")
    );
    put(&folder, &format!("{SENSOR}/name"), "mpu6050\n");
    assert_eq!(complaints(&folder), told("mpu6050 has no gyro on the axis y"));
    let raw = format!("{SENSOR}/in_anglvel_y_raw");
    put(&folder, &raw, "-12\n");
    assert_eq!(complaints(&folder), []);
    put(&folder, &raw, "?\n");
    assert_eq!(
        complaints(&folder),
        told("mpu6050 does not answer: it says \"?\"")
    );
    // What a bus without the chip gives is an error of reading; a folder gives one, too.
    fs::remove_file(folder.join(&raw)).expect("removed");
    fs::create_dir(folder.join(&raw)).expect("a folder");
    assert_eq!(
        complaints(&folder),
        told("mpu6050 does not answer: Is a directory (os error 21)")
    );
}
