/// Integral of `f` over `[a, b]` by `panels` panels of Gauss and Legendre's rule with five points:
/// exact for polynomials of degree nine in each panel.
pub fn integrate(a: f64, b: f64, panels: u32, f: impl Fn(f64) -> f64) -> f64 {
    // Abscissae sqrt(5 -+ 2 sqrt(10/7)) / 3 and weights (322 +- 13 sqrt 70) / 900.
    let root = (10.0_f64 / 7.0).sqrt();
    let (near, far) = (
        (5.0 - 2.0 * root).sqrt() / 3.0,
        (5.0 + 2.0 * root).sqrt() / 3.0,
    );
    let (heavy, light) = (322.0 + 13.0 * 70f64.sqrt(), 322.0 - 13.0 * 70f64.sqrt());
    let half = 0.5 * (b - a) / f64::from(panels);
    let panel = |index: u32| {
        let middle = a + half * f64::from(2 * index + 1);
        let pair = |x: f64| f(middle - half * x) + f(middle + half * x);
        half * (128.0 / 225.0 * f(middle) + heavy / 900.0 * pair(near) + light / 900.0 * pair(far))
    };
    (0..panels).map(panel).sum()
}
