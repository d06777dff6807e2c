//! Simulated home: floor plans, physics, sensors, dirt, dock, battery
