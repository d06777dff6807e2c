//! A line over which nothing of a robot has ever come.

use vthal_core::{Core, CoreConfig, Input, Outputs};

/// Hands over these bytes each hundredth of a second, and gives state and reason afterwards.
fn hear(core: &mut Core, (from_ms, to_ms): (u64, u64), bytes: &[u8]) -> (String, String) {
    let mut outputs = Outputs::default();
    for ms in (from_ms..to_ms).step_by(10) {
        let input = if bytes.is_empty() {
            Input::Wake
        } else {
            Input::LinkBytes(bytes)
        };
        core.handle(ms * 1_000, input, &mut outputs);
        outputs.clear();
    }
    let status = core.status();
    (status.state, status.reason)
}

#[test]
fn garbage_from_the_start_has_a_name_and_silence_has_another() {
    let mut core = Core::new(CoreConfig::default());
    core.handle(0, Input::LinkOpened, &mut Outputs::default());
    let named = |reason: &str| ("disconnected".to_owned(), reason.to_owned());
    assert_eq!(hear(&mut core, (10, 1_000), b"login:\x1f"), named("no-robot"));
    assert_eq!(
        hear(&mut core, (1_000, 3_000), b"login:\x1f"),
        named("link-garbled")
    );
    assert_eq!(hear(&mut core, (3_000, 6_000), b""), named("no-robot"));
    let prompt = b"\r\nDebian GNU/Linux 13 robot ttyS0\r\nrobot login: ";
    assert_eq!(
        hear(&mut core, (6_000, 10_000), prompt),
        named("line-has-console")
    );
    let noise: Vec<u8> = (0..23_u8).map(|number| number.wrapping_mul(193)).collect();
    assert_eq!(
        hear(&mut core, (10_000, 17_000), &noise),
        named("line-wrong-speed"),
        "a cause that changes is told"
    );
}
