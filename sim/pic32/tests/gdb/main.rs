//! The debugger's protocol: a conversation in memory, and one with gdb-multiarch itself.

mod conversation;
mod program;
mod real;
