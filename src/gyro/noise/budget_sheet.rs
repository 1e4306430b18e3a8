//! The noise budget over modulation depth and power, and the depth of least noise.

use std::f64::consts::TAU;

use crate::gyro::error::GyroError;
use crate::gyro::instrument::word_period_s;
use crate::gyro::limits::{MotionExtremes, cautions};
use crate::gyro::noise::budget::NoiseBudget;
use crate::gyro::noise::law::Density;
use crate::gyro::optics::coil::Coil;
use crate::gyro::optics::detector::Detector;
use crate::gyro::optics::modulator::{Modulator, optimum_depth_rad};
use crate::gyro::parts::Parts;
use crate::gyro::thermal::condition::Condition;
use crate::gyro::{Fidelity, GyroConfig};
use crate::signal::{BudgetEntry, BudgetPoint, BudgetSheet};
use crate::units::{deg_per_sqrt_h_to_rad_per_sqrt_s, rad_to_deg, rad_to_urad};

/// Modulation depths at which the budget is given, deg: whole degrees from here to there.
const DEPTHS_DEG: std::ops::RangeInclusive<u32> = 15..=175;
/// Range in which the best depth is searched, deg: that of the scenario key.
const DEPTH_RANGE_DEG: (f64, f64) = (1.0, 179.0);
/// Powers at which the budget is given: so many a decade, over two decades to either side.
const POWERS_PER_DECADE: i32 = 10;
const DECADES: i32 = 2;
/// Largest power that a scenario may give, uW.
const POWER_UW_MAX: f64 = 1e5;
/// Width to which the best depth is searched, deg.
const DEPTH_TOLERANCE_DEG: f64 = 1e-6;

/// The budget of a configuration at another power and modulation depth.
///
/// # Errors
/// [`GyroError::NoSlope`] and [`GyroError::ConverterRange`].
pub fn budget_at(
    config: &GyroConfig,
    power_uw: f64,
    depth_deg: f64,
) -> Result<NoiseBudget, GyroError> {
    let mut config = config.clone();
    config.source.power_uw = power_uw;
    config.modulator.depth_deg = depth_deg;
    let modulator = Modulator::new(&config.modulator);
    let detector = Detector::new(&config, &modulator, &Condition::at_start(&config))?;
    let coil = Coil::new(&config.coil, &config.source);
    Ok(with_rate_word(NoiseBudget::new(&detector, &coil), &config))
}

/// A budget with the rounding of the words of a configuration, at the bandwidth it asks for.
pub(in crate::gyro) fn with_rate_word(budget: NoiseBudget, config: &GyroConfig) -> NoiseBudget {
    let time_constant_s = 1.0 / (TAU * config.controller.loop_bandwidth_hz);
    budget.with_rate_word(&config.output, word_period_s(config), time_constant_s)
}

/// Noise that does not go with the light over noise that does, `beta` of the best depth.
///
/// The squared walk is `(a + b cos + c cos^2) / sin^2` of the depth with the visibility V,
/// `A = 2 e R P0`, `C = RIN (R P0)^2` and everything that does not depend on the light in B (dark
/// current, Johnson, amplifier, and rounding as the density `gate_duty tau q^2 / (6 n)` of the
/// current step q): `a = A + B + C`, `b = (A + 2 C) V`, `c = C V^2`, so that
/// `beta = (A + B + C (1 + V^2)) / ((A + 2 C) V) - 1`. Technical phase noise does not depend on the
/// depth and moves nothing. Infinite if nothing goes with the light; NaN if there is nothing at all.
///
/// # Source
/// Derived. At unit visibility it is the `B / (A + 2 C)` of the usual form.
#[must_use]
pub fn power_independent_ratio(detector: &Detector, coil: &Coil) -> f64 {
    let current_a = detector.mean_current_a;
    let (mut shot, mut constant, mut rin) = (0.0, 0.0, 0.0);
    for density in detector.densities.0 {
        match density {
            Density::OfCurrent { a2_per_hz_per_a } => {
                shot += a2_per_hz_per_a * current_a;
                constant += a2_per_hz_per_a * detector.dark_current_a;
            }
            Density::Intensity { per_hz } => rin += per_hz * current_a * current_a,
            Density::Current { a2_per_hz } => constant += a2_per_hz,
            Density::Rounding { step_v } => {
                let step_a = step_v / detector.transimpedance_v_per_a;
                constant += detector.gate_duty * coil.transit_time_s * step_a * step_a
                    / (6.0 * detector.samples_per_half_period);
            }
            Density::Phase { .. } => {}
        }
    }
    let visibility = detector.visibility;
    (shot + constant + rin * (1.0 + visibility * visibility)) / ((shot + 2.0 * rin) * visibility)
        - 1.0
}

/// The budget of a configuration, against depth and against power.
///
/// # Errors
/// Any [`GyroError`] of the configuration.
pub fn budget_sheet(config: &GyroConfig) -> Result<BudgetSheet, GyroError> {
    let Parts { coil, detector, .. } = Parts::new(config)?;
    let (power_uw, depth_deg) = (config.source.power_uw, config.modulator.depth_deg);
    let budget = with_rate_word(NoiseBudget::new(&detector, &coil), config);
    let ratio = if detector.densities.has_equivalent() {
        // A walk that is given is that at every depth.
        f64::NAN
    } else {
        power_independent_ratio(&detector, &coil)
    };
    // NaN: no source depends on the depth.
    let closed_form = (!ratio.is_nan()).then(|| rad_to_deg(optimum_depth_rad(ratio)));
    let best = |power_uw: f64| {
        let depth_deg = closed_form.and_then(|_| best_depth_deg(config, power_uw))?;
        Some(point(config, power_uw, depth_deg))
    };
    let powers = powers_uw(power_uw);
    Ok(BudgetSheet {
        configured: point(config, power_uw, depth_deg),
        entries: entries(&budget, &coil),
        replaced_sources: detector.densities.replaced(),
        optimum: best(power_uw),
        closed_form_optimum_depth_deg: closed_form,
        by_depth: DEPTHS_DEG
            .map(|depth_deg| point(config, power_uw, f64::from(depth_deg)))
            .collect(),
        by_power: powers
            .iter()
            .map(|power_uw| point(config, *power_uw, depth_deg))
            .collect(),
        by_power_at_optimum_depth: powers
            .iter()
            .filter_map(|power_uw| best(*power_uw))
            .collect(),
        // At rest, and as the loop model has it: the rate model refuses what is said here.
        cautions: cautions(config, Fidelity::Loop, &MotionExtremes::default())?,
    })
}

fn point(config: &GyroConfig, power_uw: f64, modulation_depth_deg: f64) -> BudgetPoint {
    BudgetPoint {
        power_uw,
        modulation_depth_deg,
        angle_random_walk_deg_per_sqrt_h: budget_at(config, power_uw, modulation_depth_deg)
            .ok()
            .map(|budget| budget.entries()),
    }
}

fn entries(budget: &NoiseBudget, coil: &Coil) -> Vec<BudgetEntry> {
    let total = budget.total_deg_per_sqrt_h();
    let entry = |(source, walk): (&'static str, f64)| BudgetEntry {
        source,
        angle_random_walk_deg_per_sqrt_h: walk,
        power_share: if total > 0.0 {
            (walk / total).powi(2)
        } else {
            0.0
        },
        phase_noise_urad_per_sqrt_hz: rad_to_urad(
            2.0_f64.sqrt() * deg_per_sqrt_h_to_rad_per_sqrt_s(walk) * coil.scale_factor_s,
        ),
    };
    budget.entries().into_iter().map(entry).collect()
}

/// Powers around one, uW.
fn powers_uw(power_uw: f64) -> Vec<f64> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the decimal exponent of a power in its allowed range"
    )]
    let decade = power_uw.log10().round() as i32;
    ((decade - DECADES) * POWERS_PER_DECADE..=(decade + DECADES) * POWERS_PER_DECADE)
        .map(|step| 10.0_f64.powf(f64::from(step) / f64::from(POWERS_PER_DECADE)))
        .filter(|power_uw| *power_uw <= POWER_UW_MAX)
        .collect()
}

/// Depth of least total at a power, by golden section, deg; `None` if no depth is within the
/// converter's range.
///
/// The budget has one minimum over the depth. The bias point is the brighter the smaller the depth,
/// so that depths out of range all lie at the lower end: two of them move the search upwards.
fn best_depth_deg(config: &GyroConfig, power_uw: f64) -> Option<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let total = |depth_deg: f64| {
        budget_at(config, power_uw, depth_deg)
            .map_or(f64::INFINITY, |budget| budget.total_deg_per_sqrt_h())
    };
    let (mut low, mut high) = DEPTH_RANGE_DEG;
    let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut totals = inner.map(total);
    while high - low > DEPTH_TOLERANCE_DEG {
        if totals[0] < totals[1] {
            high = inner[1];
            inner = [high - GOLDEN * (high - low), inner[0]];
            totals = [total(inner[0]), totals[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + GOLDEN * (high - low)];
            totals = [totals[1], total(inner[1])];
        }
    }
    // The upper end of what is left: where the range cuts the search off, only it is within.
    total(high).is_finite().then_some(high)
}
