#include "core/algebra/ball.h"

#include <flint/fmpq.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "tests/testing/random.h"

namespace legible {
namespace {

// A rational number, computed exactly: what balls have to enclose.
class Exact {
 public:
  explicit Exact(double number) {
    arf_t of_double;
    arf_init(of_double);
    arf_set_d(of_double, number);
    fmpq_init(value_);
    arf_get_fmpq(value_, of_double);
    arf_clear(of_double);
  }
  Exact(const Exact& other) {
    fmpq_init(value_);
    fmpq_set(value_, other.value_);
  }
  Exact& operator=(const Exact&) = delete;
  ~Exact() { fmpq_clear(value_); }

  Exact operator+(const Exact& other) const { return With(fmpq_add, other); }
  Exact operator-(const Exact& other) const { return With(fmpq_sub, other); }
  Exact operator*(const Exact& other) const { return With(fmpq_mul, other); }
  Exact operator/(const Exact& other) const { return With(fmpq_div, other); }

  bool IsIn(const RealBall& ball) const { return arb_contains_fmpq(ball.get(), value_) != 0; }

 private:
  template <typename Operation>
  Exact With(Operation operation, const Exact& other) const {
    Exact result(0);
    operation(result.value_, value_, other.value_);
    return result;
  }

  fmpq_t value_;
};

template <typename Number>
Number Formula(const Number& a, const Number& b, const Number& c, const Number& d) {
  return (a + b) * (c - d) / (a * d - b) - c / d;
}

TEST(RealBall, EnclosesExactResultsOfEveryNumberWithinTheRadius) {
  std::mt19937_64 generator = TestGenerator();
  constexpr double kRadius = 1e-3;
  for (int i = 0; i < 200; ++i) {
    std::array<double, 4> middle, sample;
    std::array<RealBall, 4> ball;
    for (size_t j = 0; j < 4; ++j) {
      middle[j] = Uniform(generator, 1, 2);
      sample[j] = middle[j] + Uniform(generator, -0.999 * kRadius, 0.999 * kRadius);
      ball[j] = RealBall(middle[j], kRadius);
    }
    const auto exact = [](const std::array<double, 4>& x) {
      return Formula(Exact(x[0]), Exact(x[1]), Exact(x[2]), Exact(x[3]));
    };
    const RealBall wide = Formula(ball[0], ball[1], ball[2], ball[3]);
    EXPECT_TRUE(exact(sample).IsIn(wide) || !std::isfinite(UpperBound(wide)));
    const RealBall narrow =
        Formula(RealBall(middle[0]), RealBall(middle[1]), RealBall(middle[2]), RealBall(middle[3]));
    EXPECT_TRUE(exact(middle).IsIn(narrow));
  }
}

TEST(RealBall, BoundsAreOutward) {
  const RealBall third = RealBall(1) / RealBall(3);
  EXPECT_LT(LowerBound(third), UpperBound(third));
  EXPECT_EQ(std::nextafter(LowerBound(third), 1), UpperBound(third));  // with no double between them
  EXPECT_TRUE((Exact(1) / Exact(3)).IsIn(third));
  const RealBall ball(2, 0.25);
  EXPECT_LE(LowerBound(ball), 1.75);
  EXPECT_GE(UpperBound(ball), 2.25);
  EXPECT_NEAR(RadiusOf(ball), 0.25, 1e-8);
  EXPECT_GE(RadiusOf(ball), 0.25);
}

TEST(RealBall, FunctionsHoldTheirIdentities) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    const double x = Uniform(generator, 0, 10);
    const RealBall root = Sqrt(RealBall(x));
    EXPECT_TRUE(Contains(root * root, x));
    const RealBall sine = Sin(RealBall(x)), cosine = Cos(RealBall(x));
    EXPECT_TRUE(Contains(sine * sine + cosine * cosine, 1));
    EXPECT_NEAR(MidpointOf(sine), std::sin(x), 1e-15);
    EXPECT_NEAR(MidpointOf(cosine), std::cos(x), 1e-15);
    EXPECT_LT(RadiusOf(sine), 1e-15);
  }
}

TEST(RealBall, HullHoldsBothEndsAndLittleElse) {
  std::mt19937_64 generator = TestGenerator();
  for (int i = 0; i < 50; ++i) {
    const double a = Uniform(generator, -1, 1), b = Uniform(generator, -1, 1);
    const RealBall hull = Hull(a, b);
    EXPECT_TRUE(Contains(hull, a) && Contains(hull, b));
    EXPECT_NEAR(LowerBound(hull), std::min(a, b), 1e-8);
    EXPECT_NEAR(UpperBound(hull), std::max(a, b), 1e-8);
  }
}

TEST(RealBall, WhatMayDivideByZeroIsNotANumber) {
  const RealBall quotient = RealBall(1) / RealBall(0, 1e-9);
  EXPECT_FALSE(std::isfinite(LowerBound(quotient)));
  EXPECT_FALSE(std::isfinite(UpperBound(quotient)));
  EXPECT_TRUE(Contains(quotient, 17));
  EXPECT_FALSE(std::isfinite(LowerBound(Sqrt(RealBall(-1)))));
}

TEST(RealBall, OverlapsWhereBallsHaveANumberInCommon) {
  EXPECT_TRUE(Overlaps(RealBall(0, 1), RealBall(2, 1)));
  EXPECT_FALSE(Overlaps(RealBall(0, 0.9), RealBall(2, 0.9)));
}

TEST(RealBall, IsAScalarOfEigen) {
  using Vector = Eigen::Matrix<RealBall, 3, 1>;
  using Matrix = Eigen::Matrix<RealBall, 3, 3>;
  // Numbers that doubles compute with exactly.
  const Eigen::Vector3d a(1, 2, 3), b(-4, 5, 0.5);
  Eigen::Matrix3d m;
  m << 1, 2, 3, 0, 1, 4, 5, 6, 0;  // of determinant 1
  const Vector a_ball = a.cast<RealBall>(), b_ball = b.cast<RealBall>();
  const Matrix m_ball = m.cast<RealBall>();
  EXPECT_TRUE(Contains(a_ball.dot(b_ball), a.dot(b)));
  EXPECT_TRUE(Contains(m_ball.determinant(), 1));
  const Vector cross = a_ball.cross(b_ball), product = m_ball * a_ball;
  const Matrix inverse = m_ball.inverse();
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(Contains(cross[i], a.cross(b)[i]));
    EXPECT_TRUE(Contains(product[i], (m * a)[i]));
    EXPECT_TRUE(Contains((inverse * m_ball)(i, i), 1));
  }
}

TEST(ComplexBall, ComputesAsComplexNumbersDo) {
  // Gaussian integers: exact in doubles.
  const std::complex<double> a(3, -4), b(-2, 7);
  EXPECT_TRUE(Contains(ComplexBall(a) + ComplexBall(b), a + b));
  EXPECT_TRUE(Contains(ComplexBall(a) - ComplexBall(b), a - b));
  EXPECT_TRUE(Contains(ComplexBall(a) * ComplexBall(b), a * b));
  EXPECT_TRUE(Contains(ComplexBall(a * b) / ComplexBall(b), a));
  EXPECT_TRUE(Contains(-ComplexBall(a), -a));
  EXPECT_GE(LargestModulus(ComplexBall(a)), 5);
  EXPECT_NEAR(LargestModulus(ComplexBall(a, 1)), std::hypot(4, 5), 1e-6);
  EXPECT_FALSE(Contains(ComplexBall(a, 0.5), a + std::complex<double>(0.6, 0)));
  EXPECT_TRUE(Overlaps(ComplexBall(a, 0.5), ComplexBall(a + std::complex<double>(0.9, 0), 0.5)));
  EXPECT_TRUE(IsExactlyReal(ComplexBall(RealBall(1, 0.5))));
  EXPECT_FALSE(IsExactlyReal(ComplexBall(std::complex<double>(1, 0), 1e-9)));
}

}  // namespace
}  // namespace legible
