//! What the results of a run depend on, but for the seed and the program.

use crate::scenario::document::emit::to_toml;
use crate::scenario::document::tree::parse_document;
use crate::scenario::keys::defaults::sparse;
use crate::scenario::read::resolved::{Resolved, digest};

/// Keys that leave every value and interval as it is, and the seed, beside which values are compared.
const WITHOUT_EFFECT: &[&str] = &[
    "schema",
    "name",
    "description",
    "seed",
    "gate",
    "published",
    "comparison",
    "output",
    "matrix",
];

/// Digits of a digest that are kept: 64 bits tell any two scenarios of a suite apart.
const DIGITS: usize = 16;

impl Resolved {
    /// Digest of the conditions of the run: what its results depend on, but for the seed and the program.
    ///
    /// Two runs of equal conditions may be compared. What a key says that its default says as well is left
    /// out, so that a key more in a later version leaves the digest, and a default that changes shows in the
    /// results.
    #[must_use]
    pub fn conditions(&self) -> String {
        let mut tree = self.tree.clone();
        tree.retain(|key, _| !WITHOUT_EFFECT.contains(&key.as_str()));
        // In the canonical spelling, in which a manifest repeats it: `0` where a key takes a number is `0.0`.
        let canonical = parse_document(0, &to_toml(&tree, ""));
        let mut text = to_toml(&sparse(&canonical.unwrap_or(tree)), "");
        if let Some(campaign) = &self.campaign {
            text.push_str("campaign = ");
            text.push_str(&campaign.conditions());
        }
        let mut digest = digest(&text);
        digest.truncate(DIGITS);
        digest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::keys::defaults::fill;
    use crate::scenario::load_suite;

    fn resolved(set: &[&str]) -> Resolved {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/quick/static.toml");
        let set: Vec<String> = set.iter().map(|&set| set.to_owned()).collect();
        load_suite(&[path.into()], &set).unwrap().remove(0)
    }

    #[test]
    fn seed_gates_and_words_leave_the_conditions_and_physics_do_not() {
        let conditions = |set: &[&str]| resolved(set).conditions();
        let own = conditions(&[]);
        assert_eq!(own.len(), DIGITS);
        for same in [
            "seed=7",
            "description=\"x\"",
            "gate[0].max=1.0",
            "output.samples=\"npy\"",
        ] {
            assert_eq!(conditions(&[same]), own, "{same}");
        }
        for other in [
            "gyro.coil.length_m=900.0",
            "filter.rls.taps=5",
            "duration_s=61.0",
            "repeats=2",
        ] {
            assert_ne!(conditions(&[other]), own, "{other}");
        }
    }

    #[test]
    fn a_sparse_tree_fills_up_to_the_whole_and_a_default_that_is_written_is_none() {
        let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios");
        let suite = load_suite(
            &[
                format!("{shipped}/quick").into(),
                format!("{shipped}/audit").into(),
            ],
            &[],
        )
        .unwrap();
        assert!(suite.len() > 20, "{}", suite.len());
        for run in suite {
            let mut tree = sparse(&run.tree);
            assert!(to_toml(&tree, "").len() < to_toml(&run.tree, "").len());
            fill(&mut tree);
            assert_eq!(to_toml(&tree, ""), to_toml(&run.tree, ""), "{}", run.file);
        }
    }
}
