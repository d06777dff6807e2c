//! The program of the robot.

fn main() {
    println!("this program runs on the robot's chip; `cargo xtask firmware sr8730` builds it");
}
