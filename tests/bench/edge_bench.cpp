// How well and how fast a straight edge of known place is found, by this project and by ViSP's moving edges.
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>
#include <vector>

#include "core/vision/edge_band.h"
#include "core/vision/edge_profile.h"
#include "core/vision/leg_edges.h"
#include "tests/bench/bench_table.h"
#include "tests/bench/visp_line.h"
#include "tests/testing/random.h"

namespace legible {
namespace {

constexpr double kBackground = 60, kContrast = 120, kNoise = 2, kBlur_px = 1, kLength_px = 400;
constexpr double kPredictedOff_px = 0.3;
constexpr int kDraws = 400, kSide_px = 500;
constexpr double kOutside_px = 8, kInside_px = 6, kStep_px = 6, kBin_px = 0.25, kFineBins_px = 2.5;

// (noise / contrast) sqrt(2 s sqrt(pi)) / sqrt(L), s the blur of the image.
double Bound_px() {
  return kNoise / kContrast * std::sqrt(2 * kBlur_px * std::sqrt(std::numbers::pi)) / std::sqrt(kLength_px);
}

// The leg lies where (p - middle).normal < 0.
struct Edge {
  Eigen::Vector2d middle_px, along_px, normal_px;
  Eigen::Vector2d At(double along) const { return middle_px + along * along_px; }
};

Edge RandomEdge(std::mt19937_64& generator) {
  const double angle = Uniform(generator, -std::numbers::pi, std::numbers::pi);
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d centre(kSide_px / 2.0, kSide_px / 2.0);
  return {centre + UniformVector(generator, -10, 10).head<2>(), along, {-along.y(), along.x()}};
}

GrayImage Render(const Edge& edge, std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0, kNoise);
  GrayImage image{kSide_px, kSide_px, {}};
  for (int y = 0; y < kSide_px; ++y)
    for (int x = 0; x < kSide_px; ++x) {
      const double inside = -edge.normal_px.dot(Eigen::Vector2d(x, y) - edge.middle_px);
      const double share = std::erfc(-inside / (kBlur_px * std::numbers::sqrt2)) / 2;
      image.pixels.push_back(
          static_cast<std::uint8_t>(std::lround(kBackground + kContrast * share + noise(generator))));
    }
  return image;
}

// A prediction parallel to the edge.
struct Prediction {
  std::vector<PredictedEdgePoint> points;
  double off_px = 0;  // outward
};

Prediction Predict(const Edge& edge, std::mt19937_64& generator) {
  Prediction prediction{{}, Uniform(generator, -1, 1) < 0 ? -kPredictedOff_px : kPredictedOff_px};
  const int cells = static_cast<int>(std::lround(kLength_px / kStep_px));
  for (int i = 0; i <= cells; ++i) {
    PredictedEdgePoint point;
    point.share = static_cast<double>(i) / cells;
    point.point_px = edge.At((point.share - 0.5) * kLength_px) + prediction.off_px * edge.normal_px;
    point.normal_px = edge.normal_px;
    prediction.points.push_back(point);
  }
  return prediction;
}

// What MeasureLegEdges does with a traced edge, once, in a wider window: offset of the found edge outward
// from the prediction's middle.
double OffsetByBand(const GrayImage& image, const Prediction& prediction) {
  const BinGrid grid{kOutside_px + 1, kInside_px + 1, kBin_px};
  EdgeBand band = CollectBand(image, prediction.points, grid.outside_px, grid.inside_px);
  MeasureLevels(band);
  const EdgeProfile profile =
      FlatProfile(BinBand(band, 0, band.cells.size(), grid), SoftStep(grid), grid, kFineBins_px);
  ProfileFitOptions options;
  options.blur_px =
      std::sqrt(kBlur_px * kBlur_px - 1.0 / 12);  // the image's whole blur holds the pixels' own
  options.grey_noise = GreyNoise(band);
  options.outside_px = kOutside_px;
  options.inside_px = kInside_px;
  const auto fit = FitSimplestModel(profile, 0, options);
  return fit ? prediction.off_px - fit->place_px : std::nan("");
}

// Offset of ViSP's line outward from the true edge, at the edge's middle.
double OffsetOf(const VispLine& line, const Edge& edge) {
  const double value = line.a * edge.middle_px.y() + line.b * edge.middle_px.x() + line.c;
  return -value / (line.a * edge.normal_px.y() + line.b * edge.normal_px.x());
}

// Errors and times of one method.
class Score {
 public:
  void Add(double error_px, double time_s) {
    ++count_;
    time_s_ += time_s;
    if (!std::isfinite(error_px)) return;
    ++found_;
    squares_ += error_px * error_px;
    sum_ += error_px;
  }
  BenchTable::Row Row(const std::string& label) const {
    const double rms_px = std::sqrt(squares_ / found_);
    return {label,
            {{"rms_px", rms_px},
             {"rms_over_bound", rms_px / Bound_px()},
             {"mean_px", sum_ / found_},
             {"found", found_ / count_},
             {"ms_an_edge", 1e3 * time_s_ / count_}}};
  }

 private:
  double squares_ = 0, sum_ = 0, time_s_ = 0, found_ = 0, count_ = 0;
};

double CpuTime_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void AddStraightEdge(std::mt19937_64& generator, Score& band, Score& visp) {
  const Edge edge = RandomEdge(generator);
  const GrayImage image = Render(edge, generator);
  const Prediction prediction = Predict(edge, generator);
  const double before_s = CpuTime_s();
  const double offset_px = OffsetByBand(image, prediction);
  band.Add(offset_px, CpuTime_s() - before_s);

  const Eigen::Vector2d start = prediction.points.front().point_px, end = prediction.points.back().point_px;
  const VispLine line = FindLineWithVisp(image.pixels.data(), image.width, image.height, start.x(), start.y(),
                                         end.x(), end.y());
  visp.Add(OffsetOf(line, edge), line.time_s);
}

// ---- The whole of MeasureLegEdges: a flat leg, five others out of sight.

constexpr int kLegImageSide_px = 700;

Camera LegCamera() {
  Camera camera;
  camera.width_px = camera.height_px = kLegImageSide_px;
  camera.fx_px = camera.fy_px = 1250;
  camera.cx_px = camera.cy_px = kLegImageSide_px / 2.0;
  return camera;
}

// A leg 1 m away of which 400 px can be seen between its joints; the others far off and far behind.
LegsInCamera OneLeg(std::mt19937_64& generator) {
  constexpr double kRadius_m = 0.015;
  const double angle = Uniform(generator, -std::numbers::pi, std::numbers::pi);
  const double joints_m = 2 * VisibilityOptions{}.joint_radii * kRadius_m;
  const Eigen::Vector3d half = 0.5 * (kLength_px / LegCamera().fx_px + joints_m) *
                               Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  Eigen::Vector3d middle(0, 0, 1);
  middle.head<2>() += UniformVector(generator, -0.01, 0.01).head<2>();
  LegsInCamera legs;
  legs[0] = {middle - half, middle + half, kRadius_m};
  for (size_t i = 1; i < kLegCount; ++i) {
    const double around = 2 * std::numbers::pi / 5 * static_cast<double>(i);
    const Eigen::Vector3d far(40 * std::cos(around), 40 * std::sin(around), 60);
    legs[i] = {far + Eigen::Vector3d(0, 0.3, 0), far, kRadius_m};
  }
  return legs;
}

std::array<Eigen::Vector3d, 2> OutlineOf(const LegInCamera& leg) {
  return CylinderOutline(LineThrough<double>(leg.a_in_camera, leg.b_in_camera), leg.radius_m);
}

// Distance of a pixel outward from the image of an outline; exact, for the camera has no distortion.
double OutwardOf(const Eigen::Vector3d& normal, const Eigen::Vector2d& pixel) {
  const Camera camera = LegCamera();
  const Eigen::Vector3d x((pixel.x() - camera.cx_px) / camera.fx_px,
                          (pixel.y() - camera.cy_px) / camera.fy_px, 1);
  return camera.fx_px * normal.dot(x) / normal.head<2>().norm();
}

GrayImage Render(const LegInCamera& leg, std::mt19937_64& generator) {
  std::normal_distribution<double> noise(0, kNoise);
  const auto normals = OutlineOf(leg);
  GrayImage image{kLegImageSide_px, kLegImageSide_px, {}};
  for (int y = 0; y < kLegImageSide_px; ++y)
    for (int x = 0; x < kLegImageSide_px; ++x) {
      double share = 1;
      for (const Eigen::Vector3d& normal : normals)
        share *= std::erfc(OutwardOf(normal, {x, y}) / (kBlur_px * std::numbers::sqrt2)) / 2;
      image.pixels.push_back(
          static_cast<std::uint8_t>(std::lround(kBackground + kContrast * share + noise(generator))));
    }
  return image;
}

// The leg as predicted: each end off by 0.3 px in a random direction.
LegInCamera Mispredicted(const LegInCamera& leg, std::mt19937_64& generator) {
  const auto off = [&] {
    const double angle = Uniform(generator, -std::numbers::pi, std::numbers::pi);
    const double off_m = kPredictedOff_px / LegCamera().fx_px;
    return Eigen::Vector3d(off_m * std::cos(angle), off_m * std::sin(angle), 0);
  };
  return {leg.a_in_camera + off(), leg.b_in_camera + off(), leg.radius_m};
}

void AddLeg(std::mt19937_64& generator, Score& whole) {
  LegsInCamera legs = OneLeg(generator);
  const LegInCamera truth = legs[0];
  const GrayImage image = Render(truth, generator);
  legs[0] = Mispredicted(truth, generator);
  LegEdgeOptions options;
  options.lock.reset();
  const double before_s = CpuTime_s();
  const LegEdges found = MeasureLegEdges(image, legs, LegCamera(), options);
  const double time_s = (CpuTime_s() - before_s) / 2;
  for (size_t edge = 0; edge < 2; ++edge) {
    const Eigen::Vector2d middle = Project(LegCamera(), truth.AxisPoint(0.5));
    const double off_px =
        OutwardOf(OutlineOf(truth)[edge], middle) - OutwardOf(found.edges[edge].normal, middle);
    whole.Add(found.edges[edge].left_out.empty() ? off_px : std::nan(""), time_s);
  }
}

BenchTable StraightEdges() {
  std::mt19937_64 generator(1);
  Score band, visp, whole;
  for (int draw = 0; draw < kDraws; ++draw) AddStraightEdge(generator, band, visp);
  for (int draw = 0; draw < kDraws / 2; ++draw) AddLeg(generator, whole);
  return {"straight edges of 400 px, contrast 120, noise 2, blur 1 px",
          {band.Row("profile fit, blur known"), whole.Row("MeasureLegEdges"), visp.Row("ViSP vpMeLine")}};
}

}  // namespace
}  // namespace legible

int main(int argc, char** argv) { return legible::Report({legible::StraightEdges()}, argc, argv); }
