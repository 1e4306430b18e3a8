//! Sums of squared second differences of a record with missing samples.

use rayon::prelude::*;

use super::angle::{angle_about_mean, squared_second_differences};

/// Stretches of missing samples (NaN): first one and the one after the last.
pub(crate) fn missing_stretches(rates: &[f64]) -> Vec<(usize, usize)> {
    let mut stretches: Vec<(usize, usize)> = Vec::new();
    for (index, _) in rates.iter().enumerate().filter(|(_, rate)| rate.is_nan()) {
        match stretches.last_mut() {
            Some((_, end)) if *end == index => *end += 1,
            _ => stretches.push((index, index + 1)),
        }
    }
    stretches
}

/// Sum of the squared second differences of the angle that touch no missing sample, and their number,
/// for every averaging factor, each below half the samples.
///
/// Nothing is put in the place of what is missing: a difference of averaging factor m that starts at angle
/// k takes in the rates `k .. k + 2m`, and is left out where one of them is not there.
pub(crate) fn second_difference_sums_with_gaps(
    rates: &[f64],
    stretches: &[(usize, usize)],
    factors: &[usize],
) -> Vec<(f64, usize)> {
    let angle = angle_about_mean(rates);
    let of_factor = |&m: &usize| {
        let starts = angle.len() - 2 * m;
        let (mut sum, mut count, mut next) = (0.0, 0, 0);
        let mut add = |from: usize, end: usize| {
            if from < end {
                sum += squared_second_differences(
                    &angle[from..end],
                    &angle[from + m..end + m],
                    &angle[from + 2 * m..end + 2 * m],
                );
                count += end - from;
            }
        };
        for (first, end) in stretches {
            add(next, (first + 1).saturating_sub(2 * m).min(starts));
            next = next.max(*end);
        }
        add(next, starts);
        (sum, count)
    };
    factors.par_iter().map(of_factor).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_that_touch_a_gap_are_left_out_and_no_others() {
        let mut rates: Vec<f64> = (0..500).map(|k| ((k * k) % 101) as f64).collect();
        for missing in [0, 1, 120, 121, 122, 127, 400, 499] {
            rates[missing] = f64::NAN;
        }
        let stretches = missing_stretches(&rates);
        assert_eq!(
            stretches,
            [(0, 2), (120, 123), (127, 128), (400, 401), (499, 500)]
        );
        let factors = [1, 2, 3, 10, 60, 140];
        let sums = second_difference_sums_with_gaps(&rates, &stretches, &factors);
        for (m, (sum, count)) in factors.into_iter().zip(sums) {
            let mut plain = (0.0, 0);
            for k in 0..=500 - 2 * m {
                let mean = |from: usize| rates[from..from + m].iter().sum::<f64>();
                let difference = mean(k + m) - mean(k);
                if !difference.is_nan() {
                    plain = (plain.0 + difference * difference, plain.1 + 1);
                }
            }
            assert_eq!(count, plain.1, "m = {m}");
            assert!((sum - plain.0).abs() <= 1e-9 * plain.0.max(1.0), "m = {m}");
        }
    }
}
