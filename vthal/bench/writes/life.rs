//! A program that keeps something for people, from its start to its kill.

use std::collections::BTreeMap;

/// What is kept: each item as text, whole, with the number or name by which the program knows it. Two states are the same when
/// their texts are.
pub(crate) type Kept = BTreeMap<String, String>;

/// The program that keeps one kind, and what it needs around it.
pub(crate) trait Keeper {
    /// The kind, for people and figures.
    fn name(&self) -> &'static str;

    /// Starts the program.
    fn start(&self) -> anyhow::Result<Box<dyn Life + '_>>;
}

/// The program while it runs.
pub(crate) trait Life {
    /// Waits until what it keeps can be changed.
    fn get_ready(&mut self) -> anyhow::Result<()> {
        Ok(())
    }

    /// Asks what it keeps.
    fn read(&mut self) -> anyhow::Result<Kept>;

    /// Makes up a change and asks for it. `number` is never given twice, and grows. Gives the texts of what is kept when it is
    /// done.
    fn begin_change(&mut self, kept: &Kept, number: u64) -> anyhow::Result<Vec<String>>;

    /// Waits until the change is acknowledged.
    fn finish_change(&mut self) -> anyhow::Result<()>;

    /// Kills the program with SIGKILL, and tells whether the change was acknowledged before.
    fn kill(self: Box<Self>) -> anyhow::Result<bool>;

    /// What it told of damaged files.
    fn damage(&self) -> &[String] {
        &[]
    }
}

/// The texts of `kept` without the one of `key`, and with `fresh`.
pub(crate) fn replaced(kept: &Kept, key: Option<&str>, fresh: Option<String>) -> Vec<String> {
    let others = kept.iter().filter(|(other, _)| Some(other.as_str()) != key);
    let mut texts: Vec<String> = others.map(|(_, text)| text.clone()).chain(fresh).collect();
    texts.sort_unstable();
    texts
}

/// The texts, sorted.
pub(crate) fn texts(kept: &Kept) -> Vec<String> {
    replaced(kept, None, None)
}
