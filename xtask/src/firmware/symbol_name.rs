//! Names of Rust functions as people write them, without the compiler's decoration.

/// The path in a mangled name, `core::panicking::panic`; other names stay as they are.
pub(super) fn readable(symbol: &str) -> String {
    let path = match (symbol.strip_prefix("_R"), symbol.strip_prefix("_ZN")) {
        (Some(rest), _) => path(rest),
        (None, Some(rest)) => path(rest.strip_suffix('E').unwrap_or(rest)),
        (None, None) => return symbol.to_owned(),
    };
    let mut parts: Vec<&str> = path;
    // The old scheme ends with a hash.
    let is_hash = |part: &&str| part.len() == 17 && part.starts_with('h');
    if symbol.starts_with("_ZN") && parts.last().is_some_and(is_hash) {
        parts.pop();
    }
    if parts.is_empty() {
        symbol.to_owned()
    } else {
        parts.join("::")
    }
}

/// The identifiers in the order in which they stand: a length, then that many letters. Marks between them that hold digits
/// of their own are skipped: `s..._` tells crates and closures of one name apart, `B..._` refers back, `K._` is a constant.
fn path(mut rest: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    while let Some(first) = rest.chars().next() {
        if first.is_ascii_digit() {
            let digits = rest.len()
                - rest
                    .trim_start_matches(|letter: char| letter.is_ascii_digit())
                    .len();
            let (number, after) = rest.split_at(digits);
            let after = after.strip_prefix('_').unwrap_or(after);
            let length = number.parse().unwrap_or(0);
            let (Some(part), Some(tail)) = (after.get(..length), after.get(length..)) else {
                break;
            };
            if !part.is_empty() {
                parts.push(part);
            }
            rest = tail;
        } else if matches!(first, 's' | 'B' | 'K') {
            rest = rest.split_once('_').map_or("", |(_, tail)| tail);
        } else {
            rest = rest.get(first.len_utf8()..).unwrap_or_default();
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::readable;

    #[test]
    fn both_schemes_and_plain_names_are_read() {
        let table = [
            (
                "_RNvNtCs1ixzXYvLUZW_4core9panicking5panic",
                "core::panicking::panic",
            ),
            (
                "_RNvNtNtCsa1z0kcWjBHY_13rvac_protocol4text12command_read10read_ratioKj4_EB6_",
                "rvac_protocol::text::command_read::read_ratio",
            ),
            ("_RNCNvCs1234_7mycrate3foos_0B3_", "mycrate::foo"),
            (
                "_ZN4core9panicking5panic17h0123456789abcdefE",
                "core::panicking::panic",
            ),
            ("__adddf3", "__adddf3"),
            ("_start", "_start"),
        ];
        for (symbol, wanted) in table {
            assert_eq!(readable(symbol), wanted, "{symbol}");
        }
    }
}
