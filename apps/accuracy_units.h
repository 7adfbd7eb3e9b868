// Numbers and matrices as JSON in the units of the output.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "apps/accuracy_settings.h"
#include "apps/json_text.h"

namespace legible {

// Numbers in the units of the output.
class InUnits {
 public:
  explicit InUnits(const AccuracySettings& settings)
      : length_m_(LengthUnitOf(settings).si), angle_rad_(AngleUnitOf(settings).si) {}

  double Length(double m) const { return m / length_m_; }
  double Angle(double rad) const { return rad / angle_rad_; }
  double length_m() const { return length_m_; }

  // The unit of a twist's coordinate.
  double Of(Eigen::Index coordinate) const { return coordinate < 3 ? length_m_ : angle_rad_; }

  nlohmann::ordered_json Twist(const Eigen::VectorXd& twist) const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (Eigen::Index i = 0; i < twist.size(); ++i) list.push_back(twist[i] / Of(i));
    return list;
  }

 private:
  double length_m_, angle_rad_;
};

inline nlohmann::ordered_json Rows(const Eigen::MatrixXd& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(List(matrix.row(i).transpose()));
  return rows;
}

inline nlohmann::ordered_json Columns(const Eigen::MatrixXd& matrix) { return Rows(matrix.transpose()); }

}  // namespace legible
