//! Data types of the brain that all layers share, and their basic arithmetic.

pub mod action;
pub(crate) mod advance;
pub mod command;
pub mod config;
pub(crate) mod cut_line;
pub(crate) mod decision;
pub(crate) mod edit_error;
pub mod energy;
pub(crate) mod fault;
pub mod geometry;
pub(crate) mod gradual;
pub(crate) mod inhibit;
pub(crate) mod job_refusal;
pub(crate) mod kept_place;
pub mod learnt;
pub(crate) mod map_edit;
pub(crate) mod named_enum;
pub mod no_go;
pub mod observation;
pub mod order;
pub(crate) mod pose_estimate;
pub(crate) mod random;
pub(crate) mod reason;
pub mod room_settings;
pub(crate) mod swept_share;
pub mod zone;
