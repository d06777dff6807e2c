//! A session with a debugger.

use super::commands::{PacketReply, answer};
use super::packet::{PacketEvent, PacketFramer, framed};
use super::{DebugTarget, Stop};

/// The state of the conversation.
#[derive(Clone, Debug)]
pub struct Session {
    framer: PacketFramer,
    output: Vec<u8>,
    /// The last packet, in case it was not understood.
    last: Vec<u8>,
    is_running: bool,
    is_over: bool,
    acknowledges: bool,
    stop: Stop,
}

impl Default for Session {
    fn default() -> Self {
        Self::new()
    }
}

impl Session {
    /// A session with the program stopped.
    pub fn new() -> Self {
        Self {
            framer: PacketFramer::default(),
            output: Vec::new(),
            last: Vec::new(),
            is_running: false,
            is_over: false,
            acknowledges: true,
            stop: Stop::Stepped,
        }
    }

    /// Takes bytes of the debugger and does what they ask.
    pub fn receive(&mut self, bytes: &[u8], target: &mut dyn DebugTarget) {
        for byte in bytes {
            if let Some(event) = self.framer.take(*byte) {
                self.handle(event, target);
            }
        }
    }

    /// Whether the program runs: then [`Self::run`] must be called repeatedly.
    pub fn is_running(&self) -> bool {
        self.is_running
    }

    /// Whether the debugger has left.
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Lets the program run for a moment.
    pub fn run(&mut self, target: &mut dyn DebugTarget) {
        if self.is_running
            && let Some(stop) = target.run()
        {
            self.stopped(stop);
        }
    }

    /// Bytes for the debugger since the last call.
    pub fn take_output(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.output)
    }

    fn handle(&mut self, event: PacketEvent, target: &mut dyn DebugTarget) {
        match event {
            PacketEvent::Interrupt if self.is_running => self.stopped(Stop::Interrupted),
            // It is stopped already.
            PacketEvent::Interrupt => {}
            PacketEvent::Refused => self.output.extend_from_slice(&self.last),
            PacketEvent::Damaged => self.output.push(b'-'),
            PacketEvent::Packet(packet) => {
                if self.acknowledges {
                    self.output.push(b'+');
                }
                self.command(&packet, target);
            }
        }
    }

    fn command(&mut self, packet: &[u8], target: &mut dyn DebugTarget) {
        match answer(packet, target) {
            PacketReply::Text(text) => self.send(text.as_bytes()),
            PacketReply::Why => self.send(stop_reply(self.stop).as_bytes()),
            PacketReply::Run => self.is_running = true,
            PacketReply::Stop(stop) => self.stopped(stop),
            PacketReply::WithoutAcknowledgement => {
                self.send(b"OK");
                self.acknowledges = false;
            }
            PacketReply::Leave => {
                self.send(b"OK");
                self.is_over = true;
            }
            PacketReply::Kill => self.is_over = true,
        }
    }

    fn stopped(&mut self, stop: Stop) {
        self.is_running = false;
        self.stop = stop;
        self.send(stop_reply(stop).as_bytes());
    }

    fn send(&mut self, text: &[u8]) {
        self.last = framed(text);
        self.output.extend_from_slice(&self.last);
    }
}

/// A stop as a POSIX signal, as the protocol encodes it.
fn stop_reply(stop: Stop) -> &'static str {
    match stop {
        Stop::Stepped => "T05thread:1;",
        Stop::Breakpoint => "T05thread:1;swbreak:;",
        Stop::Interrupted => "T02thread:1;",
        Stop::BadAddress => "T0bthread:1;",
        Stop::BadInstruction => "T04thread:1;",
        Stop::Trapped => "T05thread:1;",
    }
}
