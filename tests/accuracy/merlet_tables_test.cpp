// The two tables of Merlet 2006, section 4: 18 errors, 15 indices and 12 ends of ranges, each to one unit of
// its last printed digit. (tests/apps checks the same figures as the program prints them.)
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "accuracy/conditioning.h"
#include "accuracy/maximal_errors.h"
#include "accuracy/three_point.h"
#include "tests/accuracy/merlet_robot.h"

namespace legible {
namespace {

constexpr double kCentimetre_m = 0.01;
constexpr double kDegrees = 180 / std::numbers::pi;

// One unit of the last digit of a number as printed.
void ExpectPrinted(double found, const std::string& printed, const std::string& what) {
  const size_t point = printed.find('.');
  const double digits = point == std::string::npos ? 0 : static_cast<double>(printed.size() - point - 1);
  EXPECT_NEAR(found, std::stod(printed), std::pow(10, -digits)) << what;
}

struct PrintedPose {
  std::array<const char*, 6> errors;
  const char *determinant, *two, *two_normalized, *frobenius, *frobenius_normalized;
  std::array<const char*, 2> two_three_point, frobenius_three_point;
};

constexpr std::array<PrintedPose, 3> kPrinted = {{
    {{"0.1184", "0.1268", "0.010087", "0.1185", "0.1184", "0.697"},
     "-29.22",
     "75.14",
     "63.9",
     "152.8",
     "70.2",
     {"9.55", "55.47"},
     {"258.8", "3204.9"}},
    {{"0.1189", "0.1274", "0.01266", "0.1333", "0.1429", "0.808"},
     "-24.64",
     "75.16",
     "73.8",
     "154",
     "80.9",
     {"9.62", "43.84"},
     {"218.8", "2383.6"}},
    {{"0.123", "0.1309", "0.0372", "0.15", "0.1663", "0.7208"},
     "-23.93",
     "80.65",
     "68.4",
     "158.3",
     "74.7",
     {"10.06", "58.95"},
     {"286.5", "3618"}},
}};

TEST(MerletTables, MaximalErrorsAreThePapersForJointErrorsOfATenthOfAMillimetre) {
  const GoughStewart robot = MerletRobot();
  for (size_t pose = 0; pose < 3; ++pose) {
    const auto errors = MaximalErrorsOf(Invert(FullInverseJacobianOf(robot, MerletPoses()[pose])),
                                        Vector6d::Constant(0.01 * kCentimetre_m));
    for (Eigen::Index i = 0; i < 6; ++i)
      ExpectPrinted(errors.of_coordinate[i] * (i < 3 ? 1 / kCentimetre_m : kDegrees),
                    kPrinted[pose].errors[static_cast<size_t>(i)], "P" + std::to_string(pose + 1));
  }
}

TEST(MerletTables, IndicesAreThePapersInCentimetres) {
  const GoughStewart robot = MerletRobot();
  for (size_t i = 0; i < 3; ++i) {
    const PrintedPose& printed = kPrinted[i];
    const std::string name = "P" + std::to_string(i + 1);
    const auto jacobian = InLengthUnit(FullInverseJacobianOf(robot, MerletPoses()[i]), kCentimetre_m);
    const ConditionNumbers plain = ConditionNumbersOf(jacobian.matrix);
    const ConditionNumbers normalised = NormalizedConditionNumbers(jacobian, {53, 53, 53});
    ExpectPrinted(DeterminantOf(jacobian), printed.determinant, name + " C_d");
    ExpectPrinted(plain.two, printed.two, name + " C_2");
    ExpectPrinted(normalised.two, printed.two_normalized, name + " C_2^n");
    ExpectPrinted(plain.frobenius, printed.frobenius, name + " C_F");
    ExpectPrinted(normalised.frobenius, printed.frobenius_normalized, name + " C_F^n");
  }
}

TEST(MerletTables, ThreePointIndicesAreThePapersInTheReadingThatTheyUse) {
  const GoughStewart robot = MerletRobot();
  for (size_t i = 0; i < 3; ++i) {
    const ThreePointConditions found = ThreePointConditionsOf(robot, MerletPoses()[i]);
    EXPECT_EQ(found.triplets, 20);
    ExpectPrinted(found.two.least, kPrinted[i].two_three_point[0], "C_2^3 least");
    ExpectPrinted(found.two.largest, kPrinted[i].two_three_point[1], "C_2^3 largest");
    ExpectPrinted(found.frobenius_of_gram.least, kPrinted[i].frobenius_three_point[0], "C_F^3 least");
    ExpectPrinted(found.frobenius_of_gram.largest, kPrinted[i].frobenius_three_point[1], "C_F^3 largest");
  }
}

}  // namespace
}  // namespace legible
