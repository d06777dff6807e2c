//! A line of progress with the time that is left.

const WIDTH: usize = 30;

/// The line after so much of the work in so many milliseconds.
pub fn progress_line(what: &str, (done, total): (usize, usize), elapsed_ms: u64) -> String {
    let total = total.max(1);
    let done = done.min(total);
    let filled = done * WIDTH / total;
    let bar: String = (0..WIDTH)
        .map(|place| if place < filled { '#' } else { '.' })
        .collect();
    let percent = done * 100 / total;
    let left = match elapsed_ms * (total - done) as u64 {
        _ if done == 0 => String::new(),
        scaled => {
            let seconds = (scaled / done as u64).div_ceil(1_000);
            format!(", {}:{:02} left", seconds / 60, seconds % 60)
        }
    };
    format!("{what:<8} [{bar}] {percent:>3} %{left}")
}

#[cfg(test)]
mod tests {
    use super::progress_line;

    #[test]
    fn the_time_left_follows_from_the_time_gone() {
        let line = progress_line("write", (25, 100), 20_000);
        assert_eq!(line, "write    [#######.......................]  25 %, 1:00 left");
        assert_eq!(progress_line("read", (0, 100), 0).matches('#').count(), 0);
        assert!(progress_line("read", (100, 100), 9_999).ends_with("100 %, 0:00 left"));
        assert!(progress_line("read", (5, 0), 1).contains("100 %"));
    }
}
