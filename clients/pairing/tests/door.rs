//! Windows, attempts and races on a virtual clock.
#![allow(clippy::unwrap_used, reason = "in a test that is what a failure is")]

use pairing::wire::{Begin, Finish, Joined};
use pairing::{
    ATTEMPTS_MAX, AskingDevice, CLIENTS_MAX, Code, DeviceName, Door, Ends, Guest, MATCHING_MAX, Moment,
    OPEN_US, REOPENING_US, Refusal, RobotId, Role, Token, TokenId, Wanted,
};

const SECOND: u64 = 1_000_000;

/// A door, the time, and bytes that differ each time.
struct Hall {
    door: Door,
    now_us: u64,
    drawn: u64,
}

fn robot() -> RobotId {
    RobotId::of_public_key(b"a robot")
}

impl Hall {
    fn new() -> Self {
        Self::with_seed(0)
    }

    fn with_seed(seed: u64) -> Self {
        Self {
            door: Door::new(0, robot(), None).unwrap(),
            now_us: 0,
            drawn: seed << 32,
        }
    }

    fn random<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        for byte in &mut bytes {
            self.drawn += 1;
            // A finalizer of SplitMix64: neighbours share nothing.
            let mut x = self.drawn.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            *byte = (x ^ (x >> 27)) as u8;
        }
        bytes
    }

    fn open(&mut self) -> Result<Code, Refusal> {
        let random = self.random();
        let opened = self.door.open(self.now_us, Role::Drive, random)?;
        Ok(Code::parse(&opened.code).unwrap())
    }

    /// The proof of a guest who was given this code.
    fn begin(&mut self, code: &Code) -> Result<Finish, Refusal> {
        let name = DeviceName::new("phone").unwrap();
        let robot = robot();
        let ends = Ends {
            guest: &name,
            robot: robot.full(),
        };
        let (guest, message) = Guest::begin(code, ends, self.random());
        let random = self.random();
        let begun = self.door.begin(self.now_us, Begin { name, message }, &random)?;
        let (_, proof) = guest.hear(&begun.message).unwrap();
        Ok(Finish {
            attempt: begun.attempt,
            proof,
        })
    }

    fn finish(&mut self, finish: &Finish) -> Result<Token, Refusal> {
        let random = self.random();
        let now = Moment {
            now_us: self.now_us,
            unix_s: 1_700_000_000,
        };
        let (_, token) = self.door.finish(now, finish, &random)?;
        Ok(token)
    }

    fn try_code(&mut self, code: &Code) -> Result<Token, Refusal> {
        let finish = self.begin(code)?;
        self.finish(&finish)
    }

    fn hold_start(&mut self) -> Result<(), Refusal> {
        let random = self.random();
        self.door.open_by_button(self.now_us, random)
    }

    fn join(&mut self, from: &str) -> Result<Joined, Refusal> {
        let name = DeviceName::new(from).unwrap();
        let random = self.random();
        self.door.join(self.now_us, AskingDevice { name, from }, random)
    }

    fn press(&mut self, pattern: [u8; 2]) {
        for count in pattern {
            for _ in 0..count {
                self.now_us += SECOND / 2;
                self.door.press(self.now_us);
                self.door.judge_presses(self.now_us);
            }
            self.now_us += 2 * SECOND;
        }
        self.now_us += SECOND;
        self.door.judge_presses(self.now_us);
    }

    fn ask(&mut self, joined: &Joined) -> Result<Option<TokenId>, Refusal> {
        let random = self.random();
        let now = Moment {
            now_us: self.now_us,
            unix_s: 1_700_000_000,
        };
        let matched = self.door.ask_matched(now, &joined.session, &random)?;
        Ok(matched.map(|(_, token)| token.id()))
    }

    /// The server is killed and started again after what it has written.
    fn kill(&mut self) {
        let stored = self.door.stored();
        self.door = Door::new(self.now_us, robot(), Some(&stored)).unwrap();
    }
}

fn other_than(code: &Code) -> Code {
    let [first, second] = ["00000000", "11111111"].map(|digits| Code::parse(digits).unwrap());
    if first == *code { second } else { first }
}

#[test]
fn a_guest_with_the_code_becomes_a_client_and_the_window_shuts() {
    let mut hall = Hall::new();
    let code = hall.open().unwrap();
    let token = hall.try_code(&code).unwrap();
    let client = hall.door.register().admit(&token).unwrap();
    assert_eq!((client.name.as_str(), client.role), ("phone", Role::Drive));
    assert_eq!(
        hall.try_code(&code).unwrap_err(),
        Refusal::WindowShut,
        "one success"
    );
    hall.kill();
    assert!(
        hall.door.register().admit(&token).is_some(),
        "known after a crash"
    );
    hall.door.revoke(token.id()).unwrap();
    assert!(hall.door.register().admit(&token).is_none());
    assert_eq!(hall.door.revoke(token.id()), Err(Refusal::NoClient));
}

#[test]
fn nobody_is_let_in_while_no_window_is_open() {
    let mut hall = Hall::new();
    let guessed = Code::parse("12345678").unwrap();
    assert_eq!(hall.begin(&guessed).unwrap_err(), Refusal::WindowShut);
    let code = hall.open().unwrap();
    let begun = hall.begin(&code).unwrap();
    hall.now_us += OPEN_US - 1;
    assert!(hall.door.is_open(hall.now_us));
    hall.now_us += 1;
    assert_eq!(hall.finish(&begun).unwrap_err(), Refusal::WindowShut, "too late");
    assert_eq!(hall.begin(&code).unwrap_err(), Refusal::WindowShut);
}

#[test]
fn a_code_of_an_earlier_window_is_worth_nothing() {
    let mut hall = Hall::new();
    let old = hall.open().unwrap();
    let begun = hall.begin(&old).unwrap();
    let new = hall.open().unwrap();
    assert_ne!(old, new);
    assert_eq!(hall.finish(&begun).unwrap_err(), Refusal::NoAttempt);
    assert!(matches!(hall.try_code(&old), Err(Refusal::WrongCode { .. })));
}

#[test]
fn five_wrong_codes_shut_the_window_and_each_such_window_makes_the_next_wait_longer() {
    let mut hall = Hall::new();
    for pause_us in REOPENING_US.into_iter().chain([3_600 * SECOND]) {
        let code = hall.open().unwrap();
        let wrong = other_than(&code);
        for left in (0..ATTEMPTS_MAX).rev() {
            assert_eq!(hall.try_code(&wrong).unwrap_err(), Refusal::WrongCode { left });
        }
        assert_eq!(
            hall.try_code(&code).unwrap_err(),
            Refusal::WindowShut,
            "the right one comes too late"
        );
        if pause_us > 0 {
            let seconds = pause_us / SECOND;
            assert_eq!(hall.open().unwrap_err(), Refusal::Waiting { seconds });
            hall.now_us += pause_us - 1;
            hall.open().unwrap_err();
            hall.now_us += 1;
        }
    }
    let code = hall.open().unwrap();
    hall.try_code(&code).unwrap();
    let code = hall.open().unwrap();
    hall.try_code(&other_than(&code)).unwrap_err();
    hall.open().expect("a success forgets what was before");
}

#[test]
fn ending_the_server_buys_no_guess() {
    let mut hall = Hall::new();
    let mut guesses = 0;
    // A window is opened again after each kill, as a patient owner would.
    while let Ok(code) = hall.open() {
        let wrong = other_than(&code);
        hall.begin(&wrong).unwrap();
        guesses += 1;
        hall.kill();
        assert!(!hall.door.is_open(hall.now_us), "a window does not survive");
        assert!(guesses < 100, "the attempts are forgotten");
    }
    // Two windows without a pause, and the third has to be waited for.
    assert_eq!(guesses, 3 * u32::from(ATTEMPTS_MAX));
    hall.kill();
    assert!(
        matches!(hall.open(), Err(Refusal::Waiting { .. })),
        "nor does it end a pause"
    );
}

#[test]
fn hundred_thousand_guesses_are_five_a_window() {
    let mut hall = Hall::new();
    let (mut guessed, mut windows) = (0, 0);
    for attempt in 0..100_000_u32 {
        if attempt.is_multiple_of(100) && hall.open().is_ok() {
            windows += 1;
        }
        if attempt.is_multiple_of(700) {
            hall.kill();
        }
        let guess = Code::parse(&format!("{attempt:08}")).unwrap();
        // The cheap refusals come before any arithmetic, which is what makes this test possible.
        if !hall.door.is_open(hall.now_us) {
            continue;
        }
        match hall.try_code(&guess) {
            Ok(_) => panic!("a guess of 10^-8 came true; the bytes of this test are fixed"),
            Err(Refusal::WrongCode { .. }) => guessed += 1,
            Err(refusal) => assert!(matches!(refusal, Refusal::NoAttemptsLeft | Refusal::WindowShut)),
        }
        hall.now_us += SECOND / 10;
    }
    assert!(
        guessed <= windows * u32::from(ATTEMPTS_MAX),
        "{guessed} in {windows}"
    );
    assert!(windows < 20, "{windows}: the pauses hold");
}

#[test]
fn of_two_who_race_exactly_one_comes_in() {
    for seed in 0..500 {
        let mut hall = Hall::with_seed(seed);
        let code = hall.open().unwrap();
        let first = hall.begin(&code).unwrap();
        let second = hall.begin(&code).unwrap();
        let order = if seed.is_multiple_of(2) {
            [first, second]
        } else {
            [second, first]
        };
        let [winner, loser] = order.map(|finish| hall.finish(&finish));
        assert!(winner.is_ok());
        assert_eq!(loser.unwrap_err(), Refusal::WindowShut);
        assert_eq!(hall.door.register().iter().count(), 1);
    }
}

#[test]
fn what_lies_on_the_disk_opens_nothing() {
    let mut hall = Hall::new();
    let code = hall.open().unwrap();
    let token = hall.try_code(&code).unwrap();
    let stored = hall.door.stored();
    let (_, secret) = {
        let text = token.text();
        let (a, b) = text.split_once('.').unwrap();
        (a.to_owned(), b.to_owned())
    };
    assert!(!stored.contains(&secret));
    let words: Vec<&str> = stored
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    for word in &words {
        for id in &words {
            let tried = Token::parse(&format!("{id}.{word}"));
            assert!(
                tried.is_none_or(|tried| hall.door.register().admit(&tried).is_none()),
                "{id}.{word}"
            );
        }
    }
}

#[test]
fn a_full_register_lets_nobody_in_and_damaged_ones_are_reported() {
    let mut hall = Hall::new();
    for _ in 0..CLIENTS_MAX {
        let random = hall.random();
        let wanted = Wanted {
            name: DeviceName::new("script").unwrap(),
            role: Role::View,
        };
        hall.door.add(0, wanted, &random).unwrap();
    }
    let code = hall.open().unwrap();
    assert_eq!(hall.begin(&code).unwrap_err(), Refusal::Full);
    let stored = hall.door.stored();
    let damaged = [
        stored.replacen("\"version\": 1", "\"version\": 2", 1),
        stored.replacen(": \"view\"", ": \"king\"", 1),
        stored[..stored.len() / 2].to_owned(),
        String::new(),
    ];
    for text in damaged {
        assert!(Door::new(0, robot(), Some(&text)).is_err(), "{text}");
    }
}

#[test]
fn the_device_whose_presses_come_is_let_in_to_drive_and_nobody_else() {
    let mut hall = Hall::new();
    assert_eq!(hall.join("phone").unwrap_err(), Refusal::WindowShut);
    hall.hold_start().unwrap();
    assert_eq!(hall.hold_start(), Err(Refusal::OpenAlready));
    let [phone, thief] = ["phone", "thief"].map(|from| hall.join(from).unwrap());
    assert!(hall.door.waits_for_presses(hall.now_us));
    assert_eq!(hall.ask(&phone), Ok(None));
    hall.press(phone.presses);
    assert_eq!(hall.ask(&thief), Err(Refusal::NotMatched));
    let id = hall.ask(&phone).unwrap().unwrap();
    let client = hall.door.register().get(id).unwrap();
    assert_eq!((client.name.as_str(), client.role), ("phone", Role::Drive));
    assert_eq!(hall.ask(&phone), Err(Refusal::NoAttempt), "once");
    assert!(!hall.door.is_open(hall.now_us), "one success");
}

#[test]
fn one_wrong_pattern_ends_the_window() {
    let mut hall = Hall::new();
    hall.hold_start().unwrap();
    let phone = hall.join("phone").unwrap();
    hall.press([1, 0]);
    assert_eq!(hall.ask(&phone), Ok(None), "the second group may come");
    hall.now_us += 10 * SECOND;
    hall.door.judge_presses(hall.now_us);
    assert_eq!(hall.ask(&phone), Err(Refusal::NotMatched));
    assert!(!hall.door.is_open(hall.now_us));
    hall.press(phone.presses);
    assert_eq!(hall.ask(&phone), Err(Refusal::NotMatched), "too late");
    assert_eq!(hall.join("phone").unwrap_err(), Refusal::WindowShut);
}

#[test]
fn a_window_by_the_button_takes_no_code_and_a_code_no_presses() {
    let mut hall = Hall::new();
    hall.hold_start().unwrap();
    let guess = Code::parse("12345678").unwrap();
    assert_eq!(hall.begin(&guess).unwrap_err(), Refusal::WindowShut);
    let phone = hall.join("phone").unwrap();
    let code = hall.open().unwrap();
    assert_eq!(hall.ask(&phone), Err(Refusal::NoAttempt), "the console was later");
    hall.press(phone.presses);
    assert!(hall.door.register().iter().next().is_none());
    assert_eq!(hall.hold_start(), Err(Refusal::OpenAlready));
    hall.try_code(&code).unwrap();
}

#[test]
fn a_button_that_is_stuck_and_let_go_again_and_again_keeps_no_window_open() {
    let mut hall = Hall::new();
    let (mut opened, mut open_for_us) = (0, 0);
    for _ in 0..24 * 3600 {
        if hall.hold_start().is_ok() {
            opened += 1;
        }
        open_for_us += SECOND * u64::from(hall.door.is_open(hall.now_us));
        hall.now_us += SECOND;
        if hall.now_us.is_multiple_of(7000 * SECOND) {
            hall.kill();
        }
    }
    assert!(opened <= 28, "{opened} windows in a day");
    assert!(open_for_us <= opened * OPEN_US);
    let code = hall.open().expect("the console is not kept out");
    hall.try_code(&code).unwrap();
    hall.hold_start().expect("a success forgets what was before");
}

#[test]
fn presses_come_too_late_when_the_window_is_over() {
    let mut hall = Hall::new();
    hall.hold_start().unwrap();
    let phone = hall.join("phone").unwrap();
    hall.press(phone.presses);
    hall.now_us += OPEN_US;
    assert_eq!(hall.ask(&phone), Err(Refusal::WindowShut));
    assert!(hall.door.register().iter().next().is_none());
}

#[test]
fn four_devices_can_ask_and_no_two_for_the_same() {
    let mut hall = Hall::new();
    hall.hold_start().unwrap();
    let mut shown: Vec<[u8; 2]> = (0..MATCHING_MAX)
        .map(|number| hall.join(&format!("device {number}")).unwrap().presses)
        .collect();
    assert_eq!(hall.join("one more").unwrap_err(), Refusal::TooManyWait);
    shown.sort_unstable();
    shown.dedup();
    assert_eq!(shown.len(), MATCHING_MAX);
}
