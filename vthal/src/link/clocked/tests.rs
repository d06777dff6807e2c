//! The thread between a made-up bus and the daemon's stream. Waits are for bytes.

use std::fmt::Display;
use std::path::Path;
use std::sync::{Arc, Mutex};

use robot_link::{I2cBus, I2cHost, SpiBus, SpiHost, TransfersOver};
use rvac_protocol::fill::{FillDecoder, encode};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

use super::start;

/// Says what it hears, and fails when it hears a `!`.
#[derive(Clone, Debug, Default)]
struct Parrot {
    line: Arc<Mutex<Vec<u8>>>,
    decoder: FillDecoder,
}

impl SpiBus for Parrot {
    type Error = String;

    fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), String> {
        let mut line = self.line.lock().expect("one thread");
        for byte in bytes {
            match self.decoder.push(*byte) {
                Some(b'!') => return Err("the bus broke".to_owned()),
                heard => line.extend(heard.into_iter().flat_map(encode)),
            }
            *byte = if line.is_empty() { 0 } else { line.remove(0) };
        }
        Ok(())
    }
}

impl I2cBus for Parrot {
    type Error = String;

    fn read(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), String> {
        let mut line = self.line.lock().expect("one thread");
        if register == 0 {
            bytes.copy_from_slice(&[line.len().min(255) as u8, 32]);
        } else {
            for byte in bytes {
                *byte = line.remove(0);
            }
        }
        Ok(())
    }

    fn write(&mut self, _: u8, bytes: &[u8]) -> Result<(), String> {
        if bytes.contains(&b'!') {
            return Err("the bus broke".to_owned());
        }
        self.line.lock().expect("one thread").extend(bytes);
        Ok(())
    }
}

async fn passes_everything_and_says_why_it_ended<H>(host: H)
where
    H: TransfersOver<Parrot, Error: Display> + Send + 'static,
{
    let (mut stream, complaint) =
        start(host, Parrot::default(), (Path::new("/dev/bus"), None)).expect("starts");
    let said: Vec<u8> = (0..=255)
        .filter(|byte| *byte != b'!')
        .cycle()
        .take(3_000)
        .collect();
    let mut heard = vec![0; said.len()];
    let (mut reader, mut writer) = stream.split();
    let (sent, read) = tokio::join!(writer.write_all(&said), reader.read_exact(&mut heard));
    sent.expect("sends");
    read.expect("reads");
    assert_eq!(heard, said);
    stream.write_all(b"!").await.expect("sends");
    assert_eq!(stream.read(&mut heard).await.expect("ends"), 0);
    assert_eq!(complaint.get().map(String::as_str), Some("the bus broke"));
}

#[tokio::test]
async fn spi_passes_everything_and_says_why_it_ended() {
    passes_everything_and_says_why_it_ended(SpiHost::default()).await;
}

#[tokio::test]
async fn i2c_passes_everything_and_says_why_it_ended() {
    passes_everything_and_says_why_it_ended(I2cHost::default()).await;
}
