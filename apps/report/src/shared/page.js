// What every page does with its embedded data: reads them, fills the sections.
import { append, html } from "./dom.js";

export const embeddedData = () => JSON.parse(document.getElementById("data").textContent);

// Members that are null are as good as missing.
export const withoutNulls = (data) =>
  Object.fromEntries(Object.entries(data).filter(([, value]) => value !== null));

// One section that fails must not take the others with it.
export function renderSection(id, render, data) {
  const section = document.getElementById(id);
  try {
    render(section, data);
  } catch (error) {
    console.error(error);
    append(section, html("p", { class: "notice" }, `This section could not be drawn: ${error.message}`));
  }
}

// A section with its heading whose other contents are of something else than before.
export function renderAnew(id, render, data) {
  const section = document.getElementById(id);
  section.replaceChildren(section.querySelector("h2"));
  renderSection(id, render, data);
}

export function showSection(id, there) {
  document.getElementById(id).hidden = !there;
  document.querySelector(`nav a[href="#${id}"]`).hidden = !there;
}

// sections: {id: [isThere(data), render(section, given)]}. Those that have nothing to show are gone, with the links to them.
export function renderSections(sections, data, given = data) {
  for (const [id, [isThere, render]] of Object.entries(sections)) {
    const there = Boolean(isThere(data));
    showSection(id, there);
    if (there) renderSection(id, render, given);
  }
}

// kind: "calibration report"; origin: the texts below the title, of which some may be missing.
export function renderHeader(title, kind, origin) {
  document.title = `${title}: ${kind}`;
  document.getElementById("title").textContent = title;
  document.getElementById("origin").textContent = origin.filter(Boolean).join(" · ");
}
