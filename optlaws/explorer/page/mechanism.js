// Mechanisms to scale, as layers of a chart: the cam and its follower as they turn, with dimensions and the force at the contact;
// links with their joints and paths, or a drum with what it drives, at a time of the cycle.

import { createChart } from "./chart.js";
import { label } from "./layers.js";
import { valueAt } from "./timing.js";
import { number, written } from "./units.js";

const MORE = 1.12;
const CIRCLES = { "prime circle": -50, "base circle": -130 }; // where each is named, degrees
const LONGEST = 0.4; // of the cam's size, the arrow of the greatest force
const ROOM = 26;
const SLIDER = [18, 14]; // pixels
const GROUND = "M0 0l-9 13h18ZM-13 13h26";
const EIGHTH = Math.PI / 4;
const sizeOf = (value) => written({ value, unit: "mm", digits: 6 });
const away = ([x, y], length, angle) => [x + length * Math.cos(angle), y + length * Math.sin(angle)];
const far = (points) => Math.max(...points.map(([x, y]) => Math.hypot(x, y)));
const line = (name, ...points) => ({ name, points });

export function createMechanism(root) {
  const chart = createChart(root);
  let drawn = null; // a function from a place of the input to a picture
  let place = 0;
  let forceCurve = null;
  let withDimensions = true;

  /** What is drawn: a cam with its follower or another mechanism of the server, or null. */
  function show(drawing) {
    forceCurve = null;
    drawn = drawing && !drawing.refused ? pictures(drawing) : null;
    moveTo(place);
  }

  /** The force at the contact over the turn: the curve of its values. */
  function bear(force) {
    forceCurve = force;
    moveTo(place);
  }

  /** With or without dimensions. */
  function measure(measured) {
    withDimensions = measured;
    moveTo(place);
  }

  /** Show an angle of a cam in degrees; of a mechanism that moves by a cycle a share of it, from 0 to 1. */
  function moveTo(now) {
    place = now;
    chart.show(drawn && drawn(now, { force: forceCurve, withDimensions }));
  }

  return { show, bear, measure, at: moveTo };
}

/** A function from the place of the input to the picture of a drawing. */
function pictures(drawing) {
  if (!drawing.kind) return ofCam(drawing);
  const now = (values, share) => along(values, share);
  if (drawing.kind === "cam") {
    const cam = ofCam(drawing);
    return (share) => cam(((now(drawing.input, share) % 360) + 360) % 360, { withDimensions: true });
  }
  const [x, y] = { links: endsOfLinks, table: () => [[-1.1, 1.1], [-1.1, 1.1]] }[drawing.kind]?.(drawing) ?? endsOfSlide(drawing);
  const sketch = drawing.kind === "table" || drawing.kind === "screw";
  const paths = (drawing.paths ?? []).map((points) => line("joint-path", ...points));
  const unit = drawing.axis === "angle" ? "deg" : "mm";
  const told = `The ${drawing.name}, drawn ${sketch ? "as a sketch" : "to scale"}; its input goes from ${number(drawing.ends[0], unit)} to ${written({ value: drawing.ends[1], unit, digits: 6 })}`;
  const parts = { links: linksAt, table: tableAt }[drawing.kind] ?? slideAt;
  return (share) => ({ x: { range: x, ruler: !sketch }, y: { range: y }, equal: ROOM, lines: paths, marks: parts(drawing, (values) => now(values, share)), told, of: {} });
}

/** The number, or the place, at a share of a course from 0 to 1: its steps are even in time. */
function along(values, share) {
  const at = share * (values.length - 1);
  const [low, high] = [Math.floor(at), Math.min(values.length - 1, Math.floor(at) + 1)];
  const mean = (one, other) => one + (at - low) * (other - one);
  return Array.isArray(values[low]) ? values[low].map((one, i) => mean(one, values[high][i])) : mean(values[low], values[high]);
}

// --- cams ---

function ofCam({ curves, tangents, turning, follower, dimensions }) {
  const turned = (points, angle) => {
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    return points.map(([x, y]) => [cos * x - sin * y, sin * x + cos * y]);
  };
  // the follower at each angle: its roller's centre, its point of contact, the direction of its face
  const frames = [curves.pitch, curves.profile, tangents].map((points) => points.map((one, i) => turned([one], (turning * 2 * Math.PI * i) / (points.length - 1))[0]));
  const reach = MORE * Math.max(...Object.values(curves).map(far), follower.pivot ?? 0);
  const top = Math.max(...frames[0].map(([, y]) => y)) + 0.45 * reach;
  const ends = [[-reach, reach], [-reach, follower.pivot === null ? Math.max(reach, top) : reach]];
  const size = far(curves.profile);

  return (angle, { force: curve = null, withDimensions }) => {
    const step = Math.round(angle) % (frames[0].length - 1);
    const [centre, contact, edge] = frames.map((frame) => frame[step]);
    const force = curve && valueAt(curve.at, curve.values, step);
    const turn = (turning * angle * Math.PI) / 180;
    const sizes = dimensions.map(({ name, value }) => `${name} ${sizeOf(value)}`);
    const circles = withDimensions ? dimensions.filter(({ name }) => name in CIRCLES).map(({ name, value }) => ({ name, value, at: away([0, 0], value, (CIRCLES[name] * Math.PI) / 180) })) : [];
    const arrow = force === null ? null : arrowOf({ force, most: Math.max(...curve.values.map((value) => Math.abs(value ?? 0))), size, follower, centre, contact, edge });
    return {
      x: { range: ends[0] }, y: { range: ends[1] }, equal: 0, of: {},
      marks: [
        ...Object.entries(curves).map(([name, points]) => ({ name: `cam-${name}`, points: turned(points, turn), closed: true })),
        { at: [0, 0], name: "shaft", size: 0.06 * reach }, line("key", [0, 0], away([0, 0], 0.06 * reach, turn)),
        ...followerAt(follower, size, centre, contact, edge),
        ...circles.flatMap(({ value, at }) => [{ at: [0, 0], name: "dimension", size: value }, line("dimension leader", [0, 0], at)]),
        ...(arrow ? [{ name: "force", points: arrow, head: true }] : []),
      ],
      labels: [
        ...circles.map(({ name, value, at }) => ({ at, text: `${name} R ${sizeOf(value)}`, free: true })),
        ...(arrow ? [{ at: arrow[1], text: `${label(Number(force.toPrecision(4)))} N`, name: "force-value", free: true }] : []),
      ],
      notes: withDimensions ? sizes.filter((_, i) => !(dimensions[i].name in CIRCLES)) : [],
      told: `The cam and its follower at ${written({ value: Math.round(angle), unit: "deg", digits: 6 })}: ${[...sizes, ...(force === null ? [] : [`contact force ${label(force)} N`])].join(", ")}`,
    };
  };
}

function followerAt({ roller, pivot }, size, centre, contact, edge) {
  const face = (length) => line("face", ...[-length, length].map((part) => [contact[0] + part * edge[0], contact[1] + part * edge[1]]));
  const stem = ([x, y]) => line("arm", [x, y], [x, y + 0.7 * size]);
  const arms = pivot !== null
    ? [roller === null ? face(size) : line("arm", [pivot, 0], centre), { at: [pivot, 0], name: "shaft", size: 0.05 * size }]
    : roller === null ? [face(0.6 * size), stem([0, contact[1]])] : [stem(centre)];
  const rollers = roller === null ? [] : [{ at: centre, name: "roller", size: roller }, { at: centre, name: "shaft", size: 0.2 * roller }];
  return [...arms, ...rollers, { at: contact, name: "contact", size: 0.018 * size }];
}

/** The force of the cam on the follower, along the normal at the contact: from where to where its arrow goes. */
function arrowOf({ force, most, size, follower, centre, contact, edge: [ex, ey] }) {
  const outward = follower.roller === null ? contact : [centre[0] - contact[0], centre[1] - contact[1]];
  const sign = Math.sign(-ey * outward[0] + ex * outward[1]) || 1;
  const length = (LONGEST * size * force) / (most || 1);
  return [contact, [contact[0] - sign * ey * length, contact[1] + sign * ex * length]];
}

// --- links, tables, slides: the least and greatest x and y of all that moves, in mm, and the parts at a time ---

function endsOfLinks({ chains, paths = [] }) {
  const all = [...paths.flat(), ...chains.flat(2)];
  return [0, 1].map((i) => [Math.min(...all.map((one) => one[i])), Math.max(...all.map((one) => one[i]))]);
}

function linksAt({ chains, fixed }, now) {
  const [below, links, above] = [[], [], []];
  chains.forEach((chain, i) => {
    const places = chain.map(now);
    const [at] = places;
    if (fixed[i]) below.push({ at, name: "support", glyph: GROUND }, { at, name: "shaft", r: 4 });
    else if (chain.length === 1) above.push({ at, name: "slider", sides: SLIDER }, { at, name: "shaft", r: 3 });
    else links.push(line("link", ...places), ...places.map((joint) => ({ at: joint, name: "shaft", r: 3.2 })));
  });
  return [...links, ...below, ...above];
}

/** The size of a table is of no meaning. */
function tableAt({ axis, input }, now) {
  const angle = axis === "angle" ? (now(input) * Math.PI) / 180 : 0;
  const spoke = (name, turn, inner) => line(name, ...[inner, 0.98].map((share) => away([0, 0], share, angle + turn)));
  const notches = [1, 2, 3, 4, 5, 6, 7].map((i) => spoke("key", i * EIGHTH, 0.82));
  return [{ at: [0, 0], name: "drum", size: 1 }, ...notches, spoke("arm", 0, 0.5), { at: [0, 0], name: "shaft", size: 0.12 }];
}

const radiusOf = ({ kind, slide, size }) => (kind === "screw" ? Math.max(...slide.map(Math.abs), size) / 12 : size);

function endsOfSlide(drawing) {
  const { slide } = drawing;
  const radius = radiusOf(drawing);
  return [[Math.min(...slide, 0) - 2 * radius, Math.max(...slide, 0) + 2 * radius], [-1.8 * radius, 2 * radius]];
}

/** A pinion with its rack, a pulley with its belt, a screw with its nut. */
function slideAt(drawing, now) {
  const { kind, slide, input } = drawing;
  const radius = radiusOf(drawing);
  const [low, high] = [Math.min(...slide, 0) - radius, Math.max(...slide, 0) + radius];
  const way = now(slide);
  const turned = -(now(input) * Math.PI) / 180;
  const across = (name, y, by = 0) => line(name, [low + by, y], [high + by, y]);
  const wheel = (at) => [{ at, name: "drum", size: radius }, line("key", at, away(at, radius, turned)), { at, name: "shaft", r: 4 }];
  const block = (y) => ({ at: [way, y], name: "slider", sides: [SLIDER[1], SLIDER[1]], size: 0.8 * radius });
  if (kind === "rack") return [...wheel([0, 0]), across("link", radius, way), block(1.4 * radius)];
  if (kind === "belt") return [across("belt", radius), across("belt", -radius), ...wheel([low, 0]), ...wheel([high, 0]), block(1.4 * radius)];
  const pitch = (high - low) / 40;
  const phase = (((way % pitch) + pitch) % pitch) - pitch;
  const threads = [...Array(42).keys()].map((i) => low + phase + i * pitch).filter((x) => x > low && x + 0.6 * pitch < high).map((x) => line("key", [x, -0.5 * radius], [x + 0.6 * pitch, 0.5 * radius]));
  return [across("link", 0.5 * radius), across("link", -0.5 * radius), ...threads, block(0)];
}
