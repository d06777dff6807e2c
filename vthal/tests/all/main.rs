//! The real daemon as a process of its own; one program, so that it is linked once.

mod daemon;
mod floors;
mod hostile_clients;
mod kept;
mod learnt;
mod links;
mod radio;
mod recording;
mod scripts;
