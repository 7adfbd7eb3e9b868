// Links into the picture viewer.
import { html } from "./dom.js";

const LINKS_SHOWN = 12;

// Opens the picture viewer at an image: picture_viewer.js follows these addresses.
export const pictureAddress = (name) => `#pictures/${encodeURIComponent(name)}`;
export const pictureLink = (name) => html("a", { href: pictureAddress(name) }, name);

export function showPicture(name) {
  window.location.hash = pictureAddress(name);
}

// Links to several, of which many fold away.
export function pictureLinks(names) {
  const separated = (some) => some.flatMap((name, index) => [index ? " " : "", pictureLink(name)]);
  const rest = names.slice(LINKS_SHOWN);
  return html(
    "span",
    { class: "links" },
    separated(names.slice(0, LINKS_SHOWN)),
    rest.length > 0 &&
      html("details", null, html("summary", null, `and ${rest.length} more`), separated(rest)),
  );
}
