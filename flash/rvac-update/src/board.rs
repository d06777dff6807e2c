//! The programs that run on the Linux board, and what can be seen of them.

/// What answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Health {
    /// The daemon, on its socket.
    pub daemon: bool,
    /// The robot: it greeted the daemon.
    pub robot: bool,
    /// The panel's server gives a page.
    pub panel: bool,
}

impl Health {
    /// Whether everything answers that is wanted.
    #[must_use]
    pub const fn covers(self, wanted: Self) -> bool {
        (self.daemon || !wanted.daemon) && (self.robot || !wanted.robot) && (self.panel || !wanted.panel)
    }

    /// The first of what is wanted and does not answer.
    #[must_use]
    pub const fn missing(self, wanted: Self) -> Option<&'static str> {
        if wanted.daemon && !self.daemon {
            Some("the daemon")
        } else if wanted.robot && !self.robot {
            Some("the robot")
        } else if wanted.panel && !self.panel {
            Some("the panel")
        } else {
            None
        }
    }
}

/// Why programs were not started again.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// The command cannot be run.
    #[error("cannot run {command}: {error}")]
    Command {
        /// Which.
        command: String,
        /// Why.
        error: std::io::Error,
    },
    /// It says no.
    #[error("{command}: {status}")]
    Status {
        /// Which.
        command: String,
        /// How it ended.
        status: String,
    },
}

/// The Linux board.
pub trait Board {
    /// Ends daemon and panel, and starts those that are current.
    ///
    /// # Errors
    /// When they could not be started; whether they work is another question.
    fn restart(&mut self) -> Result<(), BoardError>;

    /// Whether the robot is at work, so that its programs must not be ended.
    fn works(&mut self) -> bool;

    /// What answers now.
    fn look(&mut self) -> Health;

    /// Waits until everything that is wanted answers, for a minute at most; gives what answers then.
    fn wait_for(&mut self, wanted: Health) -> Health;
}
