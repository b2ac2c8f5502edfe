// What the state asks of a law, read and changed entry by entry; ranges are kept as [low, high].

export const CONSTANTS = ["C", "D", "J", "rms_c"];

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

/** What is minimised alone becomes a weight; a formula stays one. */
export function minimise(law, weights) {
  law.weights = weights;
  delete law.problem.minimise;
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
