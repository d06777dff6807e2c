//! The reader against files laid out as the kernel's.

use std::fs;
use std::path::{Path, PathBuf};

use tokio::sync::mpsc;

use super::{Axis, ImuEvent, ImuSettings, Roots};
use crate::event::Event;

/// One raw count is 1/1024 rad/s.
const SCALE: &str = "0.0009765625\n";

/// A kernel's files in a folder of their own.
struct Kernel {
    root: PathBuf,
}

impl Kernel {
    fn new(name: &str) -> Self {
        let root = std::env::temp_dir().join(format!("vthal-imu-{name}-{}", std::process::id()));
        fs::remove_dir_all(&root).ok();
        let kernel = Self { root };
        kernel.file("name", "mpu6050\n");
        kernel.file("in_anglvel_scale", SCALE);
        kernel.file("in_anglvel_z_raw", "-512\n");
        kernel
    }

    fn file(&self, name: &str, text: &str) {
        let path = self.sensor().join(name);
        fs::create_dir_all(path.parent().expect("has a folder")).expect("writable");
        fs::write(path, text).expect("writable");
    }

    fn sensor(&self) -> PathBuf {
        self.root.join("sys/bus/iio/devices/iio:device3")
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.sensor().join(name)).expect("there")
    }

    /// A buffer with a trigger, holding `samples` of a rate 10 ms apart.
    fn with_buffer(self, samples: &[i16]) -> Self {
        self.file("trigger/current_trigger", "mpu6050-dev3\n");
        self.file("buffer/enable", "0\n");
        self.file("buffer/length", "2\n");
        self.file("current_timestamp_clock", "realtime\n");
        for (name, kind) in [
            ("in_anglvel_z", "be:s16/16>>0\n"),
            ("in_accel_x", "be:s16/16>>0\n"),
            ("in_timestamp", "le:s64/64>>0\n"),
        ] {
            self.file(&format!("scan_elements/{name}_en"), "1\n");
            self.file(&format!("scan_elements/{name}_type"), kind);
        }
        let mut bytes = Vec::new();
        for (number, sample) in (0_i64..).zip(samples) {
            bytes.extend_from_slice(&sample.to_be_bytes());
            bytes.extend_from_slice(&[0; 6]);
            bytes.extend_from_slice(&(number * 10_000_000).to_le_bytes());
        }
        let dev = self.root.join("dev");
        fs::create_dir_all(&dev).expect("writable");
        fs::write(dev.join("iio:device3"), bytes).expect("writable");
        self
    }

    fn settings(&self, device: &str, axis: &str) -> ImuSettings {
        let root = |name: &str| self.root.join(name);
        ImuSettings {
            device: device.to_owned(),
            axis: Axis::from_name(axis).expect("an axis"),
            roots: Roots::new(&root("sys"), &root("dev")),
        }
    }

    /// The first events of the thread.
    fn events(&self, device: &str, axis: &str, count: usize) -> Vec<ImuEvent> {
        let (sender, mut events) = mpsc::channel(64);
        super::start(self.settings(device, axis), sender).expect("a thread");
        std::iter::from_fn(|| events.blocking_recv())
            .take(count)
            .map(|event| match event {
                Event::Imu(event) => event,
                other => panic!("{other:?} does not come from a sensor"),
            })
            .collect()
    }
}

impl Drop for Kernel {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.root).ok();
    }
}

#[test]
fn a_buffer_is_set_up_and_added_up() {
    let kernel = Kernel::new("buffer").with_buffer(&[1024, 1024, 3072]);
    let events = kernel.events("mpu6050", "z", 3);
    assert_eq!(events[0], ImuEvent::Opened("by its buffer"));
    assert_eq!(
        events[1],
        ImuEvent::Turned(30_000),
        "10 ms at 1 rad/s, 10 ms from 1 to 3 rad/s"
    );
    assert!(matches!(&events[2], ImuEvent::Absent(_)), "the file has an end");
    assert_eq!(kernel.read("scan_elements/in_accel_x_en"), "0");
    assert_eq!(kernel.read("scan_elements/in_anglvel_z_en"), "1");
    assert_eq!(kernel.read("current_timestamp_clock"), "monotonic");
    assert_eq!(kernel.read("buffer/enable"), "1");
}

#[test]
fn a_sensor_that_hangs_upside_down_turns_the_other_way() {
    let kernel = Kernel::new("upside-down").with_buffer(&[1024, 1024]);
    let events = kernel.events("iio:device3", "-z", 2);
    assert_eq!(events[1], ImuEvent::Turned(-10_000));
}

#[test]
fn without_a_trigger_the_sensor_is_asked() {
    let kernel = Kernel::new("asked").with_buffer(&[]);
    kernel.file("trigger/current_trigger", "\n");
    let events = kernel.events("mpu6050", "z", 4);
    assert!(
        matches!(events[0], ImuEvent::Opened(manner) if manner.starts_with("asked")),
        "{events:?}"
    );
    assert_eq!(events[1], ImuEvent::Turned(0), "the first sample is the origin");
    let turned = |event: &ImuEvent| match event {
        ImuEvent::Turned(urad) => *urad,
        other => panic!("{other:?}"),
    };
    // Half a radian a second, clockwise, over the time that really passed.
    assert!(turned(&events[3]) < turned(&events[2]), "{events:?}");
    assert!(turned(&events[2]) < 0, "{events:?}");
}

#[test]
fn what_is_not_there_is_reported_once_with_what_there_is() {
    let kernel = Kernel::new("absent");
    let events = kernel.events("bmi160", "z", 1);
    assert_eq!(
        events[0],
        ImuEvent::Absent(
            "no sensor of the kernel has the name \"bmi160\" (there are: mpu6050); \
             check imu.device and that its driver is loaded"
                .to_owned()
        )
    );
    let events = kernel.events("mpu6050", "x", 1);
    assert!(
        matches!(&events[0], ImuEvent::Absent(text) if text.ends_with("it lacks in_anglvel_x_raw")),
        "{events:?}"
    );
}

#[test]
fn a_figure_that_is_none_is_named() {
    let kernel = Kernel::new("figure");
    kernel.file("in_anglvel_z_scale", "fast");
    let events = kernel.events("mpu6050", "z", 1);
    assert!(
        matches!(&events[0], ImuEvent::Absent(text) if text.contains("in_anglvel_z_scale says \"fast\"")),
        "{events:?}"
    );
}

#[test]
fn axes_have_names() {
    for name in ["x", "y", "z", "-x", "-y", "-z"] {
        assert!(Axis::from_name(name).is_some(), "{name}");
    }
    for name in ["", "-", "up", "+z", "--z", "zz"] {
        assert!(Axis::from_name(name).is_none(), "{name}");
    }
    assert!(Roots::default().devices().starts_with(Path::new("/sys")));
}
