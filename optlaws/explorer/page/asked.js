// What the state asks of a law, read and changed entry by entry; ranges are kept as [low, high].

const upper = (value) => (Array.isArray(value) ? value[1] : value) ?? null;

export function bound(law, name) {
  if (!law.problem) return null;
  return upper(name === "rms_c" ? law.problem.bounds?.rms_c : law.problem[name]);
}

export function setBound(law, name, value) {
  const home = name === "rms_c" ? (law.problem.bounds ??= {}) : law.problem;
  if (value === null) delete home[name];
  else home[name] = [Array.isArray(home[name]) ? Math.min(home[name][0] ?? 0, value) : 0, value];
  if (law.problem.bounds && !Object.keys(law.problem.bounds).length) delete law.problem.bounds;
}

export function velocity(law) {
  const value = law.problem?.B;
  return typeof value === "number" ? value : null;
}

export function setVelocity(law, value) {
  if (value === null) delete law.problem.B;
  else law.problem.B = value;
}

/** The least value of each constant over all laws from rest to rest, by which its weight in an objective is divided. */
const LEAST = { C: 4, D: 2.25, J: 32, rms_c: Number(Math.sqrt(12).toPrecision(12)) };

/** The weights of an objective that is a constant, or a sum of such; null of another formula. */
export function weights({ problem }) {
  const terms = (problem.minimise ?? "C").split(" + ").map((text) => /^(?:([-\de.]+)\*)?(\w+)(?:\/([\d.]+))?$/.exec(text.trim()));
  const own = terms.every((term) => term && Object.hasOwn(LEAST, term[2]) && (terms.length === 1 ? term[0] === term[2] : Number(term[3]) === LEAST[term[2]]));
  return own ? Object.fromEntries(terms.map(([, weight = 1, name]) => [name, Number(weight)])) : null;
}

/** Make the sum of weighted constants the objective; a constant alone is that whatever its weight. */
export function minimise(law, weights) {
  const heavy = Object.entries(weights).filter(([, weight]) => weight > 0);
  const sum = heavy.map(([name, weight]) => `${weight}*${name}/${LEAST[name]}`).join(" + ");
  if (heavy.length) law.problem.minimise = heavy.length === 1 ? heavy[0][0] : sum;
}

/** Move a law to a value of the constant that a front sweeps. */
export function move(law, x, y, value) {
  if (x === "B") return setVelocity(law, value);
  setBound(law, x, value);
  return minimise(law, { [y]: 1 });
}

/** The value of the swept constant that a law is asked to have. */
export function askedOf(law, x) {
  return x === "B" ? velocity(law) : bound(law, x);
}
