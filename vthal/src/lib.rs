//! The daemon on the Linux board
