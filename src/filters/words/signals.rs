//! Fixed-point words of any filter, and the macros that declare the tables of its signals.

use crate::filters::common::Complaints;
use crate::vocabulary::{NumberFormat, Overflow, Rounding, UpdateSign, WordFormat};

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

/// Fixed-point words of a filter: what a table says of all signals, and the format of each.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedWords {
    /// Rate that the value 1 of x, d and y stands for, deg/h.
    pub full_scale_deg_per_h: f64,
    /// Bits of a word, of every signal that does not say otherwise.
    pub word_bits: u32,
    /// Rounding of every signal that does not say otherwise.
    pub rounding: Rounding,
    /// Overflow of every signal that does not say otherwise.
    pub overflow: Overflow,
    /// Smallest diagonal element of R, in its last bits; none of a filter without R.
    pub r_floor_steps: Option<u32>,
    /// Signals by their names.
    pub signals: Vec<(&'static str, SignalWord)>,
}

/// Words of a hardware pipeline.
#[derive(Clone, Debug, PartialEq)]
pub enum HardwareWords {
    /// Floating point.
    Float(NumberFormat),
    /// Fixed point.
    Fixed(FixedWords),
}

impl HardwareWords {
    /// What two keys of a filter stand for.
    pub(in crate::filters) fn of(format: WordFormat, fixed: impl FnOnce() -> FixedWords) -> Self {
        match format {
            WordFormat::Float(format) => Self::Float(format),
            WordFormat::Fixed => Self::Fixed(fixed()),
        }
    }
}

impl FixedWords {
    /// The format of a signal.
    ///
    /// # Panics
    /// If the filter has no such signal.
    #[must_use]
    pub fn word(&self, signal: &str) -> SignalWord {
        let mut signals = self.signals.iter();
        let found = signals.find(|(name, _)| *name == signal);
        found.map_or_else(
            || panic!("no fixed-point signal `{signal}`: {:?}", self.signals),
            |(_, word)| *word,
        )
    }

    /// The same words but for the bits of one signal.
    #[must_use]
    pub fn with_bits(mut self, signal: &str, bits: u32) -> Self {
        for (name, word) in &mut self.signals {
            if *name == signal {
                word.word_bits = bits;
            }
        }
        self
    }

    /// The same words, of these bits in every signal.
    #[must_use]
    pub fn uniform(mut self, bits: u32) -> Self {
        self.word_bits = bits;
        for (_, word) in &mut self.signals {
            word.word_bits = bits;
        }
        self
    }

    /// Bits of one word of every signal together.
    #[must_use]
    pub fn total_bits(&self) -> u32 {
        self.signals.iter().map(|(_, word)| word.word_bits).sum()
    }

    /// The table as a scenario holds it.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = format!(
            "full_scale_deg_per_h = {:?}\nword_bits = {}\nrounding = \"{}\"\noverflow = \"{}\"\n",
            self.full_scale_deg_per_h, self.word_bits, self.rounding, self.overflow,
        );
        if let Some(steps) = self.r_floor_steps {
            text.push_str(&format!("r_floor_steps = {steps}\n"));
        }
        for (name, word) in &self.signals {
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

    /// Refuses formats without room for their integer bits.
    pub(in crate::filters) fn check(&self, complaints: &mut Complaints) {
        for (name, word) in &self.signals {
            if word.integer_bits > word.word_bits {
                let message = format!(
                    "= {} is more than the {} bits of a word: allowed 1..={1}",
                    word.integer_bits, word.word_bits
                );
                complaints.key(&format!("fixed.{name}.integer_bits"), &message);
            }
        }
    }

    /// What must be said of words up to a peak.
    pub(in crate::filters) fn notes(&self, peak_deg_per_h: f64) -> Vec<String> {
        let desired = self.word("d");
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

/// Refuses the sign of the paper's print, which fixed-point hardware does not have.
pub(in crate::filters) fn refuse_as_printed(sign: UpdateSign, complaints: &mut Complaints) {
    if sign == UpdateSign::AsPrinted {
        complaints.key(
            "update_sign",
            "= \"as-printed\" has no hardware in fixed point: use \"corrected\", or another number_format",
        );
    }
}

/// Declares the tables of signals: each with its integer bits.
macro_rules! signal_tables {
    ($($(#[doc = $about:literal])+ $table:ident, $integer_bits:literal;)+) => {
        $($crate::declare::table! {
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
    };
}
pub(super) use signal_tables;

/// Declares the words of a kind: keys of all signals, a floor of R if it has one, and its signals with their tables.
macro_rules! fixed_words {
    (
        $(#[doc = $about:literal])+
        pub struct $words:ident {
            $($(#[doc = $floor_doc:literal])+ $floor:ident: u32 = $none:literal, in $low:literal..=$high:literal;)?
            $($name:ident: $table:ident;)+
        }
    ) => {
        $crate::declare::table! {
            $(#[doc = $about])+
            pub struct $words {
                /// Rate that the value 1 of x, d and y stands for. Source of the default: twice the swing of the
                /// paper.
                full_scale_deg_per_h: f64 = 7200.0, in 1e-3..=1e9, "deg/h";
                /// Bits of a word, of every signal that does not say otherwise.
                word_bits: u32 = 32, in 2..=48;
                /// How values between two words are rounded, in every signal that does not say otherwise.
                rounding: Rounding = "half-up";
                /// What becomes of values beyond the ends, in every signal that does not say otherwise.
                overflow: Overflow = "saturate";
                $($(#[doc = $floor_doc])+ $floor: u32 = $none, in $low..=$high;)?
                $($name: $table;)+
            }
        }

        impl $words {
            /// The words, what the table of a signal leaves out taken from that of all.
            #[must_use]
            pub fn resolved(&self) -> $crate::filters::words::FixedWords {
                let floor: &[u32] = &[$(self.$floor)?];
                $crate::filters::words::FixedWords {
                    full_scale_deg_per_h: self.full_scale_deg_per_h,
                    word_bits: self.word_bits,
                    rounding: self.rounding,
                    overflow: self.overflow,
                    r_floor_steps: floor.first().copied(),
                    signals: vec![$((
                        stringify!($name),
                        $crate::filters::words::SignalWord {
                            integer_bits: self.$name.integer_bits,
                            word_bits: self.$name.word_bits.unwrap_or(self.word_bits),
                            rounding: self.$name.rounding.unwrap_or(self.rounding),
                            overflow: self.$name.overflow.unwrap_or(self.overflow),
                        },
                    )),+],
                }
            }
        }
    };
}
pub(super) use fixed_words;
