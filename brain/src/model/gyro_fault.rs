//! Why the gyro does not count in the estimate of the pose.

use super::named_enum::named_enum;

named_enum! {
    /// What is wrong with a gyro. It counts again by itself when it agrees with the wheels over a turn.
    GyroFault {
        /// It repeats one value whatever the wheels do.
        Frozen => "gyro-frozen",
        /// It repeats a value beyond what the robot can turn: the end of its range.
        AtItsLimit => "gyro-at-its-limit",
        /// It turns otherwise than the wheels do, in a way that no slip explains.
        Disagrees => "gyro-disagrees",
        /// It says nothing any more.
        Silent => "gyro-silent",
    }
}
