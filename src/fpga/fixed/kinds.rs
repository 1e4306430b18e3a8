//! The kinds of fixed-point pipelines: the only place that lists them all.

use super::lms::{FixedLmsConfig, FixedLmsSettings, LMS_FIXED};
use super::pipeline::{FixedKind, FixedPipeline};
use super::rls::{FixedRlsConfig, FixedRlsSettings, RLS_FIXED};
use super::sign_lms::{FixedSignLmsConfig, FixedSignLmsSettings, SIGN_LMS_FIXED};
use super::signal::Signal;
use crate::fpga::error::FpgaError;
use crate::fpga::timing::Units;

/// Declares the kinds: what each shares, its settings and its constants.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident: $shared:ident, $settings:ident, $config:ident;)+) => {
        /// Every kind, in the order of the list.
        pub const FIXED_KINDS: &[&FixedKind] = &[$(&$shared),+];

        /// Settings of a fixed-point pipeline, before any check.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum FixedCoreSettings {
            $($(#[$doc])* $kind($settings),)+
        }

        impl FixedCoreSettings {
            /// Number of weights.
            #[must_use]
            pub fn tap_count(&self) -> usize {
                match self {
                    $(Self::$kind(settings) => settings.tap_count,)+
                }
            }

            /// Its signals, in the order of their names.
            #[must_use]
            pub fn signals(&self) -> Vec<Signal> {
                match self {
                    $(Self::$kind(settings) => settings.formats.signals().to_vec(),)+
                }
            }

            /// What all pipelines of its kind share.
            #[must_use]
            pub fn kind(&self) -> &'static FixedKind {
                match self {
                    $(Self::$kind(_) => &$shared,)+
                }
            }

            /// The constants in their words.
            ///
            /// # Errors
            /// What the pipeline refuses.
            pub fn config(&self) -> Result<FixedConfig, FpgaError> {
                match self {
                    $(Self::$kind(settings) => $config::new(*settings).map(FixedConfig::$kind),)+
                }
            }
        }

        /// Constants of a fixed-point pipeline.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum FixedConfig {
            $($(#[$doc])* $kind($config),)+
        }

        impl FixedConfig {
            /// The pipeline, whatever its kind.
            #[must_use]
            pub fn as_pipeline(&self) -> &dyn FixedPipeline {
                match self {
                    $(Self::$kind(config) => config,)+
                }
            }
        }
    };
}

kinds! {
    /// Recursive least squares.
    Rls: RLS_FIXED, FixedRlsSettings, FixedRlsConfig;
    /// Least mean squares, normalised or not.
    Lms: LMS_FIXED, FixedLmsSettings, FixedLmsConfig;
    /// Line enhancer, by the sign of the error or normalised.
    SignLms: SIGN_LMS_FIXED, FixedSignLmsSettings, FixedSignLmsConfig;
}

impl FixedConfig {
    /// The same with units of other latencies: same words, more clocks.
    ///
    /// # Errors
    /// [`FpgaError::CountOutOfRange`] for a latency out of range; [`FpgaError::FixedUnits`] for one of more than
    /// a clock in a kind whose units take a clock each.
    pub fn with_units(self, units: Units) -> Result<Self, FpgaError> {
        match self {
            Self::Rls(config) => config.with_units(units).map(Self::Rls),
            Self::Lms(_) | Self::SignLms(_) if units.wait() => Err(FpgaError::FixedUnits),
            Self::Lms(_) | Self::SignLms(_) => Ok(self),
        }
    }
}
