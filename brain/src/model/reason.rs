//! Why the robot does what it does, by name.

use super::fault::Fault;
use super::gyro_fault::GyroFault;
use super::link_fault::LinkFault;
use super::map_doubt::MapDoubt;
use super::named_enum::named_enum;
use super::observation::{Cliffs, Contacts};

named_enum! {
    /// Named reason of a state or a decision. Logs, recordings and clients show the names.
    Reason
    {
        /// The brain has just been made.
        StartUp => "start-up",
        /// Somebody asked for it.
        Command => "command",
        /// The job is done.
        Finished => "finished",
        /// It stands where it was sent.
        Arrived => "arrived",
        /// It goes on by itself after an interruption.
        Continued => "continued",
        /// A job was taken up again after the daemon restarted.
        Restored => "restored",
        /// The microcontroller was reset and is not armed any more.
        NotArmed => "not-armed",
        /// The firmware does not let itself be armed.
        ArmRefused => "arm-refused",
        /// No fresh telemetry, or the firmware heard nothing for the length of a lease.
        LinkLost => "link-lost",
        /// Telemetry is back.
        LinkRestored => "link-restored",
        /// Somebody said `stop` to the firmware directly.
        Stopped => "stopped",
        /// A button on the robot was pressed while it moved.
        ButtonStop => "button-stop",
        /// A wheel hangs: lifted or fallen.
        WheelDrop => "wheel-drop",
        /// On the dock.
        Docked => "docked",
        /// Left half of the bumper.
        BumpLeft => "bump-left",
        /// Right half of the bumper.
        BumpRight => "bump-right",
        /// Both halves of the bumper.
        BumpFront => "bump-front",
        /// No floor on the left.
        CliffLeft => "cliff-left",
        /// No floor on the right.
        CliffRight => "cliff-right",
        /// No floor ahead.
        CliffFront => "cliff-front",
        /// The bumper stays pressed though the robot backed off.
        ContactHeld => "contact-held",
        /// Two edges of the floor in short time: a third one would latch the firmware (S8).
        CliffAgain => "cliff-again",
        /// The floor does not come back though the robot backed off.
        CliffHeld => "cliff-held",
        /// Many short runs in a row: a pocket it cannot find out of.
        BoxedIn => "boxed-in",
        /// It moves, but for minutes it does not get out of a place of the size of a closet.
        ShutIn => "shut-in",
        /// It got out of a place that had held it.
        CameFree => "came-free",
        /// A straight run without an encounter for longer than any home is.
        LongRun => "long-run",
        /// Something stands ahead of a robot that follows a wall.
        WallAhead => "wall-ahead",
        /// The wall that is followed ends here.
        WallEnded => "wall-ended",
        /// Way enough in this manner; another one follows.
        Alternation => "alternation",
        /// Hardly anything here was not swept lately.
        SweptLately => "swept-lately",
        /// The floor here was not swept lately.
        NewFloor => "new-floor",
        /// By its statistics nearly all is swept.
        ByStatistics => "by-statistics",
        /// Nothing was met for long: open floor.
        OpenFloor => "open-floor",
        /// Back where the way along the walls began.
        BackAtStart => "back-at-start",
        /// It has been along this wall before.
        KnownWall => "known-wall",
        /// The way led round something that stands free in the room.
        Island => "island",
        /// The way along the walls takes too long.
        LongLap => "long-lap",
        /// Floor that was not swept yet.
        UnsweptFloor => "unswept-floor",
        /// It makes a plan, and has nothing to do until that is made.
        Planning => "planning",
        /// Too far from the planned way.
        OffTheWay => "off-the-way",
        /// No map of the home to plan on.
        NoMap => "no-map",
        /// Nothing but the wheels tells the heading, so there is no map.
        NoHeading => "no-heading",
        /// Beacons are in range.
        BeaconsHeard => "beacons-heard",
        /// Too few beacons are in range.
        BeaconsSilent => "beacons-silent",
        /// Ranges to the beacons do not fit the place.
        PlaceContradicted => "place-contradicted",
        /// Ranges to the beacons fit one place only.
        BeaconsAgree => "beacons-agree",
        /// The other beacons agree, and this one fits another place of it.
        BeaconMoved => "beacon-moved",
        /// No place fits the ranges to the beacons.
        BeaconsMoved => "beacons-moved",
        /// What is not swept yet cannot be reached.
        RestOutOfReach => "rest-out-of-reach",
        /// Less than half of what was asked could be swept.
        MostOutOfReach => "most-out-of-reach",
        /// A no-go zone shuts off most of what was asked.
        NoGoInTheWay => "no-go-in-the-way",
        /// A virtual wall shuts off most of what was asked.
        VirtualWallInTheWay => "virtual-wall-in-the-way",
        /// A door that was open shuts off most of what was asked, or something stands in it.
        DoorShut => "door-shut",
        /// Something that was not there before shuts off most of what was asked.
        NewObstacleInTheWay => "new-obstacle-in-the-way",
        /// A no-go zone or virtual wall lies ahead in the search for the dock.
        NoGoAhead => "no-go-ahead",
        /// Floor was forbidden around the robot: it leaves it on the shortest way first.
        InsideNoGo => "inside-no-go",
        /// What is left costs more time than it is worth.
        NotWorthTheTime => "not-worth-the-time",
        /// The pack is low, and what is left is not worth another charge.
        CrumbsLeft => "crumbs-left",
        /// Much could not be reached on a first run, and is tried once more from the dock, where the robot knows its place.
        LookAgain => "look-again",
        /// Too many things in the way.
        Obstructed => "obstructed",
        /// Commanded to move and did not (S15).
        NotMoving => "not-moving",
        /// Gyro and wheels disagree for long (S14).
        Slip => "slip",
        /// The gyro's scale is not known well enough: whole turns beside a wall tell it.
        GyroScale => "gyro-scale",
        /// The gyro's bias wanders and is measured at rest.
        GyroDrift => "gyro-drift",
        /// A gyro that was left out agrees with the wheels again, or is heard again.
        GyroBack => "gyro-back",
        /// The time of the job is used up (S26).
        TaskBudget => "task-budget",
        /// Little charge is left.
        BatteryLow => "battery-low",
        /// The dock was not found in time.
        DockNotFound => "dock-not-found",
        /// The job waits on the dock for charge and goes on by itself.
        Recharging => "recharging",
        /// The charger has stopped for a fault.
        ChargerFault => "charger-fault",
        /// The pack holds enough to go on.
        Charged => "charged",
        /// A beam of the dock is heard.
        DockBeam => "dock-beam",
        /// The map tells where the dock is, and the robot knows where it is itself.
        DockKnown => "dock-known",
        /// A beam of the dock was heard there before.
        DockHeard => "dock-heard",
        /// Contact, but not with the contacts of the dock.
        DockMissed => "dock-missed",
        /// On the contacts, and no current flows.
        NoChargeCurrent => "no-charge-current",
        /// The dock was touched several times, and its contacts did not close.
        DockNoContact => "dock-no-contact",
        /// The contacts of the dock lost their voltage while the robot stood on them.
        DockContactLost => "dock-contact-lost",
        /// The same, and the dock's beams fell silent with them.
        DockPowerLost => "dock-power-lost",
        /// Something stands in front of the dock.
        DockObstructed => "dock-obstructed",
        /// Somebody pushed the robot off its dock.
        PushedOff => "pushed-off",
        /// Somebody lifted the robot off its dock.
        LiftedOff => "lifted-off",
        /// No beam of the dock is heard where one should be.
        NoBeam => "no-beam",
        /// Nobody knows where the dock is.
        DockUnknown => "dock-unknown",
        /// The robot does not know where it is in the map.
        PlaceUnknown => "place-unknown",
        /// It knows its position too vaguely for lanes.
        PlaceVague => "place-vague",
        /// No way is left to where it wants to go.
        WayBlocked => "way-blocked",
        /// The lease of the person who drives ended.
        LeaseEnded => "lease-ended",
        /// The person let go.
        Released => "released",
        /// The next part of the order.
        NextPart => "next-part",
        /// There is nothing to pause or resume.
        NoJob => "no-job",
    }
    nested {
        /// A fault that needs a person.
        Fault(Fault),
        /// The link cannot be relied upon.
        Link(LinkFault),
        /// The gyro cannot be relied upon.
        Gyro(GyroFault),
        /// The map cannot be relied upon.
        Map(MapDoubt),
    }
}

impl Reason {
    /// Whether a job by plans is over for it, because nothing is left that can be reached and is worth its time.
    #[must_use]
    pub fn ends_plans(self) -> bool {
        matches!(
            self,
            Self::Finished | Self::RestOutOfReach | Self::NotWorthTheTime
        )
    }

    /// The reason that fits pressed bumper zones, if any is pressed.
    #[must_use]
    pub fn of_contacts(contacts: Contacts) -> Option<Self> {
        match (contacts.left, contacts.right) {
            (true, true) => Some(Self::BumpFront),
            (true, false) => Some(Self::BumpLeft),
            (false, true) => Some(Self::BumpRight),
            (false, false) => None,
        }
    }

    /// The reason that fits cliff sensors, if any sees no floor.
    #[must_use]
    pub fn of_cliffs(cliffs: Cliffs) -> Option<Self> {
        match (cliffs.left, cliffs.middle, cliffs.right) {
            (false, false, false) => None,
            (true, _, false) => Some(Self::CliffLeft),
            (false, _, true) => Some(Self::CliffRight),
            _ => Some(Self::CliffFront),
        }
    }
}
