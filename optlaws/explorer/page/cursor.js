// A place along the variable of pictures that are read together: it follows the pointer, and stays where it was put.

export class Cursor {
  #watchers = [];
  #placed = null;
  #pointed = null;

  get at() {
    return this.#pointed ?? this.#placed;
  }

  /** `seen(at, placed)` is called whenever the cursor moves; `at` is null where there is none. */
  watch(seen) {
    this.#watchers.push(seen);
  }

  /** Put it somewhere: there it stays. */
  place(at) {
    this.#placed = at;
    this.#pointed = null;
    this.#tell(true);
  }

  /** Follow the pointer; null where the pointer has left. */
  point(at) {
    this.#pointed = at;
    this.#tell(false);
  }

  #tell(placed) {
    for (const seen of this.#watchers) seen(this.at, placed);
  }
}
