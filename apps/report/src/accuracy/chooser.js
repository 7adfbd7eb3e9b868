// The bar that chooses the pose: buttons for few poses, a list for many.
import { html } from "../shared/dom.js";
import { statusOf } from "./status.js";

const MOST_BUTTONS = 8;

// Returns {element, mark(index)}; onChoose(index) is called when the user chooses.
export function poseChooser(poses, onChoose) {
  const { control, mark } = poses.length > MOST_BUTTONS ? list(poses, onChoose) : buttons(poses, onChoose);
  return {
    element: html("div", { class: "chooser" }, html("span", { class: "muted" }, "Pose"), control),
    mark,
  };
}

function buttons(poses, onChoose) {
  const all = poses.map((pose, index) =>
    html(
      "button",
      { type: "button", "data-pose": index, onclick: () => onChoose(index) },
      html("span", { class: `light ${statusOf(pose).level}`, title: statusOf(pose).label }),
      pose.name ?? `${index + 1}`,
    ),
  );
  const mark = (chosen) =>
    all.forEach((button, index) => button.setAttribute("aria-pressed", String(index === chosen)));
  return { control: html("div", { class: "buttons", role: "group", "aria-label": "Pose" }, all), mark };
}

function list(poses, onChoose) {
  const select = html(
    "select",
    { "aria-label": "Pose", onchange: () => onChoose(Number(select.value)) },
    poses.map((pose, index) =>
      html("option", { value: index }, `${pose.name ?? index + 1}: ${statusOf(pose).label.toLowerCase()}`),
    ),
  );
  const step = (label, title, by) =>
    html(
      "button",
      {
        type: "button",
        title,
        "aria-label": title,
        onclick: () => onChoose(Math.max(0, Math.min(poses.length - 1, Number(select.value) + by))),
      },
      label,
    );
  const control = html(
    "div",
    { class: "buttons" },
    step("‹", "Previous pose", -1),
    select,
    step("›", "Next pose", 1),
  );
  return { control, mark: (chosen) => (select.value = String(chosen)) };
}
