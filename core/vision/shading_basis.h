// What the brightness across the edge of a lit cylinder is made of.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace legible {

// How much of the leg's shading the model follows. All are linear in their coefficients; the edge's place x0
// and the blur are not. With x = inside_px - x0, w the leg's half width and psi = acos(1 - x / w) the surface
// angle from the outline (psi grows as sqrt(x): brightness is smooth in psi, not in x):
//   kFlat     outside e0, inside c0
//   kAngular  outside e0 + e1 x, inside c0 cos psi + c1 psi + a (1 - cos psi):
//             Lambert's law with light a from everywhere, psi for its sine
//   kKinked   as kAngular plus sum a_j max(0, x - x_j): kinks where a light's shadow begins on the surface,
//             from psi = 0.65 rad on; nearer the outline a kink cannot be told from a shift of the edge
// all convolved with a Gaussian of the given blur.
enum class ShadingModel { kFlat, kAngular, kKinked };

// The blurred functions that a model's coefficients multiply, at a distance inside the edge.
class ShadingBasis {
 public:
  static constexpr int kMaxColumns = 16;
  using Columns = Eigen::Matrix<double, kMaxColumns, 1>;
  // Columns of the shaded models: e0, e1, c0, c1, a, then the kinks (grey levels per rad). The flat model has
  // e0, c0.
  static constexpr Eigen::Index kOutside = 1, kLevel = 2, kAngle = 3, kAmbient = 4, kFirstKink = 5;

  // blur_px: of the image; a pixel's own extent is added. Kinks reach a little beyond inside_px.
  ShadingBasis(ShadingModel model, double blur_px, double half_width_px, double inside_px);

  int size() const { return size_; }

  // The first size() entries: the functions at x and their slopes by x, per px.
  void Evaluate(double x, Columns& value, Columns& slope) const;

  // How the brightness at x changes with blur_px, per px, for size() coefficients: a Gaussian of variance v
  // obeys d/dv = 1/2 d^2/dx^2.
  double SlopeByBlur(double x, const Eigen::Ref<const Eigen::VectorXd>& coefficients) const;

 private:
  struct Kink {
    double place_px;    // inside the edge
    double rad_per_px;  // of the surface angle there
  };

  ShadingModel model_;
  double blur_px_, s_, w_;  // of the image, whole blur, half width
  // psi = acos(1 - x/w) = sqrt(2 x/w) (1 + x/(12 w) + 3 x^2/(160 w^2) + …): factors of the blurred powers of
  // x/s.
  Eigen::Array4d angle_;
  int size_;
  std::vector<Kink> kinks_;
};

}  // namespace legible
