//! C interface of cordlib
