// The views of the page: the name of each in a study, its title, the part of the study that it shows, and its module. Five
// views are tabs of one machine.
//
// A module exports `createView(root, study, start)`, which fills its element and returns what follows: `show(state)` draws a state; `files` lists what
// can be saved by its kind, or as {kind, text, about}; `drawings` selects the pictures that are saved as one; `request(state)` is what the
// view asks of the server, of which files are made; `moves` is whether that is a motion for a controller; `form` is what a
// tab of the machine asks beside the machine; `dropped(file)` says whether the view takes a file that is dropped while it is
// shown; other files are opened. `start` is what the server tells of catalogues and formats.

export const object = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
export const same = (one, other) => JSON.stringify(one) === JSON.stringify(other);
const motion = (value) => object(value) && Array.isArray(value.segment) && value.segment.every(object);
const tables = (value) => Array.isArray(value) && value.length > 0 && value.every(object);

/** The parts of a study besides its laws: what each needs, and whether a value has it. */
export const PARTS = {
  machine: {
    needs: "axes, each with its segments, and interlocks that are tables",
    whole: (value) => object(value) && tables(value.axis) && value.axis.every(motion) && (value.interlocks === undefined || (Array.isArray(value.interlocks) && value.interlocks.every(object))),
  },
  fastest: { needs: "moves", whole: (value) => object(value) && tables(value.move) },
  cam: { needs: "a follower and a motion with its segments", whole: (value) => object(value) && object(value.follower) && motion(value.motion) },
  old: { needs: "the text of a table", whole: (value) => object(value) && typeof value.text === "string" },
  advice: { needs: "a table of what is asked", whole: object },
};

export const VIEWS = {
  laws: { title: "Laws", load: () => import("./views/laws.js") },
  cycle: { title: "Motion", part: "machine", load: () => import("./views/cycle.js") },
  machine: { title: "Mechanism and torque", part: "machine", load: () => import("./views/machine.js") },
  axes: { title: "Timing", part: "machine", load: () => import("./views/axes.js") },
  fastest: { title: "Least time", part: "machine", load: () => import("./views/fastest.js") },
  advice: { title: "Advice", part: "machine", load: () => import("./views/advice.js") },
  old: { title: "Old table", part: "old", load: () => import("./views/old.js") },
  cam: { title: "Cam", part: "cam", load: () => import("./views/cam.js") },
  proof: { title: "Proof", load: () => import("./views/proof.js") },
};
