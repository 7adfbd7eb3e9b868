// Zooming and panning an SVG through its viewBox.

const LARGEST_ZOOM = 60;
const CLICK_STEP = 1.5;

// full: {x, y, width, height} that is seen at zoom 1; onZoom(zoom) is called after each change.
export function panZoom(image, full, onZoom) {
  let view = { ...full };

  function show(next) {
    const width = Math.min(full.width, Math.max(full.width / LARGEST_ZOOM, next.width));
    const height = (width * full.height) / full.width;
    view = {
      width,
      height,
      x: Math.min(full.x + full.width - width, Math.max(full.x, next.x)),
      y: Math.min(full.y + full.height - height, Math.max(full.y, next.y)),
    };
    image.setAttribute("viewBox", `${view.x} ${view.y} ${view.width} ${view.height}`);
    onZoom(full.width / view.width);
  }

  // Share of the view at which the pointer is.
  function shareAt({ clientX, clientY }) {
    const box = image.getBoundingClientRect();
    return { x: (clientX - box.left) / box.width, y: (clientY - box.top) / box.height };
  }

  function zoom(factor, at = { x: 0.5, y: 0.5 }) {
    const width = Math.min(full.width, Math.max(full.width / LARGEST_ZOOM, view.width / factor));
    const shrink = view.width - width;
    show({ width, x: view.x + shrink * at.x, y: view.y + (shrink * at.y * full.height) / full.width });
  }

  // By shares of the view.
  const pan = (x, y) => show({ ...view, x: view.x + x * view.width, y: view.y + y * view.height });
  const reset = () => show(full);

  // The wheel belongs to the page until the picture has been clicked or Ctrl is held.
  image.addEventListener(
    "wheel",
    (event) => {
      if (!event.ctrlKey && document.activeElement !== image) return;
      event.preventDefault();
      zoom(Math.exp(-event.deltaY / 400), shareAt(event));
    },
    { passive: false },
  );
  image.addEventListener("dblclick", reset);
  dragging(image, (event) =>
    pan(-event.movementX / image.clientWidth, -event.movementY / image.clientHeight),
  );

  reset();
  return { zoomIn: () => zoom(CLICK_STEP), zoomOut: () => zoom(1 / CLICK_STEP), pan, reset };
}

function dragging(image, onMove) {
  image.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "touch" || event.button !== 0) return;
    image.focus({ preventScroll: true });
    image.setPointerCapture(event.pointerId);
  });
  image.addEventListener("pointermove", (event) => image.hasPointerCapture(event.pointerId) && onMove(event));
}
