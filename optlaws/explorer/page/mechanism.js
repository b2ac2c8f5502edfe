// Mechanisms to scale: the cam and its follower as they turn, with dimensions and the force at the contact; links with their
// joints and paths, or a drum with what it drives, at a time of the cycle.

import { label, ticks } from "./chart.js";
import { html, path, sized, svg } from "./svg.js";
import { valueAt } from "./timing.js";
import { number, written } from "./units.js";

const MORE = 1.12;
const LETTER = 6.4; // pixels of a letter
const CIRCLES = { "prime circle": -50, "base circle": -130 }; // where each is named, degrees
const LONGEST = 0.4; // of the cam's size, the arrow of the greatest force
const LINE = 14;
const sizeOf = (value) => written({ value, unit: "mm", digits: 6 });

/** A function from places, y upward, to pixels of a picture in which ends of x and y have room on all sides. */
function fitted(width, height, [[left, right], [low, high]], room = 0) {
  const factor = Math.min((width - 2 * room) / (right - left || 1), (height - 2 * room) / (high - low || 1));
  const [x0, y0] = [(width - factor * (left + right)) / 2, (height + factor * (low + high)) / 2];
  return Object.assign(([x, y]) => [x0 + factor * x, y0 - factor * y], { factor });
}

export function createMechanism(root) {
  let shown = null;
  let angleNow = 0;
  let cam = null;
  let followerGroup = null;
  let drawing = null;
  const dimensionsGroup = svg("g", { class: "dimensions", "aria-hidden": "true" });
  let forceCurve = null;
  let placeOf = null;
  let withDimensions = true;
  const size = sized(root, draw);

  function show(answer) {
    shown = answer.refused ? null : { ...answer, frames: framesOf(answer) };
    forceCurve = null;
    draw();
  }

  /** The force at the contact over the turn: the curve of its values. */
  function bear(force) {
    forceCurve = force;
    turn(angleNow);
  }

  /** With or without dimensions. */
  function measure(measured) {
    withDimensions = measured;
    draw();
  }

  /** Turn the cam to an angle in degrees. */
  function turn(angle) {
    angleNow = angle;
    if (!shown || !cam) return;
    cam.setAttribute("transform", `rotate(${shown.turning * angle})`);
    followerGroup.replaceChildren(...parts());
    dimensionsGroup.replaceChildren(...dimensions(), ...arrow());
    const sizes = shown.dimensions.map(({ name, value }) => `${name} ${sizeOf(value)}`);
    const force = forceNow();
    drawing.setAttribute("aria-label", `The cam and its follower at ${written({ value: Math.round(angle), unit: "deg", digits: 6 })}: ${[...sizes, ...(force === null ? [] : [`contact force ${label(force)} N`])].join(", ")}`);
  }

  function step() {
    return Math.round(angleNow) % (shown.frames.centre.length - 1);
  }

  function forceNow() {
    return forceCurve && valueAt(forceCurve.at, forceCurve.values, step());
  }

  /** Circles with their radii, and the other sizes in a corner. */
  function dimensions() {
    if (!withDimensions) return [];
    const { dimensions } = shown;
    const [x, y] = placeOf([0, 0]);
    const [width] = size();
    const circles = dimensions.filter(({ name }) => name in CIRCLES).flatMap(({ name, value }) => {
      const way = (CIRCLES[name] * Math.PI) / 180;
      const at = placeOf([value * Math.cos(way), value * Math.sin(way)]);
      const end = at[0] > x ? "start" : "end";
      const said = `${name} R ${sizeOf(value)}`;
      const room = LETTER * said.length; // its text stays in the picture
      const far = [at[0] + (end === "start" ? 22 : -22), at[1] + 26];
      return [
        svg("circle", { class: "dimension", cx: x, cy: y, r: Math.hypot(at[0] - x, at[1] - y) }),
        svg("path", { class: "dimension leader", d: path([[x, y], at, far]) }),
        svg("text", { x: end === "start" ? Math.min(far[0] + 4, width - room) : Math.max(far[0] - 4, room), y: far[1] + 4, "text-anchor": end, text: said }),
      ];
    });
    const others = dimensions.filter(({ name }) => !(name in CIRCLES)).map(({ name, value }, i) => svg("text", { x: 4, y: 14 + LINE * i, text: `${name} ${sizeOf(value)}` }));
    return [...circles, ...others];
  }

  /** The force of the cam on the follower, along the normal at the contact. */
  function arrow() {
    const force = forceNow();
    if (force === null) return [];
    const { frames, follower, curves } = shown;
    const most = Math.max(...forceCurve.values.map((value) => Math.abs(value ?? 0)));
    const size = Math.max(...curves.profile.map(([x, y]) => Math.hypot(x, y)));
    const [contact, [ex, ey], centre] = [frames.contact[step()], frames.edge[step()], frames.centre[step()]];
    const outward = follower.roller === null ? contact : [centre[0] - contact[0], centre[1] - contact[1]];
    const sign = Math.sign(-ey * outward[0] + ex * outward[1]) || 1;
    const length = (LONGEST * size * force) / (most || 1);
    const [from, to] = [contact, [contact[0] - sign * ey * length, contact[1] + sign * ex * length]].map((one) => placeOf(one));
    const way = Math.atan2(to[1] - from[1], to[0] - from[0]);
    const barb = (turn) => [to[0] - 9 * Math.cos(way + turn), to[1] - 9 * Math.sin(way + turn)];
    return [svg("path", { class: "force", d: path([from, to, null, barb(0.4), to, barb(-0.4)]) }), svg("text", { class: "force-value", x: to[0] + 8, y: to[1], text: `${label(Number(force.toPrecision(4)))} N` })];
  }

  function draw() {
    const [width, height] = size();
    if (!shown || width < 100 || height < 100) {
      root.replaceChildren();
      cam = null;
      return;
    }
    const { curves, frames, follower } = shown;
    const reach = MORE * Math.max(...Object.values(curves).flat().map(([x, y]) => Math.hypot(x, y)), follower.pivot ?? 0);
    const top = Math.max(...frames.centre.map(([, y]) => y)) + 0.45 * reach;
    const [low, high] = [-reach, follower.pivot === null ? Math.max(reach, top) : reach];
    cam = svg("g", {}, ...Object.entries(curves).map(([name, points]) => svg("path", { class: `cam-${name}`, d: `${path(points, 4)}Z` })), svg("circle", { class: "shaft", r: 0.06 * reach }), svg("line", { class: "key", x1: 0, y1: 0, x2: 0.06 * reach, y2: 0 }));
    followerGroup = svg("g", { class: "follower" });
    placeOf = fitted(width, height, [[-reach, reach], [low, high]]);
    const [middle, ground] = placeOf([0, 0]);
    // y upward, as in drawings of machines
    const world = svg("g", { transform: `translate(${middle} ${ground}) scale(${placeOf.factor} ${-placeOf.factor})` }, cam, followerGroup);
    drawing = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img" }, world, dimensionsGroup);
    root.replaceChildren(drawing);
    turn(angleNow);
  }

  function parts() {
    const { frames, follower, curves } = shown;
    const at = step();
    const [centre, contact, edge] = [frames.centre[at], frames.contact[at], frames.edge[at]];
    const size = Math.max(...curves.profile.map(([x, y]) => Math.hypot(x, y)));
    const line = (name, [x1, y1], [x2, y2]) => svg("line", { class: name, x1, y1, x2, y2 });
    const along = (length) => [contact[0] + length * edge[0], contact[1] + length * edge[1]];
    const parts = [];
    const foot = follower.roller === null ? contact : centre;
    if (follower.pivot !== null) {
      const pivot = [follower.pivot, 0];
      parts.push(follower.roller === null ? svg("line", { class: "face", x1: along(-size)[0], y1: along(-size)[1], x2: along(size)[0], y2: along(size)[1] }) : line("arm", pivot, centre), svg("circle", { class: "shaft", cx: pivot[0], cy: 0, r: 0.05 * size }));
    } else if (follower.roller === null) {
      parts.push(line("face", along(-0.6 * size), along(0.6 * size)), line("arm", [0, contact[1]], [0, contact[1] + 0.7 * size]));
    } else parts.push(line("arm", foot, [foot[0], foot[1] + 0.7 * size]));
    if (follower.roller !== null) parts.push(svg("circle", { class: "roller", cx: centre[0], cy: centre[1], r: follower.roller }), svg("circle", { class: "shaft", cx: centre[0], cy: centre[1], r: 0.2 * follower.roller }));
    parts.push(svg("circle", { class: "contact", cx: contact[0], cy: contact[1], r: 0.018 * size }));
    return parts;
  }

  return { show, bear, measure, turn };
}

/** The follower at each angle of the cam: its roller's centre, its point of contact, the direction of its face. */
function framesOf({ curves, tangents, turning }) {
  const turned = (points) => points.map(([x, y], i) => {
    const angle = (turning * 2 * Math.PI * i) / (points.length - 1);
    return [Math.cos(angle) * x - Math.sin(angle) * y, Math.sin(angle) * x + Math.cos(angle) * y];
  });
  return { centre: turned(curves.pitch), contact: turned(curves.profile), edge: turned(tangents) };
}

const ROOM = 26;
const SCALE = 90; // pixels that the bar of the scale is at most long

/** The number, or the place, at a share of a course from 0 to 1: its steps are even in time. */
function along(values, share) {
  const at = share * (values.length - 1);
  const [low, high] = [Math.floor(at), Math.min(values.length - 1, Math.floor(at) + 1)];
  const mean = (one, other) => one + (at - low) * (other - one);
  return Array.isArray(values[low]) ? values[low].map((one, i) => mean(one, values[high][i])) : mean(values[low], values[high]);
}

export function createLinkage(root) {
  const plain = html("div", { class: "fill" });
  const turning = html("div", { class: "fill cam-drawing" });
  const cam = createMechanism(turning);
  let shown = null;
  let shareNow = 0;
  let placeOf = null;
  const moving = svg("g");
  root.append(plain, turning);
  const size = sized(root, draw);

  /** What is drawn, or null. */
  function show(drawing) {
    shown = drawing;
    plain.hidden = drawing?.kind === "cam";
    turning.hidden = drawing?.kind !== "cam";
    if (drawing?.kind === "cam") cam.show(drawing);
    draw();
  }

  /** Show a share of the cycle, from 0 to 1. */
  function moveTo(share) {
    shareNow = share;
    if (!shown) return;
    if (shown.kind === "cam") cam.turn(((valueNow("input") % 360) + 360) % 360);
    else parts();
  }

  const valueNow = (name) => along(shown[name], shareNow);

  function draw() {
    const [width, height] = size();
    if (!shown) return plain.replaceChildren();
    if (shown.kind === "cam" || width < 100 || height < 80) return moveTo(shareNow);
    const { kind, paths = [] } = shown;
    placeOf = fitted(width, height, ends(), ROOM);
    const traced = paths.map((line) => svg("path", { class: "joint-path", d: path(line.map(placeOf)) }));
    const bar = kind === "table" || kind === "screw" ? [] : scaleBar(placeOf.factor, width, height);
    const drawing = svg("svg", { width, height, class: "linkage", role: "img", "aria-label": told() }, ...traced, moving, ...bar);
    plain.replaceChildren(drawing);
    return parts();
  }

  function told() {
    const { name, ends, axis, kind } = shown;
    const scale = kind === "table" || kind === "screw" ? "as a sketch" : "to scale";
    const unit = axis === "angle" ? "deg" : "mm";
    return `The ${name}, drawn ${scale}; its input goes from ${number(ends[0], unit)} to ${written({ value: ends[1], unit, digits: 6 })}`;
  }

  /** The least and greatest x and y of all that moves, in mm; the size of a table is of no meaning. */
  function ends() {
    const { kind, chains = [], paths = [], size = 1, slide } = shown;
    if (kind === "table") return [[-1.1, 1.1], [-1.1, 1.1]];
    if (kind === "links") {
      const all = [...paths.flat(), ...chains.flat(2)];
      const of = (i) => [Math.min(...all.map((one) => one[i])), Math.max(...all.map((one) => one[i]))];
      return [of(0), of(1)];
    }
    const radius = kind === "screw" ? Math.max(...slide.map(Math.abs), size) / 12 : size;
    return [[Math.min(...slide, 0) - 2 * radius, Math.max(...slide, 0) + 2 * radius], [-1.8 * radius, 2 * radius]];
  }

  function scaleBar(factor, width, height) {
    const length = ticks(0, SCALE / factor, 2).at(-1);
    const [x, y] = [width - 14, height - 12];
    return [svg("path", { class: "scale-bar", d: `M${x - factor * length} ${y - 4}v4H${x}v-4` }), svg("text", { x: x - factor * length - 6, y: y + 1, "text-anchor": "end", text: written({ value: length, unit: "mm", digits: 4 }) })];
  }

  function parts() {
    if (!placeOf) return;
    const { kind } = shown;
    moving.replaceChildren(...(kind === "links" ? links() : kind === "table" ? table() : slide(kind)));
  }

  function links() {
    const { chains, fixed } = shown;
    const now = (joint) => placeOf(along(joint, shareNow));
    const [below, links, above] = [[], [], []];
    chains.forEach((chain, i) => {
      const places = chain.map(now);
      const [x, y] = places[0];
      if (fixed[i]) below.push(svg("path", { class: "ground", d: `M${x} ${y}l-9 13h18ZM${x - 13} ${y + 13}h26` }), svg("circle", { class: "shaft", cx: x, cy: y, r: 4 }));
      else if (chain.length === 1) above.push(svg("rect", { class: "slider", x: x - 9, y: y - 7, width: 18, height: 14, rx: 2 }), svg("circle", { class: "shaft", cx: x, cy: y, r: 3 }));
      else links.push(svg("path", { class: "link", d: path(places) }), ...places.map(([cx, cy]) => svg("circle", { class: "shaft", cx, cy, r: 3.2 })));
    });
    return [...links, ...below, ...above];
  }

  function table() {
    const [x, y] = placeOf([0, 0]);
    const radius = placeOf.factor;
    const angle = shown.axis === "angle" ? (valueNow("input") * Math.PI) / 180 : 0;
    const spoke = (turn, inner) => [inner, 0.98].flatMap((share) => [x + share * radius * Math.cos(angle + turn), y - share * radius * Math.sin(angle + turn)]);
    const line = (name, [x1, y1, x2, y2]) => svg("line", { class: name, x1, y1, x2, y2 });
    const notches = [1, 2, 3, 4, 5, 6, 7].map((i) => line("key", spoke((i * Math.PI) / 4, 0.82)));
    return [svg("circle", { class: "drum", cx: x, cy: y, r: radius }), ...notches, line("arm", spoke(0, 0.5)), svg("circle", { class: "shaft", cx: x, cy: y, r: 0.12 * radius })];
  }

  /** A pinion with its rack, a pulley with its belt, a screw with its nut. */
  function slide(kind) {
    const { size, slide } = shown;
    const radius = kind === "screw" ? Math.max(...slide.map(Math.abs), size) / 12 : size;
    const [low, high] = [Math.min(...slide, 0) - radius, Math.max(...slide, 0) + radius];
    const way = valueNow("slide");
    const turned = -(valueNow("input") * Math.PI) / 180;
    const line = (name, one, other) => {
      const [[x1, y1], [x2, y2]] = [placeOf(one), placeOf(other)];
      return svg("line", { class: name, x1, y1, x2, y2 });
    };
    const wheel = ([cx, cy]) => {
      const [x, y] = placeOf([cx, cy]);
      const edge = [cx + radius * Math.cos(turned), cy + radius * Math.sin(turned)];
      return [svg("circle", { class: "drum", cx: x, cy: y, r: placeOf.factor * radius }), line("key", [cx, cy], edge), svg("circle", { class: "shaft", cx: x, cy: y, r: 4 })];
    };
    const block = (x, y) => {
      const [left, top] = placeOf([x, y]);
      const side = Math.max(14, placeOf.factor * radius * 0.8);
      return svg("rect", { class: "slider", x: left - side / 2, y: top - side / 2, width: side, height: side, rx: 2 });
    };
    if (kind === "rack") return [...wheel([0, 0]), line("link", [low + way, radius], [high + way, radius]), block(way, 1.4 * radius)];
    if (kind === "belt") return [line("belt", [low, radius], [high, radius]), line("belt", [low, -radius], [high, -radius]), ...wheel([low, 0]), ...wheel([high, 0]), block(way, 1.4 * radius)];
    const pitch = (high - low) / 40;
    const phase = (((way % pitch) + pitch) % pitch) - pitch;
    const threads = [...Array(42).keys()].map((i) => low + phase + i * pitch).filter((x) => x > low && x + 0.6 * pitch < high).map((x) => line("key", [x, -0.5 * radius], [x + 0.6 * pitch, 0.5 * radius]));
    return [line("link", [low, 0.5 * radius], [high, 0.5 * radius]), line("link", [low, -0.5 * radius], [high, -0.5 * radius]), ...threads, block(way, 0)];
  }

  return { show, at: moveTo };
}
