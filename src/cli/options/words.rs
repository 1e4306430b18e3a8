//! Words of the vocabulary as values of options: spelling and help stand in their declaration.

use clap::ValueEnum;
use clap::builder::PossibleValue;

use crate::vocabulary::{Device, Division, ExportForm, UnitSource, Word as _, WordFormat};

macro_rules! option_values {
    ($($word:ty),+) => {$(
        impl ValueEnum for $word {
            fn value_variants<'a>() -> &'a [Self] {
                Self::ALL
            }

            fn to_possible_value(&self) -> Option<PossibleValue> {
                Some(PossibleValue::new(self.word()).help(self.about()))
            }
        }
    )+};
}

option_values!(Device, Division, ExportForm, UnitSource, WordFormat);
