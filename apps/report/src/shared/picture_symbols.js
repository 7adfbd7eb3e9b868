// Marks over a picture that keep their size on the screen when it is zoomed.
import { svg } from "./dom.js";

const SHAPES = {
  cross: "M-4,-4L4,4M-4,4L4,-4",
  diamond: "M0,-6L6,0L0,6L-6,0Z",
  square: "M-5,-5H5V5H-5Z",
};

// At {x, y} of the image; title: what is read on pointing at it. --unit is one pixel of the screen in pixels of the image
// (see zoomable_picture.js).
export const symbol = ({ x, y }, shape, className, title) =>
  svg(
    "path",
    { class: className, d: SHAPES[shape], style: `transform:translate(${x}px,${y}px) scale(var(--unit))` },
    svg("title", null, title),
  );
