// Combinations of parameters that the data tell least about.
import { append, muted, table } from "../shared/dom.js";
import { MISSING, isNumber, percent, sentence } from "../shared/format.js";
import { inWords } from "../shared/parameter_names.js";

export function renderWeak(section, data) {
  const weak = data.weak ?? [];
  if (weak.length === 0) {
    append(section, muted("None listed."));
    return;
  }
  append(
    section,
    muted(
      "The least certain combinations of parameters. The relative σ compares the uncertainty along the " +
        "combination with the size of the things it moves: 100 % means not known at all.",
    ),
    table(
      "Weak directions",
      [
        { label: "Combination", text: true, cell: ({ description }) => sentence(inWords(description)) },
        {
          label: "Relative σ",
          cell: ({ relative_sigma: size }) => (isNumber(size) ? percent(size) : MISSING),
        },
      ],
      [{ rows: weak }],
    ),
  );
}
