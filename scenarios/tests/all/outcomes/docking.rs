//! docking
