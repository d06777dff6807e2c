//! Clients of the simulator's socket, with bounded queues: no client can block another.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;

use rvac_api::{Failure, SEPARATOR};
use serde::Serialize;

use super::request::SimulatorRequest;
use super::socket::SocketListener;

/// Most clients at once; later ones are turned away.
const CLIENTS_MAX: usize = 64;
/// A client whose unread bytes exceed this is dropped; the plan of a large home has its place besides.
const BACKLOG_MAX: usize = 256 * 1024;
/// Longest request.
const REQUEST_MAX: usize = 4096;

/// A client, by a number that is never used again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number(u64);

#[derive(Debug)]
struct Client {
    number: Number,
    stream: UnixStream,
    inbound: Vec<u8>,
    outbound: Vec<u8>,
    backlog_max: usize,
    /// It will ask nothing more, but may still listen: `printf ... | socat` ends its side as soon as all is said.
    has_asked_all: bool,
    gone: bool,
}

/// All clients.
#[derive(Debug)]
pub(crate) struct Clients {
    greeting: Vec<u8>,
    clients: Vec<Client>,
    next: u64,
}

impl Clients {
    /// Nobody yet; each gets `greeting` first.
    pub(crate) fn new(greeting: &impl Serialize) -> Self {
        Self {
            greeting: packed(greeting),
            clients: Vec::new(),
            next: 0,
        }
    }

    /// Takes all who wait.
    pub(crate) fn accept(&mut self, listener: &SocketListener) -> io::Result<()> {
        while let Some(stream) = listener.accept()? {
            if self.clients.len() < CLIENTS_MAX {
                self.next += 1;
                self.clients.push(Client {
                    number: Number(self.next),
                    stream,
                    inbound: Vec::new(),
                    outbound: self.greeting.clone(),
                    backlog_max: self.greeting.len() + BACKLOG_MAX,
                    has_asked_all: false,
                    gone: false,
                });
            }
        }
        Ok(())
    }

    /// Where to listen for requests.
    pub(crate) fn sources(&self) -> impl Iterator<Item = &UnixStream> {
        self.clients
            .iter()
            .filter(|client| !client.has_asked_all)
            .map(|client| &client.stream)
    }

    /// What clients ask now.
    pub(crate) fn requests(&mut self) -> Vec<(Number, Result<SimulatorRequest, Failure>)> {
        let mut requests = Vec::new();
        for client in &mut self.clients {
            client.read();
            while let Some(message) = client.next_message() {
                requests.push((client.number, SimulatorRequest::read(&message)));
            }
        }
        self.clients.retain(|client| !client.gone);
        requests
    }

    /// Answers one client, if it is still there.
    pub(crate) fn answer(&mut self, number: Number, answer: &impl Serialize) {
        if let Some(client) = self.clients.iter_mut().find(|client| client.number == number) {
            client.queue(&packed(answer));
        }
    }

    /// Tells all who have read everything before; the others get a newer one later.
    pub(crate) fn tell_newest(&mut self, update: &impl Serialize) {
        if self.clients.is_empty() {
            return;
        }
        let message = packed(update);
        for client in self
            .clients
            .iter_mut()
            .filter(|client| client.outbound.is_empty())
        {
            client.queue(&message);
        }
    }

    /// Writes what the sockets take.
    pub(crate) fn flush(&mut self) {
        for client in &mut self.clients {
            client.write();
        }
        self.clients.retain(|client| !client.gone);
    }
}

impl Client {
    fn queue(&mut self, message: &[u8]) {
        if self.outbound.len() + message.len() > self.backlog_max {
            self.gone = true;
        } else {
            self.outbound.extend_from_slice(message);
        }
    }

    fn read(&mut self) {
        let mut buffer = [0; REQUEST_MAX];
        match self.stream.read(&mut buffer) {
            // Who does not listen any more is found out at the next word to all.
            Ok(0) => self.has_asked_all = true,
            Ok(count) => self.inbound.extend_from_slice(&buffer[..count]),
            Err(error) if would_wait(&error) => {}
            Err(_) => self.gone = true,
        }
        if self.inbound.len() > REQUEST_MAX && !self.inbound.contains(&SEPARATOR) {
            self.gone = true;
        }
    }

    fn next_message(&mut self) -> Option<Vec<u8>> {
        loop {
            let end = self.inbound.iter().position(|byte| *byte == SEPARATOR)?;
            let mut message: Vec<u8> = self.inbound.drain(..=end).collect();
            message.pop();
            if !message.is_empty() {
                return Some(message);
            }
        }
    }

    fn write(&mut self) {
        while !self.outbound.is_empty() {
            match self.stream.write(&self.outbound) {
                Ok(0) => break,
                Ok(count) => {
                    self.outbound.drain(..count);
                }
                Err(error) if would_wait(&error) => break,
                Err(_) => {
                    self.gone = true;
                    break;
                }
            }
        }
    }
}

fn would_wait(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
    )
}

fn packed(message: &impl Serialize) -> Vec<u8> {
    // Plain structs of numbers and strings: there is nothing in them that JSON cannot hold.
    let mut bytes = serde_json::to_vec(message).expect("plain data becomes JSON");
    bytes.push(SEPARATOR);
    bytes
}
