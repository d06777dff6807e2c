//! The bodies of the fuzz targets on mutated golden packets: the same inputs in every run, some 10^5 of them.

#[path = "../../fuzz/bodies.rs"]
mod bodies;
#[path = "../../fuzz/golden.rs"]
mod golden;

const INPUTS: u32 = 40_000;

struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % end.max(1)
    }

    fn mutate(&mut self, input: &mut Vec<u8>) {
        const TOKENS: [&[u8]; 12] = [
            b"{", b"}", b"[", b"\"", b"\\u", b"*", b",", b"1e9", b"-", b"\x1f", b"\x1d", b"null",
        ];
        for _ in 0..=self.below(3) {
            let at = self.below(input.len());
            match self.below(6) {
                0 if !input.is_empty() => input[at] ^= 1 << self.below(8),
                1 if !input.is_empty() => drop(input.remove(at)),
                2 => input.insert(at, self.below(256) as u8),
                3 => input.truncate(at),
                4 => drop(input.splice(at..at, TOKENS[self.below(TOKENS.len())].iter().copied())),
                _ => {
                    let copy: Vec<u8> = input.iter().skip(at).take(20).copied().collect();
                    input.extend(copy);
                }
            }
        }
    }
}

fn check(inputs: u32, body: fn(&[u8])) {
    let seeds = golden::pieces();
    let mut random = Random(1);
    for seed in &seeds {
        body(seed);
    }
    for _ in 0..inputs {
        let mut input = seeds[random.below(seeds.len())].clone();
        random.mutate(&mut input);
        body(&input);
    }
}

#[test]
fn command_text() {
    check(INPUTS, bodies::command_text);
}

#[test]
fn report_text() {
    check(INPUTS, bodies::report_text);
}

#[test]
fn binary() {
    check(INPUTS, bodies::binary);
}

#[test]
fn sessions() {
    check(INPUTS / 10, bodies::sessions);
}

#[test]
fn inputs_of_any_length() {
    for length in (0..2_000).chain([100_000]) {
        let input: Vec<u8> = (0..length).map(|index| (index * 131 + length) as u8).collect();
        bodies::command_text(&input);
        bodies::report_text(&input);
        bodies::binary(&input);
        bodies::command_text(&[b"{\"c\":\"info\",\"x\":".as_slice(), &vec![b'['; length]].concat());
    }
    bodies::sessions(&vec![b'{'; 10_000]);
}
