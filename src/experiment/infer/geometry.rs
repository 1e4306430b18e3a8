//! What of a record does not move with the parameters: its blocks and its dwells.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::metrics::{BlockGeometry, ExpectedFigure, largest_of_normals};
use crate::scenario::{MotionClass, Scenario};
use crate::units::{deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h};

/// Most blocks of a bias stability.
pub(super) const BLOCKS_MAX: usize = 512;

/// Geometries of blocks, which many readings share.
#[derive(Debug, Default)]
pub(super) struct Geometries(BTreeMap<(u64, usize, u64), Arc<BlockGeometry>>);

impl Geometries {
    /// That of so many blocks behind a warm-up.
    pub(super) fn of(
        &mut self,
        time_s: f64,
        count: usize,
        warm_up_s: f64,
    ) -> Option<Arc<BlockGeometry>> {
        let key = (time_s.to_bits(), count, warm_up_s.to_bits());
        if let Some(known) = self.0.get(&key) {
            return Some(known.clone());
        }
        let is_small = count <= BLOCKS_MAX;
        let geometry = is_small.then(|| BlockGeometry::new(time_s, count, warm_up_s))??;
        let geometry = Arc::new(geometry);
        self.0.insert(key, geometry.clone());
        Some(geometry)
    }
}

/// Rates of a staircase and how well each is measured beside a noise of density 1.
#[derive(Clone, Debug)]
pub(super) struct Staircase {
    /// Rates at which the scale factor is read, rad/s.
    pub(super) rates_rad_per_s: Vec<f64>,
    /// Expected largest and its scatter over the full scale, for a density of 1 (deg/h) sqrt(s).
    pub(super) largest: ExpectedFigure,
    /// Deviation of the slope for a density of 1 (deg/h) sqrt(s).
    pub(super) slope_deviation: f64,
}

/// The dwells of a scale factor test or of steps.
pub(super) fn staircase(scenario: &Scenario) -> Option<Staircase> {
    let motion = scenario.measured_motion();
    let MotionClass::Steps(stairs) = motion.class() else {
        return None;
    };
    let mut start_s = 0.0;
    let mut dwells = Vec::new();
    for (rate, end_s) in stairs.rates_deg_per_s.iter().zip(&stairs.ends_s) {
        dwells.push((
            deg_per_s_to_rad_per_s(*rate),
            end_s - start_s - stairs.settle_s,
        ));
        start_s = *end_s;
    }
    let inner = if stairs.has_static_zeros {
        dwells.get(1..dwells.len() - 1)?
    } else {
        &dwells
    };
    let rates_rad_per_s: Vec<f64> = inner.iter().map(|dwell| dwell.0).collect();
    // What the zeros scatter moves all alike, which the line takes up.
    let deviations: Vec<f64> = inner
        .iter()
        .map(|dwell| dwell.1.max(1e-9).sqrt().recip())
        .collect();
    let full = rad_per_s_to_deg_per_h(
        rates_rad_per_s
            .iter()
            .fold(0.0_f64, |most, rate| most.max(rate.abs())),
    );
    let over_full: Vec<f64> = deviations
        .iter()
        .map(|deviation| deviation / full)
        .collect();
    let count = rates_rad_per_s.len() as f64;
    let mean = rates_rad_per_s.iter().sum::<f64>() / count;
    let (mut square, mut noise) = (0.0, 0.0);
    for (rate, deviation) in rates_rad_per_s.iter().zip(&deviations) {
        square += (rate - mean).powi(2);
        noise += ((rate - mean) * deviation).powi(2);
    }
    let slope_deviation = noise.sqrt() / square / rad_per_s_to_deg_per_h(1.0);
    Some(Staircase {
        rates_rad_per_s,
        largest: largest_of_normals(&over_full),
        slope_deviation,
    })
}
