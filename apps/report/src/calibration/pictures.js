// The picture viewer: choose an image, see found points and predicted outlines over it, zoom and pan.
import { append, html, muted } from "../shared/dom.js";
import { significant, withUnit } from "../shared/format.js";
import { onPictureKey, zoomablePicture } from "../shared/zoomable_picture.js";
import { edgesOf, imagesOf, isOutlier, magnitudeQuantile, usedEdges, usedSamples } from "./observations.js";
import { overlay, residualColor } from "./overlay.js";
import { pictureAddress } from "./picture_links.js";
import { altText, captionOf, edgeTable } from "./picture_text.js";

const DEFAULT_FACTOR = 200;
const LARGEST_FACTOR = 1000;

export function showPicture(name) {
  window.location.hash = pictureAddress(name);
}

export function renderPictures(section, data) {
  const images = imagesOf(data);
  if (images.length === 0) return append(section, muted("No images."));
  const viewer = new Viewer(images, colorLimit(data));
  append(section, viewer.element);
  window.addEventListener("hashchange", () => viewer.follow(section));
  viewer.show(0);
  viewer.follow(section);
}

// The residual (px) of full colour: nineteen in twenty points stay below.
function colorLimit(data) {
  const residuals = usedSamples(usedEdges(data))
    .filter((sample) => !isOutlier(sample))
    .map(({ residual }) => residual);
  return Math.max(magnitudeQuantile(residuals, 0.95), 0.01);
}

class Viewer {
  constructor(images, limit) {
    this.images = images;
    this.limit = limit;
    this.factor = DEFAULT_FACTOR;
    this.order = images.map((_, index) => index);
    this.list = html("select", {
      size: 16,
      "aria-label": "Images",
      onchange: () => this.show(Number(this.list.value)),
    });
    this.caption = html("p", { class: "picture-caption", "aria-live": "polite" });
    this.stage = html("div", { class: "stage" });
    this.details = html("div");
    this.element = html(
      "div",
      { class: "viewer", onkeydown: (event) => onPictureKey(event, this.zoom, (by) => this.step(by)) },
      this.sidebar(),
      html("div", null, this.toolbar(), this.caption, this.stage, this.legend()),
      this.details,
    );
    this.fillList();
  }

  sidebar() {
    const order = html(
      "select",
      { onchange: () => this.sort(order.value) },
      html("option", { value: "name" }, "in the order of the session"),
      html("option", { value: "worst" }, "worst first"),
    );
    return html("div", { class: "sidebar" }, html("label", null, "Images ", order), this.list);
  }

  toolbar() {
    const button = (label, title, action) =>
      html("button", { type: "button", title, "aria-label": title, onclick: action }, label);
    return html(
      "div",
      { class: "toolbar" },
      button("‹ Previous", "Previous image (left arrow)", () => this.step(-1)),
      button("Next ›", "Next image (right arrow)", () => this.step(1)),
      button("+", "Zoom in (+)", () => this.zoom.zoomIn()),
      button("−", "Zoom out (-)", () => this.zoom.zoomOut()),
      button("Fit", "Whole picture (0)", () => this.zoom.reset()),
      this.factorSlider(),
      this.toggle("Points", "hide-found"),
      this.toggle("Outlines", "hide-predicted"),
    );
  }

  factorSlider() {
    const output = html("output", null, `${DEFAULT_FACTOR}×`);
    const slider = html("input", {
      type: "range",
      min: 0,
      max: LARGEST_FACTOR,
      step: 50,
      value: DEFAULT_FACTOR,
      oninput: () => {
        this.factor = Number(slider.value);
        output.textContent = this.factor ? `${this.factor}×` : "off";
        this.drawOverlay();
      },
    });
    return html("label", null, "Residuals ", slider, output);
  }

  toggle(label, className) {
    const box = html("input", {
      type: "checkbox",
      checked: true,
      onchange: () => this.stage.classList.toggle(className, !box.checked),
    });
    return html("label", null, box, ` ${label}`);
  }

  legend() {
    const colors = [-1, -0.5, 0, 0.5, 1].map((share) => residualColor(share, 1));
    const bar = html("span", {
      class: "ramp",
      "aria-hidden": "true",
      style: `background:linear-gradient(to right,${colors.join(",")})`,
    });
    const limit = significant(this.limit, 2);
    return html(
      "div",
      { class: "legend" },
      html(
        "p",
        null,
        `inward −${limit} px `,
        bar,
        ` +${limit} px outward. Whiskers: residuals, exaggerated. ` +
          "Crosses: outliers. Thin lines: predicted outlines; dashed: edge left out.",
      ),
      muted(
        "Click the picture, then: wheel or + and − to zoom, drag to move, double click or 0 for the whole " +
          "picture, left and right arrow for other images.",
      ),
    );
  }

  fillList() {
    this.list.replaceChildren(
      ...this.order.map((index) => {
        const image = this.images[index];
        const note = image.left_out
          ? "left out"
          : withUnit(significant(image.rms_px ?? image.held_out_rms_px, 2), "px");
        return html("option", { value: index }, `${image.name}  ${note}`);
      }),
    );
  }

  sort(order) {
    const error = ({ rms_px: rms, held_out_rms_px: heldOut }) => rms ?? heldOut ?? -1;
    this.order = this.images.map((_, index) => index);
    if (order === "worst") this.order.sort((a, b) => error(this.images[b]) - error(this.images[a]) || a - b);
    this.fillList();
    this.show(this.order[0]);
  }

  step(by) {
    const place = this.order.indexOf(this.index) + by;
    if (place >= 0 && place < this.order.length) this.show(this.order[place]);
  }

  // Shows the image that the address of the page names, if it names one; then takes the name out of the address, so
  // that the same link works again.
  follow(section) {
    const index = this.images.findIndex(({ name }) => pictureAddress(name) === window.location.hash);
    if (index < 0) return;
    this.show(index);
    history.replaceState(null, "", `#${section.id}`);
    section.scrollIntoView();
  }

  show(index) {
    this.index = index;
    this.list.value = String(index);
    const hadFocus = this.picture && document.activeElement === this.picture;
    this.drawPicture();
    if (hadFocus) this.picture.focus({ preventScroll: true });
    this.caption.replaceChildren(...captionOf(this.images[index]));
    this.details.replaceChildren(edgeTable(this.images[index]));
  }

  drawPicture() {
    const image = this.images[this.index];
    const { width, height } = sizeOf(image);
    const size = { width, height };
    const { picture, over, zoom } = zoomablePicture(image.picture, size, altText(image), this.stage);
    Object.assign(this, { picture, overlayPlace: over, zoom });
    this.drawOverlay();
  }

  drawOverlay() {
    this.overlayPlace.replaceChildren(
      overlay(this.images[this.index], { limit: this.limit, factor: this.factor }),
    );
  }
}

// The extent of the data where the size of the image is not known.
function sizeOf(image) {
  if (image.width > 0 && image.height > 0) return image;
  const points = edgesOf(image).flatMap(({ predicted, samples }) => [
    ...(predicted ?? []),
    ...(samples ?? []),
  ]);
  return {
    width: Math.max(640, ...points.map(([x]) => x + 1)),
    height: Math.max(480, ...points.map(([, y]) => y + 1)),
  };
}
