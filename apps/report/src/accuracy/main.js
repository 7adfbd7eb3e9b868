// Fills the page from its embedded data; parts that depend on the pose are filled again when another one is chosen.
import { chooser } from "../shared/chooser.js";
import { embeddedData, renderAnew, renderHeader, renderSection, showSection } from "../shared/page.js";
import { renderAbout } from "./about.js";
import { renderAllPoses } from "./all_poses.js";
import { hasComparison, renderComparison } from "./comparison.js";
import { renderErrors } from "./errors.js";
import { renderIndices } from "./indices.js";
import { renderIntersection } from "./intersection.js";
import { hasMaps, renderMaps } from "./maps.js";
import { RobotView, canDrawRobot } from "./robot_view.js";
import { renderSources } from "./sources.js";
import { statusOf } from "./status.js";
import { renderSummary } from "./summary.js";
import { renderWorkspace } from "./workspace.js";

const OF_POSE = {
  summary: renderSummary,
  errors: renderErrors,
  sources: renderSources,
  indices: renderIndices,
};

const byId = (id) => document.getElementById(id);

class Page {
  constructor(data) {
    this.data = data;
    this.poses = (data.document?.poses ?? []).map((pose, index) => ({ ...pose, index }));
    this.choose = this.choose.bind(this);
  }

  render() {
    this.hideWithoutData();
    this.renderOnce("poses", (section, page) => {
      renderAllPoses(section, page);
      renderIntersection(section, page);
    });
    this.renderOnce("map", renderMaps);
    this.renderOnce("comparison", renderComparison);
    this.renderOnce("workspace", renderWorkspace);
    this.renderOnce("about", renderAbout);
    this.renderOnce("robot", (section, { data }) => {
      this.robot = new RobotView(data);
      this.robot.renderInto(section);
    });
    this.addChooser();
    this.choose(0);
  }

  // A part without data is left out, and so is the link to it.
  hideWithoutData() {
    const { document: found } = this.data;
    const several = this.poses.length > 1 || found?.intersection;
    const present = {
      summary: this.poses.length > 0 || found?.warnings?.length,
      robot: canDrawRobot(this.data),
      errors: this.poses.length > 0,
      sources: this.poses.some(({ sources }) => sources?.length),
      indices: this.poses.length > 0,
      poses: several,
      map: hasMaps(this.data.maps),
      comparison: hasComparison(this.data),
      workspace: found?.workspace,
    };
    for (const [id, there] of Object.entries(present)) showSection(id, Boolean(there));
  }

  renderOnce(id, render) {
    const { data, choose } = this;
    if (!byId(id).hidden) renderSection(id, render, { data, choose });
  }

  addChooser() {
    if (this.poses.length < 2) return;
    const choices = this.poses.map((pose, index) => {
      const { level, label } = statusOf(pose);
      return { name: pose.name ?? `${index + 1}`, level, state: label };
    });
    this.chooser = chooser("Pose", choices, this.choose);
    byId("chooser").replaceChildren(this.chooser.element);
    byId("chooser").hidden = false;
  }

  choose(index) {
    const pose = this.poses[index];
    document.body.dataset.pose = index;
    this.chooser?.mark(index);
    for (const [id, render] of Object.entries(OF_POSE))
      if (!byId(id).hidden) renderAnew(id, render, { data: this.data, pose });
    if (this.robot) renderSection("robot", () => this.robot.show(pose), this.data);
  }
}

const data = embeddedData();
const program = data.program_version && `legible ${data.program_version}`;
renderHeader(data.title ?? "Accuracy report", "accuracy report", [data.model, program]);
new Page(data).render();
