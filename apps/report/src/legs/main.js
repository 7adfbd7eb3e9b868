// Fills the page from its embedded data; parts about a set of legs are filled again when another one is chosen.
import { chooser } from "../shared/chooser.js";
import {
  embeddedData,
  renderAnew,
  renderHeader,
  renderSection,
  renderSections,
  withoutNulls,
} from "../shared/page.js";
import { renderAbout } from "./about.js";
import { renderChosen } from "./chosen.js";
import { Maps, hasMaps } from "./maps.js";
import { renderModes } from "./modes.js";
import { renderRobot } from "./robot.js";
import { renderServo } from "./servo.js";
import { SetsTable } from "./sets.js";
import { renderVerdict } from "./verdict.js";
import { legsOf, verdictOf } from "./wording.js";

const OF_SET = { chosen: renderChosen, modes: renderModes, servo: renderServo };
const byId = (id) => document.getElementById(id);

class Page {
  constructor(data) {
    this.data = data;
    this.sets = (data.document?.sets ?? []).map((set, index) => ({ ...set, index }));
  }

  render() {
    const hasSets = () => this.sets.length > 0;
    const later = () => {};
    renderSections(
      {
        verdict: [({ document }) => document, renderVerdict],
        sets: [hasSets, (section) => this.renderTable(section)],
        chosen: [hasSets, later],
        modes: [hasSets, later],
        servo: [hasSets, later],
        maps: [hasMaps, (section) => this.renderMaps(section)],
        legs: [({ document }) => document, renderRobot],
        about: [() => true, renderAbout],
      },
      this.data,
      { data: this.data },
    );
    if (!hasSets()) return;
    this.addChooser();
    this.choose(0);
  }

  renderTable(section) {
    this.table = new SetsTable(this.data.document, (index) => this.choose(index));
    this.table.renderInto(section);
  }

  renderMaps(section) {
    this.maps = new Maps(this.data);
    this.maps.renderInto(section);
  }

  addChooser() {
    if (this.sets.length < 2) return;
    const choices = this.sets.map((set) => {
      const { level, label } = verdictOf(set);
      return { name: legsOf(set), level, state: label };
    });
    this.chooser = chooser("Legs", choices, (index) => this.choose(index));
    byId("chooser").replaceChildren(this.chooser.element);
    byId("chooser").hidden = false;
  }

  choose(index) {
    const set = this.sets[index];
    document.body.dataset.set = index;
    this.chooser?.mark(index);
    this.table?.mark(index);
    for (const [id, render] of Object.entries(OF_SET)) renderAnew(id, render, { data: this.data, set });
    if (this.maps) renderSection("maps", () => this.maps.show(set));
  }
}

const data = withoutNulls(embeddedData());
const program = data.program_version && `legible ${data.program_version}`;
renderHeader(data.title ?? "Legs to watch", "report on legs to watch", [data.model, program]);
new Page(data).render();
