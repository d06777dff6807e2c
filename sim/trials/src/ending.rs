//! Exit code and error message of the programs that test a firmware.

use std::io::{self, Write};
use std::process::ExitCode;

use stc90::hosted::HostedError;

use crate::measured::MeasuredError;
use crate::testbed::TestbedError;

/// Why a campaign has no result.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// The robot does not reach the start of the trials.
    #[error(transparent)]
    Testbed(#[from] TestbedError),
    /// The same of a Relax.
    #[error(transparent)]
    Hosted(#[from] HostedError),
    /// The figures of the last long run cannot be read or written.
    #[error(transparent)]
    Measured(#[from] MeasuredError),
    /// The result cannot be written.
    #[error("cannot write the result: {0}")]
    Output(#[from] io::Error),
}

/// Exit code of `program`, whose campaign gave `result`: whether all was as it must be. What was not is said on
/// standard error; `otherwise` says it when the campaign has come to its end.
pub fn conclude(program: &str, result: Result<bool, CampaignError>, otherwise: &str) -> ExitCode {
    let complaint = match result {
        Ok(true) => return ExitCode::SUCCESS,
        Ok(false) => otherwise.to_owned(),
        Err(error) => error.to_string(),
    };
    // If standard error is closed, nobody can be informed.
    writeln!(io::stderr(), "{program}: {complaint}").ok();
    ExitCode::FAILURE
}
