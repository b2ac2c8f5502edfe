// Files that the reader saves: the browser downloads them, the server writes none.

const LAWS = [
  { kind: "python", text: "Python", about: "Lines that reproduce what is seen" },
  { kind: "problem", text: "Problem file (TOML)", about: "For optlaws run" },
  { kind: "law", text: "Law (JSON)", about: "For optlaws law, compare and cycle; a solution with its proof for optlaws verify" },
  { kind: "table", text: "Table of values (CSV)", about: "k, a, b, c, j and d" },
];
const CYCLE = [
  { kind: "python", text: "Python", about: "Lines that reproduce what is seen" },
  { kind: "problem", text: "Problem file (TOML)", about: "For optlaws cycle" },
  { kind: "table", text: "Table of values (CSV)", about: "Angle, time, position, velocity, acceleration and jerk" },
];
const CUT = ["dxf spline", "dxf polyline", "dxf arcs", "svg", "csv", "csv polar", "g-code", "g-code arcs"];
const CAM = [
  { kind: "problem", text: "Problem file (TOML)", about: "For optlaws cam" },
  ...CUT.map((format) => ({ kind: "cut", format, text: `Profile (${format})`, about: "The cam's edge, within 1 µm" })),
];
const VIEWS = { laws: LAWS, cycle: CYCLE, cam: CAM };
const DRAWINGS = { laws: "#curves svg", cycle: "#motion svg", cam: "#cam-curves svg" };
const PICTURE = { kind: "picture", text: "Picture (SVG)", about: "The curves as they are seen" };
const DRAWN = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "font-family", "font-size", "font-weight"];

export function savings(state) {
  return [...(VIEWS[state.view] ?? LAWS), PICTURE];
}

export async function save(kind, state, format) {
  if (kind === "picture") return download("optlaws.svg", "image/svg+xml", picture(state));
  const { view, laws, active } = state;
  const cycle = state.cycle ? { study: state.cycle, axis: state.axis } : null;
  const cam = state.cam ? { study: state.cam } : null;
  const response = await fetch("api/save", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ kind, view, laws, active, cycle, cam, ...(format && { format }) }),
  });
  const answer = await response.json();
  if (answer.error) throw new Error(answer.error);
  return download(answer.name, answer.type, answer.text);
}

export function download(name, type, text) {
  const address = URL.createObjectURL(new Blob([text], { type }));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** The drawings of the view, one below the other, with what the style sheet says of them written into them. */
function picture(state) {
  const drawings = [...document.querySelectorAll(DRAWINGS[state.view] ?? DRAWINGS.laws)];
  const whole = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  let height = 0;
  for (const drawing of drawings) {
    const copy = drawing.cloneNode(true);
    const [from, to] = [drawing.querySelectorAll("*"), copy.querySelectorAll("*")];
    from.forEach((one, i) => written(one, to[i]));
    copy.setAttribute("y", height);
    height += Number(drawing.getAttribute("height"));
    whole.append(copy);
  }
  const width = Math.max(0, ...drawings.map((drawing) => Number(drawing.getAttribute("width"))));
  whole.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  whole.setAttribute("viewBox", `0 0 ${width} ${height}`);
  whole.setAttribute("width", width);
  whole.setAttribute("height", height);
  const ground = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  ground.setAttribute("width", "100%");
  ground.setAttribute("height", "100%");
  ground.setAttribute("fill", getComputedStyle(document.querySelector(".panel")).backgroundColor);
  whole.prepend(ground);
  return new XMLSerializer().serializeToString(whole);
}

function written(drawn, copy) {
  const style = getComputedStyle(drawn);
  for (const name of DRAWN) copy.setAttribute(name, style.getPropertyValue(name));
  copy.removeAttribute("class");
}
