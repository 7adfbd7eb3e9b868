// An axis of images by their names, however many there are.

const LABEL_PX = 17;

// width: of the plot, px
export function nameAxis(names, width, type = "point") {
  const step = Math.ceil((names.length * LABEL_PX) / width);
  return {
    type,
    domain: names,
    ticks: names.filter((_, index) => index % step === 0),
    tickRotate: -60,
    tickFormat: (name) => shortened(name.replace(/\.[A-Za-z]+$/, "")),
  };
}

const shortened = (text) => (text.length > 10 ? `…${text.slice(-9)}` : text);
