// An axis of images by their names, however many there are.

const LABELLED = 60;

export function nameAxis(names, type = "point") {
  const step = Math.ceil(names.length / LABELLED);
  return {
    type,
    domain: names,
    ticks: names.filter((_, index) => index % step === 0),
    tickRotate: -60,
    tickFormat: (name) => shortened(name.replace(/\.[A-Za-z]+$/, "")),
  };
}

const shortened = (text) => (text.length > 10 ? `…${text.slice(-9)}` : text);
