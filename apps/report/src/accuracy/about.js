// How to read the numbers, and where they come from.
import { append, definitions, html } from "../shared/dom.js";
import { MISSING, sentence } from "../shared/format.js";
import { spaced } from "../shared/option_words.js";
import { pretty } from "./units.js";

export function renderAbout(section, { data }) {
  const document = data.document ?? {};
  const listed = (title, entries) =>
    entries.length > 0 && [html("h3", null, title), definitions(entries, "list")];
  const entriesOf = (members, show) =>
    Object.entries(members ?? {}).map(([name, text]) => [spaced(name), show(text)]);
  append(
    section,
    listed("Conventions", entriesOf(document.conventions, sentence)),
    listed("Units", entriesOf(document.units, pretty)),
    listed("Definitions", entriesOf(document.definitions, sentence)),
    listed("Provenance", [
      ["Program", data.program_version ? `legible ${data.program_version}` : MISSING],
      ["Model", data.model ?? document.model ?? MISSING],
      ["Robot", data.title ?? document.robot ?? MISSING],
    ]),
  );
}
