//! A pair whose driver the daemon switches, on a pseudo terminal. Waits are for bytes and for the driver.

use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use robot_link::{Direction, GpioLine, LinkAddress, OneWire, UartAddress, Wires};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rvac_protocol::frame::SEPARATOR;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio::task::LocalSet;
use vthal_core::device::Opening;

use super::start;
use crate::link::opening::open_to_robot;
use crate::link::pair_driver::PairDriver;
use crate::serial::{self, SerialSettings};

/// Slow, so that what a byte takes is long beside what the machine does.
const BAUD: u32 = 9_600;

/// Tells when it is switched, and how many bytes have reached the other end by then.
struct Told {
    told: UnboundedSender<(bool, u64, Instant)>,
    far: File,
}

impl PairDriver for Told {
    fn switch(&mut self, is_on: bool) -> io::Result<()> {
        let arrived = rustix::io::ioctl_fionread(&self.far)?;
        self.told
            .send((is_on, arrived, Instant::now()))
            .map_err(io::Error::other)
    }
}

/// The robot's end of a pseudo terminal, and the path of the host's.
fn terminal() -> (File, PathBuf) {
    let far = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a pseudo terminal");
    grantpt(&far).expect("granted");
    unlockpt(&far).expect("unlocked");
    let name = ptsname(&far, Vec::new()).expect("a name");
    (far.into(), name.to_string_lossy().into_owned().into())
}

#[tokio::test]
async fn the_driver_is_on_before_the_first_byte_and_off_after_the_last_bit() {
    let (mut far, path) = terminal();
    let near = serial::open(&SerialSettings { path, baud: BAUD }).expect("opens");
    let (told, mut switched) = unbounded_channel();
    let handle = far.try_clone().expect("one more handle");
    let driver = Told { told, far: handle };
    let said = *b"hello";
    let work = async {
        let (mut stream, _complaint) = start(near.port, OneWire::new(false, BAUD), Some((driver, BAUD)));
        // The robot ends a packet: it is the host's turn.
        far.write_all(&[SEPARATOR]).expect("the robot says");
        let mut end = [0; 1];
        stream.read_exact(&mut end).await.expect("the host hears");
        stream.write_all(&said).await.expect("the host says");
        let (is_on, arrived, on) = switched.recv().await.expect("switched");
        assert_eq!((is_on, arrived), (true, 0), "on while nothing has left");
        let (is_on, arrived, off) = switched.recv().await.expect("switched");
        assert_eq!(
            (is_on, arrived),
            (false, said.len() as u64),
            "off when all has left"
        );
        let line_time = Duration::from_secs(1) * 10 * said.len() as u32 / BAUD;
        assert!(off - on >= line_time, "{:?} for {line_time:?}", off - on);
        let mut heard = [0; 12];
        let count = far.read(&mut heard).expect("the robot hears");
        assert_eq!(heard.get(..count), Some(said.as_slice()));
        // And the robot is heard again.
        far.write_all(b"yes").expect("the robot answers");
        let mut answer = [0; 3];
        stream.read_exact(&mut answer).await.expect("the host hears");
        assert_eq!(&answer, b"yes");
    };
    LocalSet::new().run_until(work).await;
}

/// Opens a pair on a pseudo terminal, which has no RS-485 and whose machine has no such GPIO chip.
async fn refusal(direction: Direction) -> String {
    let (_far, path) = terminal();
    let address = LinkAddress::Uart(UartAddress {
        path,
        baud: None,
        wires: Wires::Pair(direction),
    });
    let opening = Opening {
        rates_baud: &[],
        answer_within_ms: 0,
        wake_pulse_ms: 0,
        settle_ms: 0,
    };
    let opened = LocalSet::new()
        .run_until(open_to_robot((&address, opening), BAUD))
        .await;
    opened.map(drop).expect_err("refused").to_string()
}

#[tokio::test]
async fn a_port_that_switches_no_driver_is_refused_with_what_to_write() {
    let text = refusal(Direction::RtsHigh).await;
    assert!(
        text.contains("cannot switch the direction of an RS-485 pair"),
        "{text}"
    );
    assert!(text.contains("direction=gpiochip0:17"), "{text}");
}

#[tokio::test]
async fn a_line_that_is_not_there_is_named() {
    let line = GpioLine {
        chip: "/dev/gpiochip-none".into(),
        line: 17,
    };
    let text = refusal(Direction::LineLow(line)).await;
    assert!(text.contains("/dev/gpiochip-none"), "{text}");
}
