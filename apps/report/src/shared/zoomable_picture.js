// A picture of the camera with something drawn over it, to zoom and to pan.
import { svg } from "./dom.js";
import { panZoom } from "./pan_zoom.js";

const PIXELS_SHOWN_FROM = 4; // times
const MISSING_TEXT = "no picture in this report";

// Puts the picture at `address` (null: a blank one), of {width, height} px, into the element `stage` in place of what is
// there. Returns {picture, over: where to draw, in pixels of the image, zoom: of pan_zoom.js}; below the picture --unit is
// one pixel of the screen in pixels of the image.
export function zoomablePicture(address, size, description, stage) {
  const over = svg("g");
  const picture = svg(
    "svg",
    {
      tabindex: 0,
      role: "img",
      "aria-label": description,
      style: `aspect-ratio:${size.width}/${size.height}`,
    },
    background(address, size),
    over,
  );
  let times = 1;
  const measure = () =>
    picture.style.setProperty("--unit", size.width / times / (stage.clientWidth || size.width));
  const onZoom = (zoomed) => {
    times = zoomed;
    picture.classList.toggle("pixels", times > PIXELS_SHOWN_FROM);
    measure();
  };
  // Pixel (0, 0) has its centre at the origin, so the picture begins half a pixel before it.
  const zoom = panZoom(picture, { x: -0.5, y: -0.5, ...size }, onZoom);
  stage.replaceChildren(picture);
  zoom.reset();
  new ResizeObserver(measure).observe(picture);
  return { picture, over, zoom };
}

// What keys do over such a picture: arrows step(by) to the next or the one before, + - 0 zoom.
export function onPictureKey(event, zoom, step) {
  if (event.target.matches("input, select") || event.ctrlKey || event.altKey || event.metaKey) return;
  const actions = {
    ArrowLeft: () => step(-1),
    ArrowRight: () => step(1),
    "+": () => zoom.zoomIn(),
    "=": () => zoom.zoomIn(),
    "-": () => zoom.zoomOut(),
    0: () => zoom.reset(),
  };
  if (!actions[event.key]) return;
  actions[event.key]();
  event.preventDefault();
}

function background(address, { width, height }) {
  if (address)
    return svg("image", { href: address, x: -0.5, y: -0.5, width, height, preserveAspectRatio: "none" });
  return [
    svg("rect", { x: -0.5, y: -0.5, width, height, class: "no-picture" }),
    svg(
      "text",
      {
        y: 28,
        class: "no-picture-text",
        style: `transform:translate(${width / 2}px,0) scale(var(--unit))`,
      },
      MISSING_TEXT,
    ),
  ];
}
