// The views of the page: the name of each in a study, its title, whether a part of a study is one of its own and what that
// needs, and its module.
//
// A module exports `View`: `new View(root, study, start)` fills its element; `show(state)` draws a state; `files(state)`
// lists what can be saved as {kind, text, about}; `drawings` selects the pictures that are saved as one; `request(state)` is
// what the view asks of the server, of which files are made; `moves` is whether that is a motion for a controller;
// `dropped(file)` says whether the view takes a file that is dropped while it is shown; other files are opened.
// `focus` selects where "Skip to the picture" leads. `start` is what the server tells of catalogues and formats.

export const object = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
export const motion = (value) => object(value) && Array.isArray(value.segment) && value.segment.every(object);
const AXES = "axes, each with its segments";

export const VIEWS = {
  laws: { title: "Laws", load: () => import("./views/laws.js") },
  cycle: {
    title: "Cycle",
    needs: AXES,
    whole: (value) => object(value) && Array.isArray(value.axis) && value.axis.length > 0 && value.axis.every(motion),
    load: () => import("./views/cycle.js"),
  },
  axes: {
    title: "Axes",
    needs: `${AXES}, and interlocks that are tables`,
    whole: (value) => VIEWS.cycle.whole(value) && (value.interlocks === undefined || (Array.isArray(value.interlocks) && value.interlocks.every(object))),
    load: () => import("./views/axes.js"),
  },
  cam: {
    title: "Cam",
    needs: "a follower and a motion with its segments",
    whole: (value) => object(value) && object(value.follower) && motion(value.motion),
    load: () => import("./views/cam.js"),
  },
  machine: {
    title: "Machine",
    needs: AXES,
    whole: (value) => object(value) && Array.isArray(value.axis) && value.axis.length > 0 && value.axis.every(motion),
    load: () => import("./views/machine.js"),
  },
  fastest: {
    title: "Fastest",
    needs: `moves, or ${AXES}`,
    whole: (value) => object(value) && ((Array.isArray(value.move) && value.move.length > 0 && value.move.every(object)) || (Array.isArray(value.axis) && value.axis.length > 0 && value.axis.every(motion))),
    load: () => import("./views/fastest.js"),
  },
  old: { title: "Old cam", needs: "the text of a table", whole: (value) => object(value) && typeof value.text === "string", load: () => import("./views/old.js") },
  proof: { title: "Proof", load: () => import("./views/proof.js") },
  advice: { title: "Advice", needs: "a table of what is asked", whole: object, load: () => import("./views/advice.js") },
};
