//! What another Stop makes void of the commands that wait.

use brain::{Command, JobCommand};

/// One more Stop comes: one is as good as two, and nothing is left of what came between them.
pub(super) fn drop_what_stops_enclose(waiting: &mut Vec<Command>) {
    let first = waiting.iter().position(is_stop).unwrap_or(waiting.len());
    let since = waiting.split_off(first);
    waiting.extend(since.into_iter().filter(|between| !ends_with_stop(between)));
}

pub(super) fn is_stop(command: &Command) -> bool {
    *command == Command::Job(JobCommand::Stop)
}

/// Whether nothing is left of a command that the brain has not heard once Stop comes after it. Whoever starts and stops without end would
/// else let the brain begin and end hundreds of jobs in one step, with beeps for each.
fn ends_with_stop(command: &Command) -> bool {
    match command {
        Command::Edit(_) => false,
        Command::Job(command) => match command {
            JobCommand::Clean { .. }
            | JobCommand::CleanParts { .. }
            | JobCommand::Spot
            | JobCommand::GoTo { .. }
            | JobCommand::Dock
            | JobCommand::Pause
            | JobCommand::Resume
            | JobCommand::Stop => true,
            JobCommand::Manual { .. } | JobCommand::ManualEnd | JobCommand::ClearError => false,
        },
    }
}
