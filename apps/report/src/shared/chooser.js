// The bar that chooses what the page is about: buttons for few choices, a list for many.
import { html } from "./dom.js";

const MOST_BUTTONS = 8;

// choices: [{name, level ("good", "care", "bad"), state: what that means in words}]. Returns {element, mark(index)};
// onChoose(index) is called when the user chooses.
export function chooser(label, choices, onChoose) {
  const kind = choices.length > MOST_BUTTONS ? list : buttons;
  const { control, mark } = kind(label, choices, onChoose);
  return {
    element: html("div", { class: "chooser" }, html("span", { class: "muted" }, label), control),
    mark,
  };
}

function buttons(label, choices, onChoose) {
  const all = choices.map(({ name, level, state }, index) =>
    html(
      "button",
      { type: "button", "data-choice": index, onclick: () => onChoose(index) },
      html("span", { class: `light ${level}`, title: state }),
      name,
    ),
  );
  const mark = (chosen) =>
    all.forEach((button, index) => button.setAttribute("aria-pressed", String(index === chosen)));
  return { control: html("div", { class: "buttons", role: "group", "aria-label": label }, all), mark };
}

function list(label, choices, onChoose) {
  const select = html(
    "select",
    { "aria-label": label, onchange: () => onChoose(Number(select.value)) },
    choices.map(({ name, state }, index) =>
      html("option", { value: index }, `${name}: ${state.toLowerCase()}`),
    ),
  );
  const step = (text, title, by) =>
    html(
      "button",
      {
        type: "button",
        title,
        "aria-label": title,
        onclick: () => onChoose(Math.max(0, Math.min(choices.length - 1, Number(select.value) + by))),
      },
      text,
    );
  const control = html(
    "div",
    { class: "buttons" },
    step("‹", "The one before", -1),
    select,
    step("›", "The next", 1),
  );
  return { control, mark: (chosen) => (select.value = String(chosen)) };
}
