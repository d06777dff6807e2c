//! linux_board
