//! The common step of words that are whole multiples of one.

/// Least step worth a look, in Allan deviations of the words: the quantisation of a smaller one, a
/// hundredth of their variance, is no more than any rounding of a log.
const PER_DEVIATION_MIN: f64 = 0.2;

/// Relative difference of two words that is rounding.
const ROUNDING: f64 = 1e-9;

/// Part of a step by which a word may miss its multiple: the last digit of a printed one.
const MISS_MAX: f64 = 0.1;

/// Multiples up to which a step is refined, one after the other.
const REFINED_TO: [f64; 5] = [8.0, 64.0, 512.0, 4096.0, f64::INFINITY];

/// Step of which all words are whole multiples, deg/h; nothing if there is none, or if it is small
/// beside the differences of the words.
pub(crate) fn common_step(words_deg_per_h: &[f64]) -> Option<f64> {
    let squares: f64 = differences(words_deg_per_h).map(|it| it * it).sum();
    let variance = squares / (2.0 * words_deg_per_h.len() as f64);
    let least = PER_DEVIATION_MIN * variance.sqrt();
    let mut smallest = f64::INFINITY;
    for two in words_deg_per_h.windows(2) {
        let difference = (two[1] - two[0]).abs();
        if difference > ROUNDING * two[0].abs().max(two[1].abs()) {
            if difference < least {
                return None;
            }
            smallest = smallest.min(difference);
        }
    }
    if !smallest.is_finite() {
        return None;
    }
    // Differences are small multiples also where the words are large ones.
    let mut step = refined(differences(words_deg_per_h), smallest, f64::INFINITY)?;
    for limit in REFINED_TO {
        let words = words_deg_per_h.iter().copied();
        step = refined(words, step, limit).unwrap_or(step);
    }
    let misses = |word: &f64| {
        let multiple = word / step;
        (multiple - multiple.round()).abs() > MISS_MAX
    };
    (step >= least && !words_deg_per_h.iter().any(misses)).then_some(step)
}

fn differences(words: &[f64]) -> impl Iterator<Item = f64> {
    words.windows(2).map(|two| two[1] - two[0])
}

/// The step of least squares given the multiples up to a limit; nothing if all are zero.
fn refined(values: impl Iterator<Item = f64>, step: f64, limit: f64) -> Option<f64> {
    let (mut product, mut square) = (0.0, 0.0);
    for value in values {
        let multiple = (value / step).round();
        if multiple.abs() <= limit {
            product += value * multiple;
            square += multiple * multiple;
        }
    }
    (square > 0.0).then(|| product / square)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_of_printed_words_is_found_and_no_other() {
        let multiples = (0..4000_u32).map(|k| f64::from((k * k) % 7) - 2.0);
        for step in [5.333_333_333, 0.079_6, 36_000.0] {
            let digits = 4.0 - f64::floor(f64::log10(step));
            let unit = 10.0_f64.powf(digits);
            let words: Vec<f64> = multiples
                .clone()
                .map(|multiple| (multiple * step * unit).round() / unit)
                .collect();
            let found = common_step(&words).expect("a step");
            assert!((found / step - 1.0).abs() < 1e-4, "{found} {step}");
        }
        // Large multiples, small differences.
        let words: Vec<f64> = multiples.clone().map(|it| (it + 9000.0) * 0.25).collect();
        assert!((common_step(&words).expect("a step") - 0.25).abs() < 1e-12);
        let uneven = multiples.zip(0_u32..);
        let uneven: Vec<f64> = uneven
            .map(|(it, k)| it + 0.3 * f64::from(k).sin())
            .collect();
        assert_eq!(common_step(&uneven), None);
        assert_eq!(common_step(&[2.0; 100]), None);
    }
}
