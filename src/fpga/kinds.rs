//! The kinds of pipelines: the only place that lists them all.

use super::error::FpgaError;
use super::float_unit::Fp;
use super::health::Warning;
use super::lms::{LmsConfig, LmsSettings};
use super::pipeline::{Core, Kind, Pipeline};
use super::rls::{RlsConfig, RlsCore};
use super::sign_lms::{SignLmsConfig, SignLmsSettings};
use super::timing::Units;

/// What is done with the settings of a pipeline, whatever its kind.
pub trait CoreVisitor {
    /// What comes of it.
    type Outcome;
    /// Does it.
    fn visit<C: Core>(self, core: &C) -> Self::Outcome;
}

/// Declares the kinds: settings and constants of each.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident: $settings:ident, $config:ident;)+) => {
        /// Every kind, in the order of the list.
        pub const KINDS: &[&Kind] = &[$(<$settings as Core>::KIND),+];

        /// Settings of a pipeline, before any check.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum CoreSettings {
            $($(#[$doc])* $kind($settings),)+
        }

        impl CoreSettings {
            /// What all pipelines of its kind share.
            #[must_use]
            pub fn kind(&self) -> &'static Kind {
                match self {
                    $(Self::$kind(_) => <$settings as Core>::KIND,)+
                }
            }

            /// Hands the settings to a visitor.
            pub fn visit<V: CoreVisitor>(&self, visitor: V) -> V::Outcome {
                match self {
                    $(Self::$kind(core) => visitor.visit(core),)+
                }
            }

            /// Number of weights.
            #[must_use]
            pub fn tap_count(&self) -> usize {
                match self {
                    $(Self::$kind(core) => Core::tap_count(core),)+
                }
            }

            /// Constants in the word format.
            ///
            /// # Errors
            /// What the pipeline refuses.
            pub fn config<F: Fp>(&self) -> Result<PipelineConfig<F>, FpgaError> {
                match self {
                    $(Self::$kind(core) => core.config().map(PipelineConfig::$kind),)+
                }
            }

            /// Clocks per sample when the control machine waits for every result of these units.
            ///
            /// # Errors
            /// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
            pub fn stalled_clocks(&self, units: Units) -> Result<u64, FpgaError> {
                match self {
                    $(Self::$kind(core) => core.stalled_clocks(units),)+
                }
            }

            /// Whether there is hardware with the engine's words.
            #[must_use]
            pub fn has_hardware(&self) -> bool {
                match self {
                    $(Self::$kind(core) => core.has_hardware(),)+
                }
            }

            /// Warns if the first updates cost the words their digits, for inputs up to
            /// `input_max`.
            #[must_use]
            pub fn digits_warning<F: Fp>(&self, input_max: f64) -> Option<Warning> {
                match self {
                    $(Self::$kind(core) => core.digits_warning::<F>(input_max),)+
                }
            }

            /// Samples after which theory expects the filter to fail by its rounding; none if it
            /// does not.
            #[must_use]
            pub fn failure_samples<F: Fp>(&self) -> Option<f64> {
                match self {
                    $(Self::$kind(core) => core.failure_samples::<F>(),)+
                }
            }
        }

        /// Constants of a pipeline in its word format.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum PipelineConfig<F> {
            $($(#[$doc])* $kind($config<F>),)+
        }

        impl<F: Fp> PipelineConfig<F> {
            /// The pipeline, whatever its kind.
            #[must_use]
            pub fn as_pipeline(&self) -> &dyn Pipeline<F> {
                match self {
                    $(Self::$kind(config) => config,)+
                }
            }
        }
    };
}

kinds! {
    /// Recursive least squares and the order of its update.
    Rls: RlsCore, RlsConfig;
    /// Least mean squares, normalised or not.
    Lms: LmsSettings, LmsConfig;
    /// Line enhancer, by the sign of the error or normalised.
    SignLms: SignLmsSettings, SignLmsConfig;
}
