//! The real daemon as a process of its own; one program, so that it is linked once.

mod daemon;
mod damaged_files;
mod floors;
mod hostile_clients;
mod hostile_robot;
mod kept;
mod kept_home;
mod learnt;
mod links;
mod nonsense;
mod radio;
mod recording;
mod scripts;
