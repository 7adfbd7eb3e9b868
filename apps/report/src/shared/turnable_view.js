// A picture that can be turned and zoomed. What it shows is drawn anew as SVG for each view: no WebGL, prints sharply.
import { html, svg } from "./dom.js";
import { START, turned, zoomed } from "./turntable.js";

const RADIANS_PER_PIXEL = 0.008;
const KEY_STEP = 0.12;
const CLICK_ZOOM = 1.3;
const HEIGHT = { least: 310, most: 540 };

export class TurnableView {
  // draw(view, size) -> SVG elements; share: height over width, as far as that is neither flat nor tall; first: the view
  // to begin with.
  constructor(description, draw, share = 0.72, first = START) {
    this.first = first;
    this.share = share;
    this.draw = draw;
    this.view = first;
    this.size = null;
    this.picture = svg("svg", { class: "turnable", tabindex: 0, role: "img", "aria-label": description });
    this.element = html("div", { class: "turnable-place" }, this.picture);
    this.listen();
    const fit = ([entry]) => requestAnimationFrame(() => this.fit(Math.floor(entry.contentRect.width)));
    new ResizeObserver(fit).observe(this.element);
  }

  buttons() {
    const button = (label, title, action) =>
      html("button", { type: "button", title, "aria-label": title, onclick: action }, label);
    return [
      button("+", "Closer (+)", () => this.look(zoomed(this.view, CLICK_ZOOM))),
      button("−", "Farther (-)", () => this.look(zoomed(this.view, 1 / CLICK_ZOOM))),
      button("Reset view", "As at first (0)", () => this.look(this.first)),
    ];
  }

  hint() {
    return html(
      "p",
      { class: "muted hint" },
      "Drag to turn. Click the picture, then: wheel or + and − to zoom, arrow keys to turn, double click or 0 for the " +
        "first view.",
    );
  }

  fit(width) {
    if (width < 1) return;
    const height = Math.max(HEIGHT.least, Math.min(HEIGHT.most, Math.round(this.share * width)));
    this.size = { width, height };
    this.picture.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.redraw();
  }

  look(view) {
    this.view = view;
    this.redraw();
  }

  // At most once a frame, however many events there were.
  redraw() {
    if (!this.size || this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.picture.replaceChildren(...this.draw(this.view, this.size));
    });
  }

  listen() {
    const { picture } = this;
    picture.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      picture.focus({ preventScroll: true });
      picture.setPointerCapture(event.pointerId);
    });
    picture.addEventListener("pointermove", (event) => {
      if (!picture.hasPointerCapture(event.pointerId)) return;
      const { movementX: x, movementY: y } = event;
      this.look(turned(this.view, -RADIANS_PER_PIXEL * x, RADIANS_PER_PIXEL * y));
    });
    // The wheel belongs to the page until the picture has been clicked or Ctrl is held.
    picture.addEventListener(
      "wheel",
      (event) => {
        if (!event.ctrlKey && document.activeElement !== picture) return;
        event.preventDefault();
        this.look(zoomed(this.view, Math.exp(-event.deltaY / 500)));
      },
      { passive: false },
    );
    picture.addEventListener("dblclick", () => this.look(this.first));
    picture.addEventListener("keydown", (event) => this.onKey(event));
  }

  onKey(event) {
    const views = {
      ArrowLeft: () => turned(this.view, KEY_STEP, 0),
      ArrowRight: () => turned(this.view, -KEY_STEP, 0),
      ArrowUp: () => turned(this.view, 0, KEY_STEP),
      ArrowDown: () => turned(this.view, 0, -KEY_STEP),
      "+": () => zoomed(this.view, CLICK_ZOOM),
      "-": () => zoomed(this.view, 1 / CLICK_ZOOM),
      0: () => this.first,
    };
    if (!views[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    this.look(views[event.key]());
  }
}
