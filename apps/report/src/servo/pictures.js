// The images of a run with the edges as they were and as they should be.
import { append, html, muted, svg } from "../shared/dom.js";
import { capitalized, isNumber, plural, significant } from "../shared/format.js";
import { onPictureKey, zoomablePicture } from "../shared/zoomable_picture.js";

export const hasPictures = ({ pictures }) => pictures?.length > 0;

export function renderPictures(section, { data }) {
  append(section, new Viewer(data.pictures).element);
}

class Viewer {
  constructor(pictures) {
    this.pictures = pictures;
    this.stage = html("div", { class: "stage" });
    this.caption = html("p", { class: "picture-caption", "aria-live": "polite" });
    this.buttons = pictures.map((picture, index) =>
      html(
        "button",
        { type: "button", "data-picture": index, onclick: () => this.show(index) },
        nameOf(picture, index),
      ),
    );
    this.element = html(
      "div",
      { class: "servo-viewer", onkeydown: (event) => onPictureKey(event, this.zoom, (by) => this.step(by)) },
      html(
        "div",
        { class: "toolbar" },
        html("div", { class: "buttons", role: "group", "aria-label": "Pictures" }, this.buttons),
      ),
      this.toolbar(),
      this.caption,
      this.stage,
      legend(),
    );
    this.show(0);
  }

  toolbar() {
    const button = (label, title, action) =>
      html("button", { type: "button", title, "aria-label": title, onclick: action }, label);
    const toggle = (name, label) => {
      const box = html("input", {
        type: "checkbox",
        name,
        checked: true,
        onchange: () => this.stage.classList.toggle(`hide-${name}`, !box.checked),
      });
      return html("label", null, box, label);
    };
    return html(
      "div",
      { class: "toolbar" },
      button("+", "Zoom in (+)", () => this.zoom.zoomIn()),
      button("−", "Zoom out (-)", () => this.zoom.zoomOut()),
      button("Fit", "Whole picture (0)", () => this.zoom.reset()),
      toggle("current", "Current edges"),
      toggle("desired", "Desired edges"),
      this.pictures.some(({ image }) => image) && toggle("image", "Image"),
    );
  }

  show(index) {
    const picture = this.pictures[index];
    this.buttons.forEach((button, each) => button.setAttribute("aria-pressed", String(each === index)));
    this.index = index;
    const shown = zoomablePicture(picture.image, sizeOf(picture), describe(picture, index), this.stage);
    this.zoom = shown.zoom;
    shown.over.append(...overlay(picture));
    this.caption.replaceChildren(...captionOf(picture, index));
  }

  step(by) {
    this.show(Math.max(0, Math.min(this.pictures.length - 1, this.index + by)));
    this.stage.firstElementChild.focus({ preventScroll: true });
  }
}

const nameOf = ({ label }, index) => capitalized(label ?? `picture ${index + 1}`);

function captionOf(picture, index) {
  const seen = picture.current?.length ?? 0;
  const when = isNumber(picture.time_s) ? `, at ${significant(picture.time_s)} s` : "";
  const wanted = picture.desired?.length ?? 0;
  return [
    html("strong", null, nameOf(picture, index)),
    `${when}: ${plural(seen, "current edge")}, ${plural(wanted, "desired edge")}.`,
  ];
}

const describe = (picture, index) =>
  captionOf(picture, index)
    .map((part) => part.textContent ?? part)
    .join("");

// The extent of the edges where the size of the image is not known.
function sizeOf({ width_px: width, height_px: height, current, desired }) {
  if (width > 0 && height > 0) return { width, height };
  const points = [...(current ?? []), ...(desired ?? [])].flatMap(({ points: each }) => each ?? []);
  return {
    width: Math.max(640, ...points.map(([x]) => x + 1)),
    height: Math.max(480, ...points.map(([, y]) => y + 1)),
  };
}

function overlay({ current, desired }) {
  return [
    ...outlines(desired, "desired", (leg, edge) => `Leg ${leg}, edge ${edge}: where it should be`),
    ...outlines(current, "current", (leg, edge) => `Leg ${leg}, edge ${edge}: as it was seen`),
    ...legNumbers(current?.length ? current : (desired ?? [])),
  ];
}

const outlines = (edges, name, title) =>
  (edges ?? [])
    .filter(({ points }) => points?.length)
    .map(({ leg, edge, points }) =>
      svg(
        "polyline",
        { class: `edge ${name}`, points: points.map(([x, y]) => `${x},${y}`).join(" ") },
        svg("title", null, title(leg, edge)),
      ),
    );

// The number of each leg, in the middle of its edges.
function legNumbers(edges) {
  const legs = [...new Set(edges.map(({ leg }) => leg))];
  return legs.map((leg) => {
    const points = edges.filter((edge) => edge.leg === leg).flatMap((edge) => edge.points ?? []);
    const mean = (axis) => points.reduce((sum, point) => sum + point[axis], 0) / Math.max(1, points.length);
    return svg("text", { class: "leg-number", x: mean(0), y: mean(1) }, String(leg));
  });
}

const legend = () =>
  html(
    "div",
    { class: "legend" },
    html(
      "p",
      { class: "key" },
      html("span", null, html("span", { class: "edge-swatch current" }), "current edges, as they were seen"),
      html(
        "span",
        null,
        html("span", { class: "edge-swatch desired" }),
        "desired edges, where they should be",
      ),
    ),
    muted(
      "Click the picture, then: wheel or + and − to zoom, drag to move, double click or 0 for the whole picture, left " +
        "and right arrow for the other pictures.",
    ),
  );
