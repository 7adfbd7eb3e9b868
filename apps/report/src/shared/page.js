// What every page does with its embedded data: reads them, fills the sections.
import { append, html } from "./dom.js";

export const embeddedData = () => JSON.parse(document.getElementById("data").textContent);

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

// kind: "calibration report"; origin: the texts below the title, of which some may be missing.
export function renderHeader(title, kind, origin) {
  document.title = `${title}: ${kind}`;
  document.getElementById("title").textContent = title;
  document.getElementById("origin").textContent = origin.filter(Boolean).join(" · ");
}
