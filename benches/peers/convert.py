"""A lampray scene as a Mitsuba 3 dictionary that has the same expected picture.

Spheres are spheres, boxes are cubes with a transform (turned about x, then y, then z). `diffuse` is `diffuse`,
`mirror` is `conductor` with perfect reflection and the albedo as its specular reflectance; both two-sided, as
all surfaces of lampray are. `directional` has no counterpart: a scene with it is refused. The
background is a `constant` emitter that is never sampled, as in lampray, where rays only meet it.
lampray's max_bounces = N is Mitsuba's max_depth = N + 1: the emitter that is seen at once is depth 1 there.
Roulette is the same: by the largest channel of the throughput, at most 0.95, first at the fifth hit.
"""

import tomllib

REFERENCE_ROULETTE = 5


def read(path):
    with open(path, "rb") as file:
        return tomllib.load(file)


def rgb(values):
    return {"type": "rgb", "value": list(values)}


def surface(material):
    scatter = material.get("scatter", "diffuse")
    albedo = rgb(material.get("albedo", [0.75] * 3))
    if scatter == "diffuse":
        bsdf = {"type": "diffuse", "reflectance": albedo}
    elif scatter == "mirror":
        bsdf = {"type": "conductor", "material": "none", "specular_reflectance": albedo}
    else:
        raise ValueError(f"Mitsuba has no scattering like {scatter}")
    return {"type": "twosided", "bsdf": bsdf}


def emission(material):
    radiance = material.get("emission", [0, 0, 0])
    return {"emitter": {"type": "area", "radiance": rgb(radiance)}} if max(radiance) > 0 else {}


def cube(mi, shape):
    """The cube of Mitsuba goes from -1 to 1."""
    low, high = shape["min"], shape["max"]
    center = [(a + b) / 2 for a, b in zip(low, high)]
    half = [(b - a) / 2 for a, b in zip(low, high)]
    turn = shape.get("rotation", [0, 0, 0])
    place = mi.ScalarTransform4f().translate(center)
    for axis in (2, 1, 0):
        place = place @ mi.ScalarTransform4f().rotate([float(i == axis) for i in range(3)], turn[axis])
    return {"type": "cube", "to_world": place @ mi.ScalarTransform4f().scale(half)}


def camera(mi, view, width, height):
    up = view.get("up", [0, 1, 0])
    return {
        "type": "perspective",
        "fov": view.get("fov", 45.0),
        "fov_axis": "y",
        "near_clip": 1e-4,
        "far_clip": 1e5,
        "to_world": mi.ScalarTransform4f().look_at(origin=view["position"], target=view["look_at"], up=up),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "independent"},
    }


def to_mitsuba(mi, scene, width, height):
    """`scene` is what `read` gives; `mi` has its variant set."""
    bounces = scene.get("render", {}).get("max_bounces", 8)
    integrator = {"type": "path", "max_depth": bounces + 1, "rr_depth": REFERENCE_ROULETTE}
    made = {"type": "scene", "integrator": integrator, "sensor": camera(mi, scene["camera"], width, height)}
    background = scene.get("background", {}).get("emission", [0, 0, 0])
    if max(background) > 0:
        made["background"] = {"type": "constant", "radiance": rgb(background), "sampling_weight": 0.0}
    materials = scene["materials"]
    for name in materials:
        made[f"material_{name}"] = surface(materials[name])
    shapes = [{"type": "sphere", "center": ball["center"], "radius": ball["radius"]} for ball in scene.get("spheres", [])]
    shapes += [cube(mi, box) for box in scene.get("boxes", [])]
    for number, (shape, source) in enumerate(zip(shapes, scene.get("spheres", []) + scene.get("boxes", []))):
        name = source["material"]
        shape["bsdf"] = {"type": "ref", "id": f"material_{name}"}
        made[f"shape_{number}"] = shape | emission(materials[name])
    return made
