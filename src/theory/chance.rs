//! How likely a test statistic is by chance alone.

/// Share of a chi-square distribution with `freedom` degrees above `statistic`.
pub fn chi_square_above(statistic: f64, freedom: f64) -> f64 {
    gamma_above(0.5 * freedom, 0.5 * statistic)
}

/// Regularised upper incomplete gamma function Q(a, x): by its series below a + 1, by its continued
/// fraction (Lentz) above.
fn gamma_above(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let front = (a * x.ln() - x - libm::lgamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-16 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - front * sum;
    }
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (1e300, 1.0 / b);
    let mut h = d;
    for i in 1..100_000 {
        let i = f64::from(i);
        let an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        h *= c * d;
        if (c * d - 1.0).abs() < 1e-15 {
            break;
        }
    }
    front * h
}

/// Share of Kolmogorov's distribution above `statistic`: that of the largest distance between two
/// distribution functions, times the root of the number of draws (n m / (n + m) for two samples).
pub fn kolmogorov_above(statistic: f64) -> f64 {
    if statistic < 0.2 {
        return 1.0;
    }
    let term = |k: i32| {
        let sign = if k % 2 == 1 { 2.0 } else { -2.0 };
        sign * (-2.0 * (f64::from(k) * statistic).powi(2)).exp()
    };
    (1..101).map(term).sum::<f64>().clamp(0.0, 1.0)
}

/// Largest distance between the distribution functions of two sorted samples of one size.
pub fn distance_of_sorted(a: &[f64], b: &[f64]) -> f64 {
    let (mut i, mut j, mut apart) = (0, 0, 0usize);
    while i < a.len() && j < b.len() {
        let at = a[i].min(b[j]);
        while i < a.len() && a[i] <= at {
            i += 1;
        }
        while j < b.len() && b[j] <= at {
            j += 1;
        }
        apart = apart.max(i.abs_diff(j));
    }
    apart as f64 / a.len() as f64
}
