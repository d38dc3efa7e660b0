// Boxes that shine: a direction to one of the faces that a point sees, even by solid angle.
//
// A face is a rectangle. Its solid angle is that of two triangles (van Oosterom and Strackee, "The solid angle of a
// plane triangle", 1983), whose form has no cancellation; within it directions are drawn by Urena, Fajardo and King,
// "An area-preserving parametrization for spherical rectangles" (2013). Where a face is so small that the angles of
// that say too little of it, points are drawn evenly by area, and weighted by the density that they have.
//
// Everything is in the box's own axes, seen from the receiver; a face across axis a has its own x and y along
// the next two axes, and lies at the height z.

// #import maths
// #import box

struct BoxSample {
    direction: vec3<f32>,
    // How far the shadow ray must be free.
    distance: f32,
    // Inverse density by solid angle; 0 where no face is seen.
    inverse_density: f32,
}

struct Rectangle {
    low: vec2<f32>,
    size: vec2<f32>,
    // Above zero where the face is seen.
    height: f32,
}

// Steradians below which points are drawn by area.
const SMALL_FACE: f32 = 3e-3;

// The angle of (cosine, sine), sine >= 0, up to half a turn; the two need not be of unit length.
fn angle_of(cosine: f32, sine: f32) -> f32 {
    let inverse = inverseSqrt(greater(cosine * cosine + sine * sine, 1e-37));
    let chord = sine * inverse * sqrt(2.0 / (1.0 + abs(cosine) * inverse));
    let angle = angle_of_chord(chord);
    return select(PI - angle, angle, cosine >= 0.0);
}

// A vector with `axis` as its third component and the next two before it.
fn turned(v: vec3<f32>, axis: u32) -> vec3<f32> {
    return select(select(v.xyz, v.zxy, axis == 1u), v.yzx, axis == 0u);
}

fn turned_back(v: vec3<f32>, axis: u32) -> vec3<f32> {
    return select(select(v.xyz, v.yzx, axis == 1u), v.zxy, axis == 0u);
}

// The face across an axis: the one on the receiver's side of the box's middle, or the one on the far side.
fn box_rectangle(half_size: vec3<f32>, local: vec3<f32>, inside: bool, axis: u32, far: bool) -> Rectangle {
    let size = turned(half_size, axis);
    let place = turned(local, axis);
    let near_height = select(abs(place.z) - size.z, size.z - abs(place.z), inside);
    let far_height = select(0.0, size.z + abs(place.z), inside);
    return Rectangle(-size.xy - place.xy, 2.0 * size.xy, select(near_height, far_height, far));
}

// A face at another scale, with its farthest edge at 1: products of three lengths stay within 32-bit floats.
fn to_scale(face: Rectangle) -> Rectangle {
    let ends = greater(largest(abs(face.low.xyy)), largest(abs((face.low + face.size).xyy)));
    let scale = 1.0 / greater(greater(ends, face.height), 1e-30);
    return Rectangle(face.low * scale, face.size * scale, face.height * scale);
}

// Of the triangle at two edges of a rectangle, its corners' vectors given; `volume` is their triple product.
fn triangle_angle(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, volume: f32) -> f32 {
    let lengths = vec3<f32>(length(a), length(b), length(c));
    let below = lengths.x * lengths.y * lengths.z
        + dot(a, b) * lengths.z + dot(b, c) * lengths.x + dot(c, a) * lengths.y;
    return 2.0 * angle_of(below, volume);
}

// Solid angle; 0 for a face that is not seen.
fn rectangle_angle(seen: Rectangle) -> f32 {
    let face = to_scale(seen);
    let high = face.low + face.size;
    let volume = face.height * face.size.x * face.size.y;
    let a = vec3<f32>(face.low, face.height);
    let c = vec3<f32>(high, face.height);
    let first = triangle_angle(a, vec3<f32>(high.x, face.low.y, face.height), c, volume);
    let second = triangle_angle(a, vec3<f32>(face.low.x, high.y, face.height), c, volume);
    return select(0.0, first + second, seen.height > 0.0);
}

// Solid angles of the three near faces and of the three far ones.
struct BoxAngles {
    near: vec3<f32>,
    far: vec3<f32>,
}

fn box_angles(half_size: vec3<f32>, local: vec3<f32>, inside: bool) -> BoxAngles {
    let near = vec3<f32>(
        rectangle_angle(box_rectangle(half_size, local, inside, 0u, false)),
        rectangle_angle(box_rectangle(half_size, local, inside, 1u, false)),
        rectangle_angle(box_rectangle(half_size, local, inside, 2u, false)),
    );
    var far = vec3<f32>(0.0);
    if inside {
        far = vec3<f32>(
            rectangle_angle(box_rectangle(half_size, local, true, 0u, true)),
            rectangle_angle(box_rectangle(half_size, local, true, 1u, true)),
            rectangle_angle(box_rectangle(half_size, local, true, 2u, true)),
        );
    }
    return BoxAngles(near, far);
}

fn all_angles(angles: BoxAngles) -> f32 {
    return dot(angles.near + angles.far, vec3<f32>(1.0));
}

// The face on whose stretch of the sum of all angles a number lies: 0 to 2 the near ones, 3 to 5 the far ones. One that
// is not seen has no stretch; rounding may put a number past the last.
fn box_face_at(angles: BoxAngles, place: f32) -> u32 {
    let near = angles.near;
    let far = angles.far;
    let one = near.x;
    let two = one + near.y;
    let three = two + near.z;
    let four = three + far.x;
    let five = four + far.y;
    var face = select(0u, 1u, place >= one && near.y > 0.0);
    face = select(face, 2u, place >= two && near.z > 0.0);
    face = select(face, 3u, place >= three && far.x > 0.0);
    face = select(face, 4u, place >= four && far.y > 0.0);
    face = select(face, 5u, place >= five && far.z > 0.0);
    return face;
}

// A point of a face, even by solid angle.
fn sample_spherical(seen: Rectangle, angle: f32, u: vec2<f32>) -> vec2<f32> {
    let face = to_scale(seen);
    let low = face.low;
    let high = face.low + face.size;
    let z = face.height;
    let y_squares = vec2<f32>(low.y * low.y, high.y * high.y);
    // Angles of the spherical rectangle at (low, high) and (low, low).
    let upper = angle_of(low.x * high.y, z * length(vec3<f32>(low.x, high.y, z)));
    let lower = angle_of(-low.x * low.y, z * length(vec3<f32>(low, z)));
    let turn = sincos_turn(clamp((u.x * angle + PI - upper - lower) / (2.0 * PI), -0.5, 0.5));
    let b = vec2<f32>(-low.y, high.y) * inverseSqrt(y_squares + z * z);
    let sine = select(turn.x, select(-1e-12, 1e-12, turn.x >= 0.0), abs(turn.x) < 1e-12);
    let slope = clamp((turn.y * b.x + b.y) / sine, -1e15, 1e15);
    // Their cosine is 1 / sqrt(slope^2 + b.x^2); 1 less its square is written without a difference of such.
    let across = z * inverseSqrt(greater(slope * slope - z * z / (y_squares.x + z * z), 1e-12));
    let x = clamp(select(-across, across, slope > 0.0), low.x, high.x);
    let depth = x * x + z * z;
    let ends = vec2<f32>(low.y, high.y) * inverseSqrt(y_squares + depth);
    let h = ends.x + u.y * (ends.y - ends.x);
    let y = h * sqrt(depth) * inverseSqrt(greater((1.0 - h) * (1.0 + h), 1e-12));
    let point = vec2<f32>(x, clamp(y, low.y, high.y)) - low;
    return seen.low + point / face.size * seen.size;
}

// Inverse density of a point of a face by solid angle, the face chosen by its share of `total`.
fn face_inverse_density(face: Rectangle, angle: f32, total: f32, point: vec2<f32>) -> f32 {
    if angle >= SMALL_FACE {
        return total;
    }
    let to = vec3<f32>(point, face.height);
    let squared = greater(dot(to, to), 1e-36);
    let by_area = face.size.x / squared * face.size.y * (face.height * inverseSqrt(squared));
    return by_area * total / greater(angle, 1e-36);
}

// `inside`: whether `origin` is inside the box.
fn sample_box(shape: Box, origin: vec3<f32>, inside: bool, u: vec4<f32>) -> BoxSample {
    let local = box_local(shape, origin - shape.center);
    let angles = box_angles(shape.half_size, local, inside);
    let total = all_angles(angles);
    let chosen = box_face_at(angles, u.z * total);
    let axis = chosen % 3u;
    let far = chosen >= 3u;
    let angle = turned(select(angles.near, angles.far, far), axis).z;
    let face = box_rectangle(shape.half_size, local, inside, axis, far);
    var point = face.low + u.xy * face.size;
    if angle >= SMALL_FACE {
        point = sample_spherical(face, angle, u.xy);
    }
    let outward = turned(local, axis).z >= 0.0;
    let upward = (inside && !far) == outward;
    let to = turned_back(vec3<f32>(point, select(-face.height, face.height, upward)), axis);
    let distance = length(to);
    let direction = box_world(shape, to / greater(distance, 1e-30));
    let inverse_density = face_inverse_density(face, angle, total, point);
    return BoxSample(direction, distance, select(0.0, inverse_density, face.height > 0.0 && total > 0.0));
}

// Inverse density with which `sample_box` draws the direction to the point of the box at `origin + to`, where its
// outward unit normal is `outward`.
fn box_inverse_density(shape: Box, origin: vec3<f32>, inside: bool, to: vec3<f32>, outward: vec3<f32>) -> f32 {
    let local = box_local(shape, origin - shape.center);
    let normal = box_local(shape, outward);
    let slant = abs(normal);
    let axis = select(select(2u, 1u, slant.y >= slant.z), 0u, slant.x >= slant.y && slant.x >= slant.z);
    let far = inside && (turned(normal, axis).z >= 0.0) != (turned(local, axis).z >= 0.0);
    let angles = box_angles(shape.half_size, local, inside);
    let face = box_rectangle(shape.half_size, local, inside, axis, far);
    let angle = turned(select(angles.near, angles.far, far), axis).z;
    let point = turned(box_local(shape, to), axis).xy;
    return face_inverse_density(face, angle, all_angles(angles), point);
}
