#include "core/robots/assembly_mode_start.h"

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "core/robots/gough_stewart_assembly_modes.h"
#include "core/robots/study_quadrics.h"

namespace legible {
namespace {

using Complex = std::complex<double>;
using Quadrics = HomogeneousQuadrics<8>;
using Point = PathTracker<8>::Point;

constexpr double kTolerance = 1e-4;
constexpr int kMaxEdges = 20;  // four or five are usual

Complex RandomComplex(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  const double real = normal(generator);
  return {real, normal(generator)};
}

template <int Rows, int Columns>
Eigen::Matrix<Complex, Rows, Columns> RandomMatrix(std::mt19937_64& generator) {
  return Eigen::Matrix<Complex, Rows, Columns>::NullaryExpr([&] { return RandomComplex(generator); });
}

// Six conditions that the motion v satisfies.
Quadrics RandomConditionsOn(const Point& v, std::mt19937_64& generator) {
  std::array<MotionCondition<Complex>, 6> conditions;
  const Complex x_square = v.head<4>().cwiseProduct(v.head<4>()).sum();
  for (MotionCondition<Complex>& condition : conditions) {
    condition = {0, RandomMatrix<3, 1>(generator), RandomMatrix<3, 1>(generator),
                 RandomMatrix<3, 3>(generator)};
    condition.constant = -v.cwiseProduct(QuadricOf(condition) * v).sum() / x_square;
  }
  return MotionQuadrics(conditions);
}

// With every condition times a number of its own: the same solutions, on another line.
Quadrics Rescaled(Quadrics quadrics, std::mt19937_64& generator) {
  for (size_t i = 0; i < 6; ++i) quadrics[i] *= RandomComplex(generator);
  return quadrics;
}

Point RandomMotion(std::mt19937_64& generator) {
  Point v = RandomMatrix<8, 1>(generator);
  const auto x = v.head<4>();
  const Complex x_square = x.cwiseProduct(x).sum();
  v.tail<4>() -= x.cwiseProduct(v.tail<4>()).sum() / x_square * x;
  return v.normalized();
}

// A system with the solutions known so far.
struct Vertex {
  Quadrics quadrics;
  std::vector<Point> solutions;

  // The number of the solution; a new one if it is not among those known.
  size_t IndexOf(const Point& point) {
    for (size_t i = 0; i < solutions.size(); ++i)
      if (std::abs(solutions[i].dot(point)) > 1 - 1e-10) return i;
    solutions.push_back(point);
    return solutions.size() - 1;
  }
};

// Solutions of either vertex whose partner along an edge is known.
using Done = std::array<std::vector<bool>, 2>;

bool IsDone(const std::vector<bool>& done, size_t i) { return i < done.size() && done[i]; }

void SetDone(std::vector<bool>& done, size_t i) {
  if (i >= done.size()) done.resize(i + 1);
  done[i] = true;
}

// Takes all solutions known at one vertex, and not yet taken, along an edge to the other.
void TrackAlong(const Quadrics& from, const Quadrics& to, size_t from_vertex, std::array<Vertex, 2>& vertices,
                Done& done) {
  const PathTracker<8> tracker(from, to);
  const size_t to_vertex = 1 - from_vertex;
  for (size_t i = 0; i < vertices[from_vertex].solutions.size(); ++i) {
    if (IsDone(done[from_vertex], i)) continue;
    SetDone(done[from_vertex], i);
    const PathEnd<8> end = tracker.Track(vertices[from_vertex].solutions[i], kTolerance);
    if (end.s == 1) SetDone(done[to_vertex], vertices[to_vertex].IndexOf(end.point));
  }
}

}  // namespace

AssemblyModeStart MakeAssemblyModeStart(uint64_t seed) {
  std::mt19937_64 generator(seed);
  const Point first = RandomMotion(generator);
  std::array<Vertex, 2> vertices;
  vertices[0] = {RandomConditionsOn(first, generator), {first}};
  vertices[1] = {RandomConditionsOn(RandomMotion(generator), generator), {}};
  struct Edge {
    Quadrics first, second;
    Done done;
  };
  std::vector<Edge> edges;
  while (edges.size() < kMaxEdges) {
    edges.push_back(
        {Rescaled(vertices[0].quadrics, generator), Rescaled(vertices[1].quadrics, generator), {}});
    size_t known = 0;
    while (vertices[0].solutions.size() + vertices[1].solutions.size() > known) {
      known = vertices[0].solutions.size() + vertices[1].solutions.size();
      for (Edge& edge : edges) {
        TrackAlong(edge.first, edge.second, 0, vertices, edge.done);
        TrackAlong(edge.second, edge.first, 1, vertices, edge.done);
        for (const Vertex& vertex : vertices)
          if (vertex.solutions.size() == kGoughStewartRootCount) return {vertex.quadrics, vertex.solutions};
      }
    }
  }
  throw std::runtime_error("MakeAssemblyModeStart: not all 40 solutions were found; take another seed");
}

}  // namespace legible
