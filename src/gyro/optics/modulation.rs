//! Bias waves: the states of one loop period and what each tells the two loops.

use std::f64::consts::PI;

use crate::gyro::ModulationScheme;

/// One state of the bias wave, as the interferometer sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::gyro) struct BiasState {
    /// Whether the bias phase is `+phi_m` modulo a turn (else `-phi_m`): the rate demodulation
    /// subtracts this state.
    pub(in crate::gyro) is_plus: bool,
    /// Bias phase difference as commanded, rad; it carries the modulator's gain error.
    pub(in crate::gyro) phase_rad: f64,
    /// Sign with which the demodulation of the modulator's gain takes this state; 0 = not at all.
    pub(in crate::gyro) gain_sign: f64,
}

/// Timing of a bias wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gyro) struct Timing {
    /// States in one loop period.
    pub(in crate::gyro) states: u32,
    /// Half modulation periods (transit times) in one loop period.
    pub(in crate::gyro) half_periods: u32,
    /// States in one half period: the interferometer compares states this far apart.
    pub(in crate::gyro) states_per_half_period: u32,
}

impl Timing {
    /// The timing of a scheme.
    pub(in crate::gyro) fn new(scheme: ModulationScheme) -> Self {
        let (states, half_periods) = match scheme {
            ModulationScheme::TwoState => (2, 2),
            ModulationScheme::FourState => (4, 4),
            ModulationScheme::FourStateHalf => (4, 2),
        };
        Self {
            states,
            half_periods,
            states_per_half_period: states / half_periods,
        }
    }
}

/// The states of a scheme at bias depth `phi_m = pi - a`.
///
/// ```text
/// two-state        dphi_b / rad = {+phi_m, -phi_m}
/// four-state       dphi_b / rad = {+(pi-a), -(pi-a), +(pi+a), -(pi+a)}
/// four-state-half  dphi_b / rad = {+(pi+a), +(pi-a), -(pi+a), -(pi-a)}
/// ```
///
/// `pi + a` is `-phi_m` and `-(pi + a)` is `+phi_m` modulo a turn, so that every state stands at
/// one of the two bias points, with the same power and the same slope. The states at `+phi_m` fall
/// with the phase error, the others rise. A modulator gain error e adds `e dphi_b`: in the
/// four-state schemes the states near 3 pi / 2 and near pi / 2 then differ by a signal
/// `pi e sin a`, orthogonal to that of the phase error.
///
/// # Source
/// Lefevre, The Fiber-Optic Gyroscope, 2nd ed., section 8.2.3 (four-state modulation).
pub(in crate::gyro) fn states(scheme: ModulationScheme, depth_rad: f64) -> Vec<BiasState> {
    let far = 2.0 * PI - depth_rad;
    let table: &[(bool, f64, f64)] = match scheme {
        ModulationScheme::TwoState => &[(true, depth_rad, 0.0), (false, -depth_rad, 0.0)],
        ModulationScheme::FourState => &[
            (true, depth_rad, -1.0),
            (false, -depth_rad, -1.0),
            (false, far, 1.0),
            (true, -far, 1.0),
        ],
        ModulationScheme::FourStateHalf => &[
            (false, far, 1.0),
            (true, depth_rad, -1.0),
            (true, -far, 1.0),
            (false, -depth_rad, -1.0),
        ],
    };
    table
        .iter()
        .map(|&(is_plus, phase_rad, gain_sign)| BiasState {
            is_plus,
            phase_rad,
            gain_sign,
        })
        .collect()
}
