// The words of this page, and where it comes from.
import { append, definitions, html, paragraph } from "../shared/dom.js";
import { MISSING } from "../shared/format.js";

const WORDS = [
  [
    "Hidden robot",
    "The robot whose actuated joints are the directions of the seen legs: a servo of directions moves the platform as " +
      "that robot would move, not as the real one does.",
  ],
  [
    "Assembly mode",
    "One of the poses at which all seen legs have the same directions; a servo can end in any of them with all errors " +
      "at zero.",
  ],
  [
    "Aspect",
    "A region of poses without a singularity of the hidden robot between them; the servo stays in the one in which it " +
      "starts, which can hold several assembly modes.",
  ],
  [
    "Type 1, Type 2",
    "Singularities: a leg is stretched or folded; the platform can move though all that is seen, or actuated, is held.",
  ],
  [
    "Working mode",
    "The side to which a leg with an arm or a slide bends; it changes only where the leg is stretched or folded.",
  ],
  [
    "Cone noise",
    "Each seen direction may be off by up to an angle to any side, and errors are those of the worst combination.",
  ],
  [
    "Edges",
    "The outlines of a leg in the image: they show the line of its axis, where it is as well as where it points.",
  ],
];
const REFERENCE =
  "S. Briot, V. Rosenzweig, P. Martinet, E. Özgür, N. Bouton: Minimal representation for the control of parallel " +
  "robots via leg observation considering a hidden robot model. Mechanism and Machine Theory 106, 2016.";

export function renderAbout(section, { data }) {
  append(
    section,
    definitions(WORDS, "list"),
    html("h3", null, "Reference"),
    paragraph(REFERENCE),
    html("h3", null, "Provenance"),
    definitions(
      [
        ["Program", data.program_version ? `legible ${data.program_version}` : MISSING],
        ["Model", data.model ?? MISSING],
        ["Robot", data.document?.robot || data.title || MISSING],
      ],
      "list",
    ),
  );
}
