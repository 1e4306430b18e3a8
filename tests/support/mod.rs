//! Helpers shared by the integration tests.

pub(crate) mod stimulus;

/// Asserts that `got` equals `want` within `rtol * |want| + atol`.
#[track_caller]
pub(crate) fn assert_close(got: f64, want: f64, rtol: f64, atol: f64) {
    let error = (got - want).abs();
    assert!(
        error <= rtol * want.abs() + atol,
        "got {got}, want {want}: off by {error}, allowed rtol {rtol}, atol {atol}"
    );
}
