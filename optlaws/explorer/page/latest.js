// Questions to the server: one in flight a path, and of those that wait the last one wins. One that takes long can be
// stopped or given more time; while the server is away the last one is asked again.

const DIM = 400; // ms after which what is shown is dimmed: it is not of now
const SLOW = 1000; // ms after which a question can be stopped
const RESTED = 400; // ms without a newer question after which a slow one gives way to the last
const AGAIN = 1500; // ms between attempts while the server does not answer
const PATIENCE = 120; // s that a question has where the reader lets it go on

const all = new Set();
let observer = () => {};
let dimming = null;

/** `told({lost, slow, late})` is called when the server is lost or back, when questions become slow, when one is late. */
export function observe(told) {
  observer = told;
}

function changed() {
  const questions = [...all];
  const busy = questions.some((one) => one.busy);
  document.body.dataset.work = busy ? "busy" : "settled";
  // a transition with a delay would make layers for each answer, also for those that come before it
  if (busy) dimming ??= setTimeout(() => document.body.classList.add("late"), DIM);
  else undimmed();
  const those = (name) => questions.filter((one) => one[name]);
  observer({ lost: those("lost").length > 0, slow: those("slow"), late: those("late") });
}

function undimmed() {
  clearTimeout(dimming);
  dimming = null;
  document.body.classList.remove("late");
}

/** What is no question, such as a module on its way, is work too. */
export async function during(promise) {
  const work = { busy: true };
  all.add(work);
  changed();
  try {
    return await promise;
  } finally {
    all.delete(work);
    changed();
  }
}

/** Whether the server answers: an error where it does not. */
export const present = () => fetch("icon.svg", { cache: "no-store" });

/** What `load` gives; where it fails while the server is away it is tried again as soon as the server answers. */
export async function reached(load) {
  const away = { busy: true, lost: false };
  all.add(away);
  try {
    return await load();
  } catch {
    while (!(await present().then(() => true, () => false))) {
      if (!away.lost) {
        away.lost = true;
        changed();
      }
      await new Promise((resolve) => setTimeout(resolve, AGAIN));
    }
    return await load();
  } finally {
    all.delete(away);
    changed();
  }
}

class Lost extends Error {}

/** What the server answers to a question; an error says why it does not. */
export async function post(path, question, signal) {
  const response = await fetch(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(question), signal }).catch((error) => {
    throw error.name === "AbortError" ? error : new Lost(error.message);
  });
  const answer = await response.json();
  if (answer.error) throw Object.assign(new Error(answer.error), { late: answer.late });
  return answer;
}

/** The view of what has no answer: what was shown before is of another question. */
export const unanswered = ({ message }) => ({ refused: { word: "no answer", reason: message, tried: "" } });

export class Latest {
  #path;
  #answered;
  #failed;
  #flight = null;
  #waiting = null;
  #late = null;
  #resting = null;
  lost = false;
  slow = false;
  since = 0; // when the question in flight was asked

  /** `answered(answer, question)` and `failed(error, question)`, unless the first one is given a refusal. */
  constructor(path, answered, failed = (error, question) => answered(unanswered(error), question)) {
    this.#path = path;
    this.#answered = answered;
    this.#failed = failed;
    all.add(this);
  }

  get path() {
    return this.#path;
  }

  /** Whether an answer under way is older than the last question. */
  get behind() {
    return this.#waiting !== null;
  }

  get busy() {
    return this.#flight !== null || this.#waiting !== null;
  }

  get late() {
    return this.#late !== null;
  }

  ask(question, patience = null) {
    this.#late = null;
    this.#waiting = { question, patience };
    this.#rest();
    if (this.#flight === null) this.#next();
  }

  /** Amid a drag a slow question is answered, so that laws are seen; once the drag rests it gives way to the last one. */
  #rest() {
    clearTimeout(this.#resting);
    this.#resting = setTimeout(() => {
      this.#resting = null;
      this.#giveWay();
    }, RESTED);
  }

  #giveWay() {
    if (this.slow && this.#waiting !== null && this.#resting === null) this.#flight.abort();
  }

  /** Nobody waits for the answer any more. */
  stop() {
    this.#waiting = null;
    this.#flight?.abort();
  }

  /** Ask the question that was late once more, with more time. */
  goOn() {
    if (this.#late !== null) this.ask(this.#late, PATIENCE);
  }

  async #next() {
    while (this.#waiting !== null) {
      const { question, patience } = this.#waiting;
      this.#waiting = this.#late = null;
      this.#flight = new AbortController();
      this.since = performance.now();
      changed();
      const timer = setTimeout(() => {
        this.#state({ slow: true });
        this.#giveWay();
      }, SLOW);
      try {
        const answer = await post(patience ? `${this.#path}?patience=${patience}` : this.#path, question, this.#flight.signal);
        this.#state({ lost: false, slow: false });
        this.#answered(answer, question);
        // answers that keep up with a drag are as good as of now
        undimmed();
      } catch (error) {
        if (error instanceof Lost) await this.#again(question, patience);
        else this.#fail(error, question);
      } finally {
        clearTimeout(timer);
        this.slow = false;
        this.#flight = null;
      }
    }
    changed();
  }

  #fail(error, question) {
    this.lost = false;
    if (error.late) this.#late = question;
    if (error.name !== "AbortError") return this.#failed(error, question);
    if (this.#waiting === null) this.#failed(new Error("stopped"), question);
  }

  async #again(question, patience) {
    this.#state({ lost: true, slow: false });
    await new Promise((resolve) => setTimeout(resolve, AGAIN));
    this.#waiting ??= { question, patience };
  }

  #state({ lost = this.lost, slow = this.slow }) {
    const same = lost === this.lost && slow === this.slow;
    Object.assign(this, { lost, slow });
    if (!same) changed();
  }
}
