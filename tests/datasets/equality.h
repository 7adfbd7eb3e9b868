// Exact equality of what is written and read back.
#pragma once

#include <gtest/gtest.h>

#include "core/geometry/camera.h"
#include "core/robots/gough_stewart.h"

namespace legible {

inline void ExpectSame(const Rigid3& found, const Rigid3& expected) {
  EXPECT_EQ(found.rotation.coeffs(), expected.rotation.coeffs());
  EXPECT_EQ(found.translation, expected.translation);
}

inline void ExpectSame(const GoughStewart& found, const GoughStewart& expected) {
  EXPECT_EQ(found.name, expected.name);
  ExpectSame(found.home, expected.home);
  for (int i = 0; i < kLegCount; ++i) {
    EXPECT_EQ(found.legs[i].base_joint_m, expected.legs[i].base_joint_m);
    EXPECT_EQ(found.legs[i].platform_joint_m, expected.legs[i].platform_joint_m);
    EXPECT_EQ(found.legs[i].radius_m, expected.legs[i].radius_m);
    EXPECT_EQ(found.legs[i].joint_offset_m, expected.legs[i].joint_offset_m);
    EXPECT_EQ(found.legs[i].joint_range_m, expected.legs[i].joint_range_m);
  }
}

inline void ExpectSame(const Camera& found, const Camera& expected) {
  EXPECT_EQ(found.width_px, expected.width_px);
  EXPECT_EQ(found.height_px, expected.height_px);
  EXPECT_EQ(found.fx_px, expected.fx_px);
  EXPECT_EQ(found.fy_px, expected.fy_px);
  EXPECT_EQ(found.cx_px, expected.cx_px);
  EXPECT_EQ(found.cy_px, expected.cy_px);
  EXPECT_EQ(found.lens, expected.lens);
  EXPECT_EQ(found.distortion, expected.distortion);
}

}  // namespace legible
