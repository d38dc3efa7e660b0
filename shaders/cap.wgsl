// Directions to a ball even by projected solid angle, so that a matt receiver weighs each of them the same.
//
// Seen from a receiver with its normal upwards, the ball's directions are a cap of the unit sphere, and projected
// solid angle is area of their shadow on the unit disk. A cap above the horizon casts an ellipse. One that the
// horizon cuts casts a lune between the ellipse's far arc and the disk's rim: beside the ellipse where its middle
// is above, alone where it is below (Snyder, "Area light sources for real-time graphics", 1996; Urena and Georgiev,
// "Stratified sampling of projected spherical caps", 2018).
//
// The lune is drawn by its widths (own derivation). At the cosine v of an angle on the ellipse it is
// sin^2(a) s^2 (v - k)^2 / (rho + ...) wide, k the cosine where it ends. In e = (v - k) / (1 - k) = r (2 - r) its law
// of r is e^2 g(e), g smooth: a cubic through four places stands for g, so that the law is a polynomial that six
// points of Gauss integrate without error. What the cubic is off by, the density of a draw makes up for.

// #import maths

struct ProjectedCap {
    // x along the ball's side of the horizon, z the receiver's normal.
    frame: Basis,
    // Sine and cosine of the ball's half angle, and those of its middle above the horizon.
    sine: f32,
    cosine: f32,
    height: f32,
    side: f32,
    // Areas of the ellipse that is drawn from, and of the lune; 0 where there is none.
    ellipse: f32,
    lune: f32,
    // 1 - k, and the cubic for g.
    span: f32,
    cubic: vec4<f32>,
}

// Gauss's six points on [0, 1], the lower three and the upper three, and their shares.
const GAUSS_LOWER = vec3<f32>(0.033765243, 0.16939531, 0.3806904);
const GAUSS_UPPER = vec3<f32>(0.96623474, 0.83060467, 0.6193096);
const GAUSS_SHARES = vec3<f32>(0.085662246, 0.18038079, 0.23395696);

// Of the disk's rim across from the place `v` of the ellipse: its x.
fn lune_rim(cap: ProjectedCap, v: f32) -> f32 {
    return root(cap.cosine * cap.cosine + cap.sine * cap.sine * v * v);
}

fn lune_divisor(cap: ProjectedCap, v: f32) -> f32 {
    return lune_rim(cap, v) + cap.side * cap.cosine + abs(cap.height) * cap.sine * v;
}

fn lune_law(cap: ProjectedCap, e: f32) -> f32 {
    let v = 1.0 - cap.span + cap.span * e;
    return v / (greater(lune_divisor(cap, v), 1e-30) * root(1.0 - 0.5 * cap.span * (1.0 - e)));
}

fn lune_cubic(cap: ProjectedCap, e: f32) -> f32 {
    return cap.cubic.x + e * (cap.cubic.y + e * (cap.cubic.z + e * cap.cubic.w));
}

fn lune_density(cap: ProjectedCap, r: f32) -> f32 {
    let e = r * (2.0 - r);
    return e * e * lune_cubic(cap, e);
}

// No loop: Mesa's software drivers count those of an invocation.
fn lune_mass(cap: ProjectedCap, r: f32) -> f32 {
    let lower = r * GAUSS_LOWER;
    let upper = r * GAUSS_UPPER;
    let low = vec3<f32>(lune_density(cap, lower.x), lune_density(cap, lower.y), lune_density(cap, lower.z));
    let high = vec3<f32>(lune_density(cap, upper.x), lune_density(cap, upper.y), lune_density(cap, upper.z));
    return r * dot(GAUSS_SHARES, low + high);
}

fn projected_cap(axis: vec3<f32>, sine_squared: f32, normal: vec3<f32>) -> ProjectedCap {
    let basis = basis_around(normal);
    let flat = vec2<f32>(dot(axis, basis.x), dot(axis, basis.y));
    let side = length(flat);
    let toward = select(vec2<f32>(1.0, 0.0), flat / greater(side, 1e-30), side > 1e-30);
    let x = toward.x * basis.x + toward.y * basis.y;
    let y = toward.x * basis.y - toward.y * basis.x;
    let height = dot(axis, normal);
    let sine = root(sine_squared);
    let cosine = root(1.0 - sine_squared);
    let ellipse = PI * sine_squared * greater(height, 0.0);
    var cap = ProjectedCap(Basis(x, y, normal), sine, cosine, height, side, ellipse, 0.0, 1.0, vec4<f32>(0.0));
    let ratio = abs(height) / greater(sine, 1e-30);
    if ratio >= 1.0 {
        return cap;
    }
    let end = lesser(ratio * cosine / greater(side, 1e-6), 1.0);
    cap.span = lesser((1.0 - ratio) * (1.0 + ratio) / greater(side * side * (1.0 + end), 1e-12), 1.0);
    let g = vec4<f32>(lune_law(cap, 0.0), lune_law(cap, 0.25), lune_law(cap, 0.75), lune_law(cap, 1.0));
    cap.cubic = vec4<f32>(
        g.x,
        (-19.0 * g.x + 24.0 * g.y - 8.0 * g.z + 3.0 * g.w) / 3.0,
        (32.0 * g.x - 56.0 * g.y + 40.0 * g.z - 16.0 * g.w) / 3.0,
        (-16.0 * g.x + 32.0 * g.y - 32.0 * g.z + 16.0 * g.w) / 3.0,
    );
    let scale = 2.0 * sine_squared * sine * side * side * cap.span * cap.span * root(2.0 * cap.span);
    cap.lune = scale * lune_mass(cap, 1.0);
    return cap;
}

// A step of Newton's method in logarithms, in which the mass is all but a line.
fn nearer_place(cap: ProjectedCap, r: f32, wanted: f32) -> f32 {
    let mass = lune_mass(cap, r);
    return lesser(r * pow(wanted / mass, mass / (r * lune_density(cap, r))), 1.0);
}

// The r below which the share `u` of the lune's law lies: two such steps and a plain one; the mass is then right to
// 1e-6 of itself.
fn lune_place(cap: ProjectedCap, u: f32) -> f32 {
    let share = greater(u, 3e-8);
    let wanted = share * lune_mass(cap, 1.0);
    let r = nearer_place(cap, nearer_place(cap, pow(share, 0.29), wanted), wanted);
    return clamp(r + (wanted - lune_mass(cap, r)) / lune_density(cap, r), 0.0, 1.0);
}

// How far the lune reaches in from the rim.
fn lune_width(cap: ProjectedCap, e: f32) -> f32 {
    let v = 1.0 - cap.span + cap.span * e;
    let deep = cap.sine * cap.side * cap.span * e;
    return deep * deep / greater(lune_divisor(cap, v), 1e-30);
}

// A direction in the cap's frame. Its height is the root of a sum, not of a difference, however low it is.
fn sample_lune(cap: ProjectedCap, u: vec2<f32>) -> vec3<f32> {
    let across = 2.0 * u.x - 1.0;
    let r = lune_place(cap, abs(across));
    let half_turn = 0.5 * cap.span * (1.0 - r) * (1.0 - r);
    let y = 2.0 * cap.sine * root(half_turn * (1.0 - half_turn));
    let rim = lune_rim(cap, 1.0 - 2.0 * half_turn);
    let inward = u.y * lune_width(cap, r * (2.0 - r));
    return vec3<f32>(rim - inward, select(-y, y, across >= 0.0), root(inward * (2.0 * rim - inward)));
}

fn sample_ellipse(cap: ProjectedCap, u: vec2<f32>) -> vec3<f32> {
    let place = root(u.x) * unit_circle(u.y);
    // The point of the plane through the cap's edge that the direction stands above.
    let below = cap.cosine * cap.height + cap.sine * cap.side * place.x;
    let up = root(below * below + cap.sine * cap.sine * (1.0 - u.x));
    return vec3<f32>(cap.cosine * cap.side - cap.sine * cap.height * place.x, cap.sine * place.y, up);
}

// A direction of unit length; any at all where the whole cap is below the horizon.
fn sample_projected_cap(cap: ProjectedCap, u: vec3<f32>) -> vec3<f32> {
    var local: vec3<f32>;
    if u.z * (cap.ellipse + cap.lune) < cap.ellipse || cap.lune == 0.0 {
        local = sample_ellipse(cap, u.xy);
    } else {
        local = sample_lune(cap, u.xy);
    }
    return unit_vector_again(from_basis(cap.frame, local));
}

// Inverse density by solid angle of a direction of the cap; 0 where the receiver's horizon hides it.
fn projected_cap_inverse_density(cap: ProjectedCap, direction: vec3<f32>) -> f32 {
    let up = dot(cap.frame.z, direction);
    let area = cap.ellipse + cap.lune;
    if up <= 0.0 || area == 0.0 {
        return 0.0;
    }
    let y = lesser(abs(dot(cap.frame.y, direction)) / cap.sine, 1.0);
    let e = (root(1.0 - y * y) - 1.0 + cap.span) / cap.span;
    let within = clamp(e, 1e-6, 1.0);
    let rim = lune_rim(cap, 1.0 - cap.span + cap.span * within);
    let width = lune_width(cap, within);
    let in_lune = cap.lune > 0.0 && (cap.height <= 0.0 || (e > 0.0 && up * up < width * (2.0 * rim - width)));
    let made_up = lune_law(cap, within) / greater(lune_cubic(cap, within), 1e-30);
    return area / up * select(1.0, made_up, in_lune);
}
