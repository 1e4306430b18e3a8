//! Line enhancer of patent CN101221046, with its normalised and unity-gain forms.

mod core;
mod notes;
mod settings;

pub use self::core::{
    SignLms, SignLmsConfig, SignLmsCore, sign_lms_slew_per_sample, sign_lms_slew_samples,
};
pub use self::settings::SignLmsFilterConfig;
