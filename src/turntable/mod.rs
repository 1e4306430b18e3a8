//! Rate table: commanded motion, servo and the site, giving the true rate of the gyro's input axis.
//!
//! Invariant: this is truth; it never sees a gyro output.
