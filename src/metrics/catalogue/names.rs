//! What was meant by a metric that nobody knows.

use std::sync::OnceLock;

use super::list::{find, known_metrics};
use crate::metrics::key::metric::MetricKey;
use crate::wording::{Likeness, Name, Vocabulary, conversion, likeness, words_of};

/// Most metrics that are named at once.
const NAMED_MAX: usize = 8;

/// The words of each synonym and its metric.
static SYNONYM_WORDS: OnceLock<Vec<(Vec<String>, &str)>> = OnceLock::new();

/// The metric that a name must have been meant for, if there is one such.
pub(crate) fn meant(name: &str) -> Option<&'static MetricKey> {
    match suggestions(name)[..] {
        [only] => find(only),
        _ => None,
    }
}

/// The complaint about a name that is no metric, of a filter or of a raw channel.
pub(crate) fn unknown_of_channel(name: &str, is_filter: bool) -> Option<String> {
    let complaint = unknown(name)?;
    Some(match meant(name) {
        Some(known) if known.filters_only && !is_filter => format!(
            "`{name}` is not a metric; `{}`, the nearest, compares a filter with the raw channel, \
             and raw itself has none",
            known.name
        ),
        _ => complaint,
    })
}

/// The complaint about a name, if it is no metric.
pub(crate) fn unknown(name: &str) -> Option<String> {
    if find(name).is_some() {
        return None;
    }
    let mut names = suggestions(name);
    if names.is_empty() {
        names = related(name);
        return Some(if names.is_empty() {
            format!("`{name}` is not a metric; a run's summary.json lists those of its channels")
        } else {
            format!(
                "`{name}` is not a metric; of its words there are `{}`",
                names.join("`, `")
            )
        });
    }
    let unit = match names[..] {
        [known] => conversion(name, known),
        _ => None,
    };
    let unit = unit.map_or_else(String::new, |unit| format!(" ({unit})"));
    Some(format!(
        "`{name}` is not a metric; did you mean `{}`?{unit}",
        names.join("` or `")
    ))
}

fn vocabulary() -> &'static Vocabulary {
    static VOCABULARY: OnceLock<Vocabulary> = OnceLock::new();
    VOCABULARY.get_or_init(|| known_metrics().iter().map(|known| known.name).collect())
}

/// Every metric and its name, taken apart.
fn names() -> &'static [(Name, &'static MetricKey)] {
    static NAMES: OnceLock<Vec<(Name, &'static MetricKey)>> = OnceLock::new();
    NAMES.get_or_init(|| {
        let metrics = known_metrics().iter().copied();
        metrics.map(|known| (Name::of(known.name), known)).collect()
    })
}

/// The likest metrics of the same quantity.
fn suggestions(name: &str) -> Vec<&'static str> {
    let words = words_of(name);
    let synonyms = SYNONYM_WORDS.get_or_init(|| {
        let names = known_metrics().iter().flat_map(|known| {
            let words = known.synonyms.iter().map(|name| words_of(name));
            words.map(|words| (words, known.name))
        });
        names.collect()
    });
    if let Some((_, metric)) = synonyms.iter().find(|(synonym, _)| *synonym == words) {
        return vec![*metric];
    }
    let written = Name::of(name);
    let alike = names().iter();
    let alike =
        alike.filter_map(|(name, known)| Some((likeness(&written, name, vocabulary())?, *known)));
    let mut alike: Vec<(Likeness, &MetricKey)> = alike.collect();
    alike.sort_by_key(|(likeness, _)| *likeness);
    let best = alike.first().map(|(likeness, _)| *likeness);
    let best = alike.iter().filter(|(likeness, _)| Some(*likeness) == best);
    best.map(|(_, known)| known.name).take(NAMED_MAX).collect()
}

/// The metrics whose names hold every word of a name, if they are few.
fn related(name: &str) -> Vec<&'static str> {
    let words = words_of(name);
    let holds = |known: &&MetricKey| {
        let own = words_of(known.name);
        words.iter().all(|word| own.contains(word))
    };
    let names: Vec<&str> = known_metrics()
        .iter()
        .copied()
        .filter(holds)
        .map(|known| known.name)
        .collect();
    if names.len() > NAMED_MAX || words.is_empty() {
        return Vec::new();
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_synonym_stands_for_its_metric_alone() {
        for known in known_metrics() {
            for name in known.synonyms {
                assert_eq!(suggestions(name), [known.name], "{name}");
            }
        }
    }

    #[test]
    fn every_metric_with_one_slip_suggests_itself() {
        for known in known_metrics() {
            let longest = known
                .name
                .split('_')
                // A number in a word is none of its letters.
                .filter(|word| !word.contains(|c: char| c.is_ascii_digit()))
                .max_by_key(|word| word.len())
                .unwrap_or("");
            let at = known.name.find(longest).unwrap_or(0) + longest.len() / 2;
            let slip = format!("{}{}", &known.name[..at], &known.name[at + 1..]);
            if known_metrics().iter().any(|other| other.name == slip) {
                continue;
            }
            assert_eq!(suggestions(&slip), [known.name], "{slip}");
        }
    }

    #[test]
    fn no_metric_is_taken_for_another_quantity() {
        for (own, one) in names() {
            for (known, other) in names() {
                let found = likeness(own, known, vocabulary());
                assert!(
                    found.is_none() || one.name == other.name,
                    "{} {}",
                    one.name,
                    other.name
                );
            }
        }
    }

    #[test]
    fn names_of_the_field_lead_to_their_metrics() {
        let said = |name| unknown(name).unwrap();
        assert!(said("arw").ends_with("did you mean `angle_random_walk_deg_per_sqrt_h`?"));
        assert!(said("BI").contains("`bias_instability_deg_per_h`"));
        assert!(said("rrw_deg_per_h_per_rt_hr").contains("rate_random_walk"));
        assert!(said("noise_std_dph").contains("`noise_std_deg_per_h`"));
        assert!(said("delay_ms").contains("`delay_vs_raw_ms`"));
        assert!(said("mean_deg_per_s").ends_with("`mean_deg_per_h`? (1 deg/s is 3600 deg/h)"));
        assert!(
            said("arw_deg_per_h_per_sqrt_hz")
                .contains("per_sqrt_h`? (1 deg/h/sqrt(hz) is 0.0166667")
        );
        // Two quantities, or one that is none of these: all that have the words are named.
        let walks = said("random_walk");
        assert!(walks.contains("angle_random_walk") && walks.contains("rate_random_walk"));
        assert!(!said("bias").contains("`mean_deg_per_h`"));
        assert!(said("zebra").contains("summary.json"));
        assert_eq!(unknown("noise_gain"), None);
    }
}
