#include <bit>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <random>
#include <stdexcept>

#include "accuracy/gauss_legendre.h"
#include "accuracy/workspace.h"

namespace legible {
namespace {

constexpr std::uint64_t kReplicateStride = 0x9e3779b97f4a7c15;  // seeds of replicates lie far apart

std::mt19937_64 GeneratorOf(const Sampling& sampling, int replicate) {
  std::seed_seq seeds{static_cast<std::uint32_t>(sampling.seed),
                      static_cast<std::uint32_t>(sampling.seed >> 32),
                      static_cast<std::uint32_t>(replicate * kReplicateStride >> 32)};
  return std::mt19937_64(seeds);
}

double UnitUniform(std::mt19937_64& generator) {
  return std::uniform_real_distribution<double>(0, 1)(generator);
}

// The most whole nodes along each axis whose product stays within `points`.
int NodesPerAxis(size_t points, int dimension) {
  int nodes = 1;
  while (std::pow(nodes + 1, dimension) <= static_cast<double>(points)) ++nodes;
  return nodes;
}

// All combinations of one axis' nodes.
WeightedPoints Product(const Eigen::VectorXd& nodes, const Eigen::VectorXd& weights, int dimension) {
  const auto count = static_cast<Eigen::Index>(std::lround(std::pow(nodes.size(), dimension)));
  WeightedPoints product{Eigen::MatrixXd(dimension, count), Eigen::VectorXd::Ones(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Index rest = i;
    for (int axis = 0; axis < dimension; ++axis, rest /= nodes.size()) {
      product.points(axis, i) = nodes[rest % nodes.size()];
      product.weights[i] *= weights[rest % nodes.size()];
    }
  }
  return product;
}

WeightedPoints ShiftedGrid(size_t points, int dimension, std::mt19937_64 generator) {
  const int nodes = NodesPerAxis(points, dimension);
  const Eigen::VectorXd midpoints = (Eigen::VectorXd::LinSpaced(nodes, 0, nodes - 1).array() + 0.5) / nodes;
  WeightedPoints grid = Product(midpoints, Eigen::VectorXd::Constant(nodes, 1.0 / nodes), dimension);
  for (int axis = 0; axis < dimension; ++axis) {
    const double shift = UnitUniform(generator);
    grid.points.row(axis) =
        grid.points.row(axis).unaryExpr([shift](double x) { return std::fmod(x + shift, 1.0); });
  }
  return grid;
}

WeightedPoints Independent(size_t points, int dimension, std::mt19937_64 generator) {
  const auto count = static_cast<Eigen::Index>(points);
  const Eigen::MatrixXd places =
      Eigen::MatrixXd::NullaryExpr(dimension, count, [&](Eigen::Index) { return UnitUniform(generator); });
  return {places, Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count))};
}

// A power of two of Sobol's points, the origin first, their bits flipped by random digits of each axis: the
// net keeps its even spread, and each point is uniform.
WeightedPoints ShiftedSobol(size_t points, int dimension, std::mt19937_64 generator) {
  const auto count = static_cast<Eigen::Index>(std::bit_ceil(points));
  std::vector<std::uint64_t> flips(static_cast<size_t>(dimension));
  for (std::uint64_t& flip : flips) flip = generator();
  boost::random::sobol_engine<std::uint64_t, 64> sobol(static_cast<size_t>(dimension));
  WeightedPoints result{Eigen::MatrixXd(dimension, count),
                        Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count))};
  for (Eigen::Index i = 0; i < count; ++i)
    for (int axis = 0; axis < dimension; ++axis) {
      const std::uint64_t digits = i == 0 ? 0 : sobol();
      result.points(axis, i) =
          std::ldexp(static_cast<double>((digits ^ flips[static_cast<size_t>(axis)]) >> 11), -53);
    }
  return result;
}

// Replicate 1 has twice the panels of replicate 0 along each axis.
WeightedPoints Gauss(size_t points, int dimension, int replicate) {
  const int panels = std::max(2, NodesPerAxis(points, dimension) / kNodesPerPanel);
  const int fine = static_cast<int>(std::bit_floor(static_cast<unsigned>(panels)));
  const GaussLegendre axis = GaussLegendrePanels(replicate == 0 ? fine / 2 : fine);
  return Product(axis.nodes, axis.weights, dimension);
}

}  // namespace

WeightedPoints UnitCubePoints(const Sampling& sampling, int dimension, int replicate) {
  const size_t share = sampling.samples / kReplicates;
  switch (sampling.rule) {
    case SamplingRule::kGrid:
      return ShiftedGrid(share, dimension, GeneratorOf(sampling, replicate));
    case SamplingRule::kMonteCarlo:
      return Independent(share, dimension, GeneratorOf(sampling, replicate));
    case SamplingRule::kSobol:
      return ShiftedSobol(share, dimension, GeneratorOf(sampling, replicate));
    case SamplingRule::kGauss:
      return Gauss(sampling.samples, dimension, replicate);
  }
  throw std::invalid_argument("UnitCubePoints: not a SamplingRule");
}

Eigen::MatrixXd InBox(const Box& box, const Eigen::MatrixXd& unit_points) {
  Eigen::MatrixXd points = box.low.replicate(1, unit_points.cols());
  const std::vector<Eigen::Index> free = box.FreeCoordinates();
  for (size_t i = 0; i < free.size(); ++i)
    points.row(free[i]) +=
        (box.high[free[i]] - box.low[free[i]]) * unit_points.row(static_cast<Eigen::Index>(i));
  return points;
}

}  // namespace legible
