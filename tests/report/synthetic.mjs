// Made-up sweeps, the same at every call: what the page is tested with.
// node synthetic.mjs [full|unreferenced|several|hostile|sparse|empty] > data.json
import { normal, penumbra, picture, room, stream } from "./picture.mjs";

const HOSTILE = ["</script><b>bold</b>", "<!--<script>alert(1)", "\"quoted\" & 'single', comma", "=1+1\u2028\\u003c"];
const SAMPLERS = [
  { name: "cone", spread: 0.5, bias: 0, cost: 1.15 },
  { name: "inverse-cosine", spread: 1.6, bias: 0, cost: 1 },
  { name: "gaussian", spread: 1.6, bias: 0.012, cost: 1.04 },
  { name: "uniform-angles", spread: 1.1, bias: -0.08, cost: 0.9 },
];
const COUNTS = [4, 16, 64, 256, 1024];
const SEEDS = 10;
const SIZE = 64;
const REGIONS = [
  { name: "whole", rect: [0, 0, SIZE, SIZE], mean: 0.4, weight: 1 },
  { name: "penumbra", rect: [24, 48, 60, 64], mean: 0.16, weight: 2.4 },
  { name: "red wall", rect: [0, 10, 12, 50], mean: 0.11, weight: 0.4 },
];
const PATH = "light.sampler";
const FAULTS = {
  37: ["failed", "the scene has no lamp: every picture is black"],
  101: ["device_lost", "the device was lost after 41 s"],
  199: ["timeout", "no answer for 120 s"],
};

/** An interval around a value, `share` of it to both sides. */
function around(value, share) {
  const width = Math.abs(value) * share;
  return { value, low: value - width, high: value + width };
}

/** What a group finds in a region. */
function found(sampler, count, seconds, region, first, random, referenced) {
  const variance = sampler.spread * region.weight * region.mean * (1 + 0.04 * normal(random));
  const error = 1.96 * Math.sqrt(variance / (count * SEEDS)) / (region.mean * 40);
  const bias = sampler.bias * region.weight + (error / 3) * normal(random);
  const mse = variance / count + (bias * region.mean) ** 2;
  const base = { mean: around(region.mean * (1 + bias), error), variance: around(variance, 0.09) };
  if (!referenced) return { ...base, bias: null, mse: null, relmse: null, crossing: null, efficiency: null, equal_time: null, equal_error: null, verdict: null };
  const seen = Math.abs(bias) > error;
  return {
    ...base,
    bias: { value: bias, low: bias - error, high: bias + error },
    mse: around(mse, 0.12),
    relmse: around(mse / (region.mean * region.mean), 0.14),
    crossing: seen ? variance / (bias * region.mean) ** 2 : null,
    efficiency: around(1 / (mse * seconds), 0.16),
    equal_time: first ? around((mse * seconds) / first, 0.18) : around(1, 0),
    equal_error: first ? around((variance * sampler.cost) / (0.5 * region.weight * region.mean * 1.15), 0.18) : around(1, 0),
    verdict: seen ? "different" : count >= 256 ? "same" : "not-enough-samples",
  };
}

/** The group's pictures: mean, bias, deviation; returns their places in `images`. */
function groupPictures(images, name, sampler, count, random, referenced) {
  const noise = Math.sqrt(sampler.spread / (count * SEEDS));
  const shift = (u, v) => sampler.bias * (0.4 + 6 * penumbra(u, v) * (1 - penumbra(u, v)));
  const noisy = (u, v) => room(u, v).map((value) => value * (1 + shift(u, v) + noise * 0.5 * normal(random)));
  const lost = (u, v) => room(u, v).map((value) => value * (shift(u, v) + noise * 0.5 * normal(random)));
  const spread = (u, v) => room(u, v).map((value) => value * Math.sqrt(sampler.spread) * (0.6 + 1.8 * penumbra(u, v)));
  const put = (image) => images.push(image) - 1;
  return {
    mean_image: put(picture(`${name}, mean`, "radiance", SIZE, noisy)),
    bias_image: referenced ? put(picture(`${name}, bias`, "bias", SIZE, lost)) : null,
    deviation_image: put(picture(`${name}, deviation`, "deviation", SIZE, spread)),
  };
}

/** One run, with its picture if it went well. */
function run(images, index, group, sampler, count, seed, path) {
  const random = stream(7919 * (index + 1));
  const [status, error] = FAULTS[index] ?? ["ok", null];
  const noise = Math.sqrt(sampler.spread / count);
  const seconds = status === "ok" ? count * 0.004 * sampler.cost * (1 + 0.03 * normal(random)) : 0;
  const colour = (u, v) => room(u, v).map((value) => Math.max(0, value * (1 + sampler.bias + noise * normal(random))));
  const values = { [path]: sampler.name, "render.samples": count, "render.seed": seed };
  return {
    id: `run-${String(index).padStart(3, "0")}`,
    status, error, values, seed, samples: count,
    device: index % 2 ? "NVIDIA H200" : "llvmpipe (LLVM 15.0.6, 256 bits)",
    seconds, paths: count * SIZE * SIZE, rays: count * SIZE * SIZE * 7,
    mean: status === "ok" ? [0.44, 0.4, 0.36].map((value) => value * (1 + sampler.bias + 0.002 * normal(random))) : [null, null, null],
    standard_error: status === "ok" ? [0.011, 0.01, 0.009].map((value) => value * noise) : null,
    group: status === "ok" ? group : null,
    image: status === "ok" ? images.push(picture(`${sampler.name}, ${count} samples, seed ${seed}`, "radiance", SIZE, colour)) - 1 : null,
  };
}

/** 20 groups of 10 runs, three of which went wrong. */
function full({ referenced = true, path = PATH, samplers = SAMPLERS } = {}) {
  const images = [], groups = [], runs = [];
  const first = new Map();
  if (referenced) images.push(picture("reference", "radiance", SIZE, room));
  for (const sampler of samplers) {
    for (const count of COUNTS) {
      const random = stream(groups.length + 1);
      const seconds = count * 0.004 * sampler.cost;
      const name = `${sampler.name}, ${count} samples`;
      const regions = REGIONS.map((region, at) => {
        const result = found(sampler, count, seconds, region, first.get(at), random, referenced);
        if (referenced && !first.has(at)) first.set(at, result.mse.value * seconds);
        return result;
      });
      groups.push({
        name, values: { [path]: sampler.name, "render.samples": count }, reference: referenced ? 0 : null, runs: SEEDS, samples: count,
        seconds: around(seconds, 0.03), regions, ...groupPictures(images, name, sampler, count, random, referenced),
      });
      for (let seed = 0; seed < SEEDS; seed++) runs.push(run(images, runs.length, groups.length - 1, sampler, count, seed, path));
    }
  }
  return { ...words(path, samplers), runs, groups, regions: REGIONS.map(({ name, rect }) => ({ name, rect })), references: referenced ? [reference()] : [], images, notes: [] };
}

function words(path, samplers) {
  return {
    title: "Sampling a spherical lamp",
    question: "Which way of drawing points on a lamp is right, and which is fastest at equal error?",
    command: `lampray sweep scenes/cornell.toml --set ${path}=${samplers.map((each) => each.name).join(",")} --set render.samples=4..1024*4 --set render.seed=0..9 -o report/`,
    version: "0.1.0",
    axes: [
      { path, values: samplers.map((each) => each.name) },
      { path: "render.samples", values: COUNTS.map(String) },
      { path: "render.seed", values: Array.from({ length: SEEDS }, (_, seed) => String(seed)) },
    ],
    findings: [
      "uniform-angles is biased: −8.0 % of the reference over the whole picture, and −19 % in the penumbra.",
      "cone needs 0.36 of the time of inverse-cosine for the same error.",
      "gaussian shows a bias of +1.2 % that more samples do not take away; below 1 000 samples noise hides it.",
      "3 of 200 runs did not finish; what is said of their groups rests on 9 runs each.",
    ],
  };
}

function reference() {
  return { name: "scenes/cornell-reference.exr", samples: 1048576, image: 0, mean: [0.4401, 0.4002, 0.3598], standard_error: [0.00011, 0.0001, 0.00009] };
}

/** Names that break pages which trust them, and a seed that a double cannot hold. */
function hostile() {
  const samplers = SAMPLERS.map((sampler, at) => ({ ...sampler, name: HOSTILE[at] }));
  const data = full({ path: "materials.</script><i>.albedo", samplers });
  data.title = HOSTILE[0] + HOSTILE[1];
  data.question = data.command = HOSTILE.join(" ");
  data.findings = HOSTILE;
  data.regions[1].name = HOSTILE[0];
  data.runs[37].error = HOSTILE[1];
  data.references[0].name = HOSTILE[1];
  data.notes = HOSTILE;
  data.runs[0].seed = "@18446744073709551615@";
  return data;
}

/** One run a group: no interval has ends; wide pictures; a group of which nothing is known. */
function sparse() {
  const data = full();
  const open = (interval) => interval && { value: interval.value, low: null, high: null };
  for (const group of data.groups) {
    group.seconds = open(group.seconds);
    for (const region of group.regions) {
      for (const key of ["mean", "bias", "variance", "mse", "relmse", "efficiency", "equal_time", "equal_error"]) region[key] = open(region[key]);
    }
  }
  Object.assign(data.groups[3], { seconds: open({ value: null }), regions: [], mean_image: null, bias_image: null, deviation_image: null });
  data.axes = data.axes.slice(0, 1);
  for (const image of data.images) Object.assign(image, { width: 2 * SIZE, height: SIZE / 2 });
  return data;
}

/** Two expected pictures, one group without a reference, maps that there was no room for, and pictures of
 * half the size. */
function several() {
  const data = full();
  const brighter = (u, v) => room(u, v).map((value) => 1.5 * value);
  const other = data.images.push(picture("reference for albedo 0.9", "radiance", SIZE, brighter)) - 1;
  data.references.push({ ...reference(), name: "reference for albedo 0.9", samples: 320, image: other });
  for (const group of data.groups.slice(10)) {
    group.reference = 1;
    for (const found of group.regions) Object.assign(found, { equal_time: null, equal_error: null });
  }
  data.groups[19].reference = null;
  for (const group of data.groups.slice(4)) group.deviation_image = null;
  for (const region of data.regions) region.rect = region.rect.map((end) => 2 * end);
  data.notes = ["10 of 20 groups have no ratios: they are not held against the reference of cone, 4 samples.", "Maps of deviation are shown for the first 4 of 20 groups."];
  return data;
}

function empty() {
  return { title: "", question: "", command: "", version: "", axes: [], runs: [], groups: [], regions: [], references: [], images: [], findings: [], notes: [] };
}

/** JSON of a made-up sweep, as the Rust side writes it. */
export function synthetic(kind) {
  const makers = { full, unreferenced: () => full({ referenced: false }), several, hostile, sparse, empty };
  return JSON.stringify(makers[kind]()).replace(/"@(\d+)@"/g, "$1");
}

if (import.meta.url === `file://${process.argv[1]}`) process.stdout.write(synthetic(process.argv[2] ?? "full"));
