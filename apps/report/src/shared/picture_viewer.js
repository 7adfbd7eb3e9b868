// A viewer of many pictures of the camera: choose one, see what is drawn over it, zoom and pan.
import { html } from "./dom.js";
import { capitalized, significant, withUnit } from "./format.js";
import { pictureAddress } from "./picture_links.js";
import { onPictureKey, zoomablePicture } from "./zoomable_picture.js";

export const VIEWER_HINT =
  "Click the picture, then: wheel or + and − to zoom, drag to move, double click or 0 for the whole picture, left " +
  "and right arrow for other images.";

export class PictureViewer {
  // images: [{name, picture (a data: address), left_out (why), ...}]. What differs from page to page, in `page`:
  //   nouns        {one: "image", many: "images", order: "in the order of the session"}
  //   errorOf(image) (px, null: not known), sizeOf(image) {width, height}, describe(image): for those who cannot see it
  //   captionOf(image), detailsOf(image)     what stands above and below it
  //   overlay(image, factor)                 what is drawn over it, with residuals enlarged by the factor
  //   factor       {first, largest, step} of that enlargement; null: there are no residuals
  //   toggles      [[label, class of the stage that hides it]]
  //   legend       element
  constructor(images, page) {
    this.images = images;
    this.page = page;
    this.factor = page.factor?.first ?? 0;
    this.order = images.map((_, index) => index);
    this.list = html("select", {
      size: 16,
      "aria-label": capitalized(page.nouns.many),
      onchange: () => this.show(Number(this.list.value)),
    });
    this.caption = html("p", { class: "picture-caption", "aria-live": "polite" });
    this.stage = html("div", { class: "stage" });
    this.details = html("div");
    this.element = html(
      "div",
      { class: "viewer", onkeydown: (event) => onPictureKey(event, this.zoom, (by) => this.step(by)) },
      this.sidebar(),
      html("div", null, this.toolbar(), this.caption, this.stage, page.legend),
      this.details,
    );
    this.fillList();
  }

  // Puts the viewer into the section and shows the first picture, or the one that the address of the page names.
  showIn(section) {
    section.append(this.element);
    window.addEventListener("hashchange", () => this.follow(section));
    this.show(0);
    this.follow(section);
  }

  sidebar() {
    const { many, order: asTheyCame } = this.page.nouns;
    const order = html(
      "select",
      { onchange: () => this.sort(order.value) },
      html("option", { value: "name" }, asTheyCame),
      html("option", { value: "worst" }, "worst first"),
    );
    return html("div", { class: "sidebar" }, html("label", null, `${capitalized(many)} `, order), this.list);
  }

  toolbar() {
    const { one } = this.page.nouns;
    const button = (label, title, action) =>
      html("button", { type: "button", title, "aria-label": title, onclick: action }, label);
    return html(
      "div",
      { class: "toolbar" },
      button("‹ Previous", `Previous ${one} (left arrow)`, () => this.step(-1)),
      button("Next ›", `Next ${one} (right arrow)`, () => this.step(1)),
      button("+", "Zoom in (+)", () => this.zoom.zoomIn()),
      button("−", "Zoom out (-)", () => this.zoom.zoomOut()),
      button("Fit", "Whole picture (0)", () => this.zoom.reset()),
      this.page.factor && this.factorSlider(),
      this.page.toggles.map(([label, className]) => this.toggle(label, className)),
    );
  }

  factorSlider() {
    const { first, largest, step } = this.page.factor;
    const output = html("output", null, `${first}×`);
    const slider = html("input", {
      type: "range",
      min: 0,
      max: largest,
      step,
      value: first,
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

  fillList() {
    this.list.replaceChildren(
      ...this.order.map((index) => {
        const image = this.images[index];
        const note = image.left_out ? "left out" : withUnit(significant(this.page.errorOf(image), 2), "px");
        return html("option", { value: index }, `${image.name}  ${note}`);
      }),
    );
  }

  sort(order) {
    const error = (index) => this.page.errorOf(this.images[index]) ?? -1;
    this.order = this.images.map((_, index) => index);
    if (order === "worst") this.order.sort((a, b) => error(b) - error(a) || a - b);
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
    this.caption.replaceChildren(...this.page.captionOf(this.images[index]));
    this.details.replaceChildren(this.page.detailsOf(this.images[index]));
  }

  drawPicture() {
    const image = this.images[this.index];
    const { width, height } = this.page.sizeOf(image);
    const size = { width, height };
    const { picture, over, zoom } = zoomablePicture(
      image.picture,
      size,
      this.page.describe(image),
      this.stage,
    );
    Object.assign(this, { picture, overlayPlace: over, zoom });
    this.drawOverlay();
  }

  drawOverlay() {
    this.overlayPlace.replaceChildren(this.page.overlay(this.images[this.index], this.factor));
  }
}
