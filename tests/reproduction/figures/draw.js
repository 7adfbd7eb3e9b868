// The papers' figures by the names of their files. Runs in a browser.
import { andreffFigures } from "./andreff.js";
import { briotFigures } from "./briot.js";

window.drawFigures = (data) => ({ ...andreffFigures(data), ...briotFigures(data) });
