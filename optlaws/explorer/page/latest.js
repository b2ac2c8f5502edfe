// Questions to the server: one in flight a path, and of those that wait the last one wins.

let working = 0;

function work(change) {
  working += change;
  document.body.dataset.work = working ? "busy" : "settled";
}

async function ask(path, question) {
  const response = await fetch(path, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(question),
  });
  const answer = await response.json();
  if (answer.error) throw new Error(answer.error);
  return answer;
}

export class Latest {
  #path;
  #answered;
  #failed;
  #busy = false;
  #waiting = null;

  constructor(path, answered, failed) {
    this.#path = path;
    this.#answered = answered;
    this.#failed = failed;
  }

  /** Whether an answer under way is older than the last question. */
  get behind() {
    return this.#waiting !== null;
  }

  ask(question) {
    if (!this.#busy && this.#waiting === null) work(1);
    this.#waiting = { question };
    if (!this.#busy) this.#next();
  }

  async #next() {
    const { question } = this.#waiting;
    this.#waiting = null;
    this.#busy = true;
    try {
      this.#answered(await ask(this.#path, question), question);
    } catch (error) {
      this.#failed(error, question);
    } finally {
      this.#busy = false;
      if (this.#waiting) this.#next();
      else work(-1);
    }
  }
}
