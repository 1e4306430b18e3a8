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

            /// The same with units of these latencies.
            ///
            /// # Errors
            /// What the pipeline refuses.
            pub fn config_with<F: Fp>(&self, units: Units) -> Result<PipelineConfig<F>, FpgaError> {
                match self {
                    $(Self::$kind(core) => core.config_with(units).map(PipelineConfig::$kind),)+
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

            /// What a sample counts for once the next has come; none where the weights follow a
            /// gradient.
            #[must_use]
            pub fn forgetting_factor(&self) -> Option<f64> {
                match self {
                    $(Self::$kind(core) => Core::forgetting_factor(core),)+
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fpga::engine::Engine;
    use crate::fpga::front_end::Pair;
    use crate::fpga::lms::DesiredSource;
    use crate::fpga::rls::RlsSettings;
    use crate::fpga::trace::Window;
    use crate::vocabulary::{Division, UpdateOrder, UpdateSign};

    /// Settings of every kind, in the order of the list.
    fn examples() -> [CoreSettings; KINDS.len()] {
        [
            CoreSettings::Rls(RlsCore {
                settings: RlsSettings {
                    tap_count: 3,
                    forgetting_factor: 0.98,
                    initial_inverse_correlation: 1e2,
                    division: Division::Reciprocal,
                    update_sign: UpdateSign::Corrected,
                },
                order: UpdateOrder::Schedule,
            }),
            CoreSettings::Lms(LmsSettings {
                tap_count: 5,
                step_size: 0.5,
                regularisation: Some(1.0),
                desired: DesiredSource::Port,
                update_sign: UpdateSign::Corrected,
            }),
            CoreSettings::SignLms(SignLmsSettings {
                tap_count: 4,
                delay_samples: 2,
                normalised: true,
                step: 0.5,
                regularisation: 1.0,
                initial_weight: 0.25,
                guard: None,
                norm_recompute_samples: 8,
            }),
        ]
    }

    fn pairs() -> Vec<Pair<f64>> {
        (0..40_u32)
            .map(|k| {
                let word = |k: u32| f64::from(k * k % 17) - 8.0;
                Pair::from_f64(word(k), word(k + 1))
            })
            .collect()
    }

    /// Words of the clock-less engine, and its weights after the last.
    struct EngineWords;

    impl CoreVisitor for EngineWords {
        type Outcome = (Vec<u64>, Vec<u64>);

        fn visit<C: Core>(self, core: &C) -> Self::Outcome {
            let mut engine = core.engine::<f64>().unwrap();
            let words = pairs().into_iter().map(|pair| engine.process(pair));
            let words = words.map(f64::to_bits).collect();
            let weights = engine.weights().iter().map(|word| word.to_bits());
            (words, weights.collect())
        }
    }

    #[test]
    fn every_kind_has_one_row_with_a_name_of_its_own() {
        for (example, kind) in examples().iter().zip(KINDS) {
            assert_eq!(example.kind(), *kind);
            let config = example.config::<f64>().unwrap();
            assert_eq!(config.as_pipeline().kind(), *kind);
            let same = KINDS.iter().filter(|other| other.name == kind.name);
            assert_eq!(same.count(), 1, "{}", kind.name);
        }
    }

    #[test]
    fn declared_clocks_of_every_kind_are_those_counted_on_its_machine() {
        for example in examples() {
            let config = example.config::<f64>().unwrap();
            let pipeline = config.as_pipeline();
            let used = pipeline.clocked().usage();
            let name = example.kind().name;
            assert_eq!(pipeline.tap_count(), example.tap_count(), "{name}");
            assert_eq!(pipeline.clocks_per_sample() as u64, used.clocks_per_sample);
            assert_eq!(pipeline.latency_clocks() as u64, used.latency_clocks);
            let stalled = example.stalled_clocks(Units::ONE_CLOCK).unwrap();
            assert_eq!(stalled, used.clocks_per_sample, "{name}");
            let by_state = used.states.iter().map(|state| state.clocks);
            assert_eq!(by_state.sum::<u64>(), used.clocks_per_sample, "{name}");
            assert_eq!(used.states.len(), example.kind().states.len());
        }
    }

    #[test]
    fn engine_of_every_kind_has_the_words_of_its_machine() {
        for example in examples() {
            let (words, weights) = example.visit(EngineWords);
            let config = example.config::<f64>().unwrap();
            let mut clocked = config.as_pipeline().clocked();
            let outputs = clocked.record(&pairs(), Window::ALL, &mut |_| {});
            let outputs: Vec<u64> = outputs.into_iter().map(f64::to_bits).collect();
            let name = example.kind().name;
            assert_eq!(outputs, words, "{name}");
            assert!(words.iter().any(|word| *word != words[0]), "{name}");
            let memories: Vec<u64> = clocked.memories().into_iter().map(f64::to_bits).collect();
            let found = memories.windows(weights.len()).any(|held| held == weights);
            assert!(found, "{name}: no memory holds the weights");
        }
    }
}
