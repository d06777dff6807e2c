//! The real daemon as a process of its own; one program, so that it is linked once.

mod daemon;
mod damaged_files;
mod floors;
mod hostile_clients;
mod hostile_robot;
mod kept;
mod learnt;
mod links;
mod little_memory;
mod radio;
mod recording;
mod scripts;
