//! A serial device with one wire, or one pair, for both directions: a task between it and the stream that the daemon sees.

use std::io;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use robot_link::OneWire;
use serial2_tokio::SerialPort;
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};
use tokio::task::{spawn_blocking, spawn_local};
use tokio::time::Instant;

use super::pair_driver::PairDriver;

/// Bytes that may wait in each direction.
const QUEUE: usize = 4096;

/// Start, eight, stop.
const BITS_OF_A_BYTE: u64 = 10;

/// Begins to serve the device. It ends with the stream, and the stream with it. A pair's driver that the kernel does not switch
/// comes with the rate of the line.
pub(super) fn start<D: PairDriver>(
    port: SerialPort,
    wire: OneWire,
    driver: Option<(D, u32)>,
) -> (DuplexStream, Arc<OnceLock<String>>) {
    let (ours, theirs) = tokio::io::duplex(QUEUE);
    let complaint = Arc::new(OnceLock::new());
    let told = Arc::clone(&complaint);
    spawn_local(async move {
        if let Err(error) = take_turns(&port, ours, (wire, driver)).await {
            // The first reason stays.
            told.set(error.to_string()).ok();
        }
    });
    (theirs, complaint)
}

/// Sends with the driver on, and switches it off when the last bit has left, a byte later for what the port takes to begin. A thread
/// waits for that: it sleeps to a tenth of a millisecond, a timer of the daemon to a whole one, and the robot answers at once.
async fn send_driven<D: PairDriver>(
    port: &SerialPort,
    turn: &[u8],
    (mut driver, baud): (D, u32),
) -> io::Result<(D, u32)> {
    driver.switch(true)?;
    port.write_all(turn).await?;
    let bits = BITS_OF_A_BYTE * (turn.len() as u64 + 1);
    let takes = Duration::from_nanos(bits * 1_000_000_000 / u64::from(baud.max(1)));
    spawn_blocking(move || {
        std::thread::sleep(takes);
        driver.switch(false).map(|()| (driver, baud))
    })
    .await
    .map_err(io::Error::other)?
}

async fn take_turns<D: PairDriver>(
    port: &SerialPort,
    ours: DuplexStream,
    (mut wire, mut driver): (OneWire, Option<(D, u32)>),
) -> io::Result<()> {
    let (mut from_daemon, mut to_daemon) = tokio::io::split(ours);
    let begin = Instant::now();
    let now_us = || u64::try_from(begin.elapsed().as_micros()).unwrap_or(u64::MAX);
    let (mut heard, mut waiting) = ([0; QUEUE], Vec::new());
    let mut fresh = [0; QUEUE];
    loop {
        let count = wire.may_send(now_us(), waiting.len());
        if count > 0 {
            let turn: Vec<u8> = waiting.drain(..count).collect();
            wire.sent(now_us(), &turn);
            driver = match driver {
                None => {
                    port.write_all(&turn).await?;
                    None
                }
                Some(driver) => Some(send_driven(port, &turn, driver).await?),
            };
        }
        let again = begin + Duration::from_micros(wire.ask_again_us(now_us()));
        tokio::select! {
            read = port.read(&mut heard) => {
                let mut bytes = match read? {
                    0 => return Ok(()),
                    count => heard.get(..count).unwrap_or_default().to_vec(),
                };
                wire.receive(now_us(), &mut bytes);
                to_daemon.write_all(&bytes).await?;
            }
            read = from_daemon.read(&mut fresh), if waiting.len() < QUEUE => match read? {
                0 => return Ok(()),
                count => waiting.extend_from_slice(fresh.get(..count).unwrap_or_default()),
            },
            () = tokio::time::sleep_until(again), if !waiting.is_empty() => {}
        }
    }
}

#[cfg(test)]
mod tests;
