// The headline figures of the selected pose, and what to be warned of.
import { append, html, paragraph } from "../shared/dom.js";
import { capitalized, isNumber, plural, sentence, tick } from "../shared/format.js";
import { number, withUnit } from "../shared/numbers.js";
import { inWords } from "../shared/parameter_names.js";
import { statusOf } from "./status.js";
import { unitsOf } from "./units.js";

export function renderSummary(section, { data, pose }) {
  append(section, pose && headline(data.document, pose), warnings(data.document?.warnings));
}

function headline(document, pose) {
  const { label, level, text } = statusOf(pose);
  return html(
    "div",
    { class: `verdict ${level}`, role: "status" },
    html("p", { class: "headline" }, `${capitalized(pose.name ?? "pose")}: ${label.toLowerCase()}`),
    paragraph(explanation(document, pose, text)),
    html("dl", { class: "figures large" }, figures(document, pose)),
  );
}

function explanation(document, pose, text) {
  const own = pose.message ? sentence(pose.message) : text;
  if (!isNumber(pose.max_error?.position)) return own;
  const caption = `${jointErrorText(document)}, the platform can be off by as much as this.`;
  return pose.status === "regular" ? caption : `${own} ${caption}`;
}

function jointErrorText(document) {
  const errors = (document.joint_error ?? []).filter(isNumber);
  if (errors.length === 0) return "With all joint readings within their errors";
  const same = errors.every((error) => error === errors[0]);
  const unit = unitsOf(document).of("joint", unitsOf(document).length);
  return same
    ? `With every joint reading wrong by at most ${tick(errors[0])} ${unit}`
    : `With the joint readings wrong by at most ${errors.map((error) => tick(error)).join(", ")} ${unit}`;
}

function figures(document, pose) {
  const { length, angle } = unitsOf(document);
  const entry = (term, value, note) =>
    html("div", null, html("dt", null, term), html("dd", null, value, note && html("small", null, note)));
  const value = (path, unit) => withUnit(number(at(pose, path), path), unit);
  const together = pose.together;
  return [
    entry(
      "Largest position error",
      value("max_error.position", length),
      "in any direction, from the joint readings",
    ),
    entry(
      "Largest rotation error",
      value("max_error.rotation", angle),
      "about any axis, from the joint readings",
    ),
    together && entry("All sources together", value("together.value_95.position", length), "position, 95 %"),
    together && entry("All sources together", value("together.value_95.rotation", angle), "rotation, 95 %"),
    entry("Condition number", value("condition.two_normalized"), "2-norm, normalized; 1 is best"),
  ];
}

const at = (pose, path) => path.split(".").reduce((part, name) => part?.[name], pose);

function warnings(texts) {
  if (!texts?.length) return null;
  const items = html(
    "ul",
    null,
    texts.map((text) => html("li", null, sentence(inWords(text)))),
  );
  return html(
    "div",
    { class: "notice", id: "warnings" },
    html("strong", null, plural(texts.length, "warning")),
    items,
  );
}
