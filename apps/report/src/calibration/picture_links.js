// Links into the picture viewer.
import { html } from "../shared/dom.js";

// Opens the picture viewer at an image: pictures.js follows these addresses.
export const pictureAddress = (name) => `#pictures/${encodeURIComponent(name)}`;
export const pictureLink = (name) => html("a", { href: pictureAddress(name) }, name);
