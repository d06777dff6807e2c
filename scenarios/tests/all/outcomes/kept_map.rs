//! kept_map
