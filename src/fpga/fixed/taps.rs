//! Formats of a filter's signals: how a kind declares them, and those that every filter of taps has.

use super::format::{Format, Stored};

/// Formats of the signals that every pipeline has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TapFormats {
    /// Regressor words x and the ring of L.
    pub input: Format,
    /// Desired words d, in which samples arrive.
    pub desired: Format,
    /// Weights W.
    pub weight: Format,
    /// Output y and error e.
    pub output: Format,
}

impl TapFormats {
    /// `Q_y` of a sum of products of L and W.
    pub(super) fn output(&self, sum: i128) -> Stored {
        let scale = self.input.fraction_bits + self.weight.fraction_bits;
        self.output.store(sum, scale)
    }

    /// `Q_y(d - y)`.
    pub(super) fn error(&self, desired: i64, output: i64) -> Stored {
        let scales = [self.desired.fraction_bits, self.output.fraction_bits];
        let values = [i128::from(desired), -i128::from(output)];
        self.output.store_sum(values, scales)
    }
}

/// Declares the formats of a kind of filters: a field for each signal, in the order of their names.
macro_rules! signal_formats {
    (
        $(#[doc = $about:literal])+
        pub struct $formats:ident {
            $($(#[doc = $doc:literal])+ $field:ident: $name:ident;)+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $formats {
            $($(#[doc = $doc])+ pub $field: $crate::fpga::fixed::Format,)+
        }

        impl $formats {
            /// All of them by name.
            #[must_use]
            pub fn signals(&self) -> [$crate::fpga::fixed::Signal; [$($crate::fpga::fixed::SignalName::$name),+].len()] {
                [$($crate::fpga::fixed::Signal {
                    name: $crate::fpga::fixed::SignalName::$name,
                    format: self.$field,
                }),+]
            }

            /// Those that every filter of taps has.
            #[must_use]
            pub fn of_taps(&self) -> $crate::fpga::fixed::TapFormats {
                $crate::fpga::fixed::TapFormats {
                    input: self.input,
                    desired: self.desired,
                    weight: self.weight,
                    output: self.output,
                }
            }
        }
    };
}
pub(super) use signal_formats;
