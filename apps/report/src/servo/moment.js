// The moment of the run that the user looks at: a mark in every plot over time, and whoever else wants to know.
import { svg } from "../shared/dom.js";

export class Moment {
  constructor(times) {
    this.times = times;
    this.index = 0;
    this.marks = new Set();
    this.listeners = [];
  }

  get time() {
    return this.times[this.index];
  }

  onChange(listener) {
    this.listeners.push(listener);
  }

  choose(index) {
    this.index = Math.max(0, Math.min(this.times.length - 1, index));
    for (const mark of this.marks) this.place(mark);
    for (const listener of this.listeners) listener(this.index);
  }

  // The cycle nearest to a time.
  chooseTime(time) {
    let best = 0;
    this.times.forEach((each, index) => {
      if (Math.abs(each - time) < Math.abs(this.times[best] - time)) best = index;
    });
    this.choose(best);
  }

  // Puts the mark into a plot over time; a click there chooses the moment.
  markIn(drawing) {
    const scale = drawing.scale("x");
    const [top, bottom] = drawing.scale("y")?.range ?? [0, 0];
    const line = svg("line", { class: "moment", y1: top, y2: bottom });
    drawing.append(line);
    const mark = { drawing, line, scale };
    for (const old of this.marks) if (!old.drawing.isConnected) this.marks.delete(old);
    this.marks.add(mark);
    this.place(mark);
    drawing.addEventListener("click", (event) => {
      const box = drawing.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * drawing.viewBox.baseVal.width;
      this.chooseTime(scale.invert(x));
    });
  }

  place({ line, scale }) {
    const x = scale.apply(this.time);
    line.setAttribute("x1", x);
    line.setAttribute("x2", x);
  }
}
