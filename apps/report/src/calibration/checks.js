// Comparisons with things beside the edges: images held out, tags, joint readings.
import { append, muted, table } from "../shared/dom.js";
import { fixed, sentence, significant } from "../shared/format.js";

export function renderChecks(section, data) {
  const checks = data.checks ?? [];
  const heldOut = heldOutCheck(data.calibration?.held_out);
  const rows = heldOut ? [heldOut, ...checks] : checks;
  if (rows.length === 0) {
    append(
      section,
      muted("None: no images were held out, and the session names nothing else to compare with."),
    );
    return;
  }
  append(
    section,
    table(
      "Comparisons; where nothing else is said, with what took no part in the fit",
      [
        { label: "Check", text: true, cell: ({ name }) => sentence(name).replace(/\.$/, "") },
        { label: "What it says", text: true, cell: ({ text }) => sentence(text) },
        { label: "rms", unit: "px", cell: ({ rms_px: rms }) => significant(rms) },
        { label: "rms", unit: "mm", cell: ({ mm }) => fixed(mm, 3) },
      ],
      [{ rows }],
    ),
  );
}

const heldOutCheck = (heldOut) =>
  heldOut && {
    name: "Held-out images",
    text: "Edges in images that took no part in the fit, against the model found without them",
    rms_px: heldOut.rms_px,
  };
