//! Fixed-point words of recursive least squares: a format for each signal.

use super::common::Complaints;
use crate::declare::table;
use crate::vocabulary::{Overflow, Rounding};

table! {
    /// Fixed-point words of recursive least squares; each signal has a table of its own. Source of the
    /// defaults: trials on the words of the paper's gyro, which run on 22 to 40 bits.
    pub struct RlsWords {
        /// Rate that the value 1 of x, d and y stands for. Source of the default: twice the swing of the
        /// paper.
        full_scale_deg_per_h: f64 = 7200.0, in 1e-3..=1e9, "deg/h";
        /// Bits of a word, of every signal that does not say otherwise.
        word_bits: u32 = 32, in 2..=48;
        /// How values between two words are rounded, in every signal that does not say otherwise.
        rounding: Rounding = "half-up";
        /// What becomes of values beyond the ends, in every signal that does not say otherwise.
        overflow: Overflow = "saturate";
        /// Smallest diagonal element of R, in its last bits, which keeps a filter that forgets nothing alive;
        /// 0 for none.
        r_floor_steps: u32 = 0, in 0..=1000000;
        x: RegressorWord;
        d: DesiredWord;
        t: IntermediateWord;
        den: DenominatorWord;
        k: GainWord;
        r: InverseWord;
        w: WeightWord;
        y: OutputWord;
    }
}

/// Format of a signal, as its table and that of all signals give it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SignalWord {
    /// Integer bits m, the sign included.
    pub integer_bits: u32,
    /// Bits of a word.
    pub word_bits: u32,
    /// Rounding.
    pub rounding: Rounding,
    /// Overflow.
    pub overflow: Overflow,
}

/// Declares the tables of the signals and gathers their formats.
macro_rules! signals {
    ($($(#[doc = $about:literal])+ $table:ident = $name:ident, $integer_bits:literal;)+) => {
        $(table! {
            $(#[doc = $about])+
            pub struct $table {
                /// Bits before the point, the sign among them; the others of the word stand behind it.
                integer_bits: u32 = $integer_bits, in 1..=48;
                /// Bits of a word.
                word_bits: Option<u32>, example 40, in 2..=48;
                /// How values between two words are rounded.
                rounding: Option<Rounding>, example "nearest-even";
                /// What becomes of values beyond the ends.
                overflow: Option<Overflow>, example "wrap";
            }
        })+

        /// Formats of the signals.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct SignalWords {
            $($(#[doc = $about])+ pub $name: SignalWord,)+
        }

        impl SignalWords {
            /// Every signal by its name.
            pub fn named(self) -> impl Iterator<Item = (&'static str, SignalWord)> {
                [$((stringify!($name), self.$name)),+].into_iter()
            }
        }

        impl RlsWords {
            /// The same words but for the bits of one signal.
            #[must_use]
            pub fn with_bits(mut self, signal: &str, bits: u32) -> Self {
                $(if signal == stringify!($name) {
                    self.$name.word_bits = Some(bits);
                })+
                self
            }

            /// The same words, of these bits in every signal.
            #[must_use]
            pub fn uniform(mut self, bits: u32) -> Self {
                self.word_bits = bits;
                $(self.$name.word_bits = None;)+
                self
            }

            /// The formats, what the table of a signal leaves out taken from that of all.
            #[must_use]
            pub fn signals(&self) -> SignalWords {
                SignalWords {
                    $($name: SignalWord {
                        integer_bits: self.$name.integer_bits,
                        word_bits: self.$name.word_bits.unwrap_or(self.word_bits),
                        rounding: self.$name.rounding.unwrap_or(self.rounding),
                        overflow: self.$name.overflow.unwrap_or(self.overflow),
                    },)+
                }
            }
        }
    };
}

signals! {
    /// Regressors x, words of 1.0 full scale.
    RegressorWord = x, 1;
    /// Desired signal d, in which samples arrive.
    DesiredWord = d, 1;
    /// Intermediate t = R L.
    IntermediateWord = t, 11;
    /// Denominator alpha + L't.
    DenominatorWord = den, 12;
    /// Gain k = t / den.
    GainWord = k, 9;
    /// Inverse correlation R, in the inverse square of the full scale.
    InverseWord = r, 14;
    /// Weights W.
    WeightWord = w, 3;
    /// Output y and error e.
    OutputWord = y, 1;
}

impl RlsWords {
    /// Refuses formats without room for their integer bits.
    pub(super) fn check(&self, complaints: &mut Complaints) {
        for (name, word) in self.signals().named() {
            if word.integer_bits > word.word_bits {
                let message = format!(
                    "= {} is more than the {} bits of a word: allowed 1..={1}",
                    word.integer_bits, word.word_bits
                );
                complaints.key(&format!("fixed.{name}.integer_bits"), &message);
            }
        }
    }

    /// Bits of one word of every signal together.
    #[must_use]
    pub fn total_bits(&self) -> u32 {
        self.signals().named().map(|(_, word)| word.word_bits).sum()
    }

    /// The table as a scenario holds it.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = format!(
            "full_scale_deg_per_h = {:?}\nword_bits = {}\nrounding = \"{}\"\noverflow = \"{}\"\n\
             r_floor_steps = {}\n",
            self.full_scale_deg_per_h,
            self.word_bits,
            self.rounding,
            self.overflow,
            self.r_floor_steps
        );
        for (name, word) in self.signals().named() {
            let mut keys = format!("integer_bits = {}", word.integer_bits);
            if word.word_bits != self.word_bits {
                keys.push_str(&format!(", word_bits = {}", word.word_bits));
            }
            if word.rounding != self.rounding {
                keys.push_str(&format!(", rounding = \"{}\"", word.rounding));
            }
            if word.overflow != self.overflow {
                keys.push_str(&format!(", overflow = \"{}\"", word.overflow));
            }
            text.push_str(&format!("{name} = {{ {keys} }}\n"));
        }
        text
    }

    /// What must be said of words up to a peak.
    pub(super) fn notes(&self, peak_deg_per_h: f64) -> Vec<String> {
        let desired = self.signals().d;
        let limit = self.full_scale_deg_per_h * f64::from(desired.integer_bits - 1).exp2();
        if peak_deg_per_h < limit {
            return Vec::new();
        }
        vec![format!(
            "words of up to {peak_deg_per_h:.1} deg/h are beyond the ends of d, {limit} deg/h: use a \
             larger fixed.full_scale_deg_per_h, or more integer bits"
        )]
    }
}
