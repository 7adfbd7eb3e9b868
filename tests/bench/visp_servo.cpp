#include "tests/bench/visp_servo.h"

#include <visp3/core/vpException.h>
#include <visp3/me/vpMeLine.h>
#include <visp3/vs/vpServo.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "servo/visp_leg_edge.h"
#include "tests/bench/visp_moving_edges.h"

namespace legible {

struct VispServo::Task {
  ServoModel model;
  std::vector<LegEdgeFeature> seen, goals;
  vpServo servo;
};

VispServo::VispServo(const ServoModel& model, const ServoGoal& goal, double gain_per_s)
    : task_(new Task{model, {}, {}, {}}) {
  for (int leg = 0; leg < kLegCount; ++leg)
    for (const auto& edge : goal.edges[static_cast<size_t>(leg)]) {
      if (!edge) continue;
      task_->seen.emplace_back(model, leg);
      task_->goals.emplace_back(model, leg);
      task_->goals.back().BuildGoal(edge->normal);
    }
  task_->servo.setServo(vpServo::EYEINHAND_L_cVe_eJe);
  task_->servo.setInteractionMatrixType(vpServo::CURRENT);
  task_->servo.setLambda(gain_per_s);
  for (size_t i = 0; i < task_->seen.size(); ++i) task_->servo.addFeature(task_->seen[i], task_->goals[i]);
}

VispServo::~VispServo() = default;

Vector6d VispServo::Speeds(const SeenEdges& seen, const LegDirections& directions, const Vector6d& length_m) {
  for (size_t i = 0; i < seen.edges.size(); ++i) {
    const SeenEdge& edge = seen.edges[i];
    task_->seen.at(i).BuildSeen(edge.normal, directions.col(edge.leg), length_m[edge.leg], task_->goals[i]);
  }
  task_->servo.set_cVe(vpVelocityTwistMatrix());
  task_->servo.set_eJe(TwistByJointSpeeds(task_->model, directions));
  const vpColVector speeds = task_->servo.computeControlLaw();
  Vector6d converted;
  for (unsigned i = 0; i < 6; ++i) converted[i] = speeds[i];
  return converted;
}

namespace {

vpImagePoint ToImagePoint(const Camera& camera, const Eigen::Vector2d& point) {
  const Eigen::Vector2d pixel = ProjectNormalised(camera, point);
  return {pixel.y(), pixel.x()};
}

// a y + b x + c = 0 in pixels as the outline normal of an edge that `known` is near.
SeenEdge ToSeen(const Camera& camera, const vpMeLine& line, const SeenEdge& known) {
  SeenEdge seen = known;
  const double a = line.getA(), b = line.getB(), c = line.getC();
  const Eigen::Vector3d normal(camera.fx_px * b, camera.fy_px * a, camera.cx_px * b + camera.cy_px * a + c);
  seen.normal = (normal.dot(known.normal) < 0 ? -normal : normal).normalized();
  return seen;
}

}  // namespace

struct VispEdges::Lines {
  explicit Lines(const ServoModel& m) : model(m) {}

  const ServoModel& model;
  vpMe me = MovingEdges();
  vpImage<unsigned char> image;
  std::vector<std::unique_ptr<vpMeLine>> lines;
  int lost = 0;

  void Start(size_t i, const SeenEdge& known) {
    lines.at(i) = std::make_unique<vpMeLine>();
    lines[i]->setMe(&me);
    lines[i]->initTracking(image, ToImagePoint(model.camera, known.ends[0]),
                           ToImagePoint(model.camera, known.ends[1]));
  }
};

VispEdges::VispEdges(const ServoModel& model) : lines_(new Lines(model)) {
  lines_->image.resize(static_cast<unsigned>(model.camera.height_px),
                       static_cast<unsigned>(model.camera.width_px));
}

VispEdges::~VispEdges() = default;

void VispEdges::Load(const std::uint8_t* pixels) {
  std::copy(pixels, pixels + lines_->image.getSize(), lines_->image.bitmap);
}

void VispEdges::Start(const SeenEdges& known) {
  lines_->lines.resize(known.edges.size());
  for (size_t i = 0; i < known.edges.size(); ++i) lines_->Start(i, known.edges[i]);
}

SeenEdges VispEdges::Track(const SeenEdges& known) {
  SeenEdges seen;
  for (size_t i = 0; i < known.edges.size(); ++i) {
    try {
      lines_->lines[i]->track(lines_->image);
    } catch (const vpException&) {
      ++lines_->lost;
      lines_->Start(i, known.edges[i]);
    }
    seen.edges.push_back(ToSeen(lines_->model.camera, *lines_->lines[i], known.edges[i]));
  }
  return seen;
}

int VispEdges::lost() const { return lines_->lost; }

}  // namespace legible
