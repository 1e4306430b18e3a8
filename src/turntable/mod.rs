//! Rate table: commanded motion, servo and the site, giving the true rate of the gyro's input axis.
//!
//! ```text
//!  motion ──> course  ──command──> servo ──table rate──> platform ──truth──> gyro
//!             swing, steps,        ideal,      │         wobble, mounting,
//!             rotation, ...        2nd order,  │         + Earth rate
//!                                  motor       └──> encoder ──> laboratory
//! ```
//!
//! Truth is what the axis does, not what it was told to do: a 40 Hz table lags a 10 Hz command by
//! 5.7 ms, twenty times the delay of the gyro under test, so that anything measured against the
//! command measures the table. Motion leaves this module as one cubic per output sample.
//!
//! Instants are counted in samples from the start of the warm-up; sample `k` covers the time from
//! `k T` to its stamp `(k + 1) T`. Phases are computed from that count, never accumulated.
//!
//! Invariant: this is truth; it never sees a gyro output.

mod axis;
mod config;
mod encoder;
mod injected;
mod motion;
mod platform;
mod servo;
mod site;
mod table;

pub use axis::{InputAxisBounds, earth_rate_rad_per_s, input_axis_bounds};
pub use config::TurntableConfig;
pub use encoder::EncoderConfig;
pub use injected::InjectedSignal;
pub use motion::{
    CampaignConfig, CampaignGroup, ChirpConfig, CommandExtremes, MotionChecks, MotionClass,
    MotionConfig, MultiSineConfig, PreferredSeries, Progression, RotationConfig,
    ScaleFactorTestConfig, ScriptConfig, ScriptPoints, SignalShape, Stairs, StaticConfig,
    StepsConfig, Surroundings, SwingConfig, TEST_RATES_MIN, TestSignalConfig, TrapezoidConfig,
    campaign_angles_rad, dwell_ends, first_measured_index, step_indices,
};
pub use servo::{DirectDriveServoConfig, IdealServoConfig, SecondOrderServoConfig, ServoConfig};
pub use site::{AxisConfig, MountingConfig, SiteConfig};
pub use table::Turntable;
