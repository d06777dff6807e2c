//! A serial device with one wire, or one pair, for both directions: a task between it and the stream that the daemon sees.

use std::io;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use robot_link::OneWire;
use serial2_tokio::SerialPort;
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream};
use tokio::task::spawn_local;
use tokio::time::Instant;

/// Bytes that may wait in each direction.
const QUEUE: usize = 4096;

/// Begins to serve the device. It ends with the stream, and the stream with it.
pub(super) fn start(port: SerialPort, wire: OneWire) -> (DuplexStream, Arc<OnceLock<String>>) {
    let (ours, theirs) = tokio::io::duplex(QUEUE);
    let complaint = Arc::new(OnceLock::new());
    let told = Arc::clone(&complaint);
    spawn_local(async move {
        if let Err(error) = take_turns(&port, ours, wire).await {
            // The first reason stays.
            told.set(error.to_string()).ok();
        }
    });
    (theirs, complaint)
}

async fn take_turns(port: &SerialPort, ours: DuplexStream, mut wire: OneWire) -> io::Result<()> {
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
            port.write_all(&turn).await?;
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
