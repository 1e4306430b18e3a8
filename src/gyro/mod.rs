//! Closed-loop fibre-optic gyro, from the optics to the rate word.
//!
//! Invariant: the optical feedback loop closes inside this folder and nowhere else.
