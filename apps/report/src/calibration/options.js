// With what the calibration was run.
import { append, definitions, html } from "../shared/dom.js";
import { MISSING } from "../shared/format.js";
import { inText, spaced } from "../shared/option_words.js";

export function renderOptions(section, data) {
  const provenance = [
    ["Program", data.program_version ? `legible ${data.program_version}` : MISSING],
    ["Session", data.session ?? MISSING],
  ];
  const options = Object.entries(data.options ?? {}).map(([name, value]) => [spaced(name), inText(value)]);
  append(
    section,
    html("h3", null, "Provenance"),
    definitions(provenance, "list"),
    html("h3", null, "Options"),
    options.length ? definitions(options, "list") : html("p", { class: "muted" }, "All default."),
  );
}
