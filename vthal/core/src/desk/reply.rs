//! The answer of a desk to a request that it does not refuse, and when the client receives it.

use rvac_api::Update;

/// The answer to a request. A desk cannot serve one without saying who answers, and when.
#[derive(Debug)]
pub(crate) enum Reply {
    /// It is done: the client is answered at once, if it gave a number.
    Done,
    /// This is the answer, at once.
    Update(Box<Update>),
    /// The shell answers when it has carried out the order.
    ByShell,
    /// The desk answers when the turn of the request has come.
    InTurn,
    /// The desk answers when the shell says that the disk has the change or has not.
    WhenKept,
    /// The shell answers when it has kept the map that the brain's next step changes. The desk answers if that step does not make the
    /// change, or leaves no map to keep.
    AfterStep,
}

impl From<Update> for Reply {
    fn from(update: Update) -> Self {
        Self::Update(Box::new(update))
    }
}
