//! All messages of both sides, as closed types. The text and binary forms encode these.

mod arming;
mod charge;
mod command;
mod describe;
mod identity;
mod inhibit;
mod probe;
mod report;

pub use arming::ArmingState;
pub use charge::{ChargeEnd, ChargeFault, ChargePhase, ChargerStatus};
pub use command::{
    Beep, Command, Drive, HostHello, Led, LedPattern, Motor, MotorCommand, Move, Parameter, Sequence,
};
pub use describe::{CommandName, CommandNames, DescribeRow, RowContent};
pub use identity::{
    BinaryKinds, Capabilities, Description, Limits, MotorGaps, MotorSet, Name, ProtocolVersion, ResetCause,
    RobotHello,
};
pub use inhibit::{Inhibit, Inhibits};
pub use probe::{
    ButtonProbe, EncoderProbe, PROBE_BYTES, PROBE_CHANNELS, PROBE_LEASE_MS_MAX, PROBE_PORTS, Probe,
    ProbeTarget, Probed, ProbedContent, SerialProbe,
};
pub use report::{
    Acknowledgement, Battery, Bumpers, ChargeState, Cliffs, Currents, DockReceivers, Event, Gyro, Info,
    LinkCounters, LogLevel, LogText, MotionPhase, MoveEnd, NumberedEvent, PROXIMITY_SENSORS, PackReading,
    Refusal, Report, State, WheelDrops,
};
