//! Temperature of the gyro: from the chamber to the optics.
//!
//! ```text
//! chamber(t) -> case -> outer layer -> inner layer       (network)
//!                |          '-- difference of rates --> Shupe bias (winding)
//!                '-- power, wavelength, Johnson noise --> sensitivities --> condition
//! ```
//!
//! Invariant: no random numbers; everything follows from the configuration and the time.

pub(in crate::gyro) mod chamber;
pub(in crate::gyro) mod condition;
mod network;
pub(in crate::gyro) mod power;
mod sensitivities;
pub(in crate::gyro) mod settings;
mod winding;

pub use chamber::Chamber;
pub use network::{Network, NetworkState, Propagator};
use sensitivities::Sensitivities;
pub use winding::{Shupe, layer_integral, layer_order};
