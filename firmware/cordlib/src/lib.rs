//! What the firmware of every robot shares: main loop, reflexes, motion, telemetry
