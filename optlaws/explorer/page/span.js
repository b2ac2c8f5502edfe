// The part of a range that is in sight: zoomed about a place, moved, whole again.

const FINEST = 1e-4; // of the range

export class Span {
  whole = [0, 1];
  shown = [0, 1];

  get zoomed() {
    return this.shown[0] > this.whole[0] || this.shown[1] < this.whole[1];
  }

  /** Another range is shown whole; the same one as it was. */
  of(range) {
    if (range[0] === this.whole[0] && range[1] === this.whole[1]) return;
    this.whole = [...range];
    this.reset();
  }

  reset() {
    this.shown = [...this.whole];
  }

  /** Show so many times as much, with a place where it is. */
  zoom(about, times) {
    const [from, to] = this.shown;
    const factor = Math.max(times, (FINEST * (this.whole[1] - this.whole[0])) / (to - from));
    this.to(about + factor * (from - about), about + factor * (to - about));
  }

  move(by) {
    this.to(this.shown[0] + by, this.shown[1] + by);
  }

  /** Bring a place into sight. */
  reach(at) {
    const [from, to] = this.shown;
    if (at < from || at > to) this.move(at - (from + to) / 2);
  }

  to(from, to) {
    const [low, high] = this.whole;
    const size = Math.min(to - from, high - low);
    const start = Math.min(Math.max(from, low), high - size);
    this.shown = [start, start + size];
  }
}
